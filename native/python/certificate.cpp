#include <nanobind/stl/array.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstring>

#include "arrays.hpp"
#include "bindings.hpp"
#include "stairwright/certificate/dynamic_balance.hpp"
#include "stairwright/certificate/equilibrium.hpp"
#include "stairwright/certificate/postures.hpp"

namespace stairwright::python {

namespace {

using namespace certificate;

using Array = nb::ndarray<nb::numpy, double>;
using Pair = std::array<double, 2>;
using Capsules = std::vector<std::tuple<Pair, Pair, double>>;
using ThreeByTwo = In<double, nb::shape<-1, kFaces, 2>>;

Vec2 vec2(const Pair& p) { return {p[0], p[1]}; }

Link link(double length, double mass, const Pair& com, const Capsules& capsules) {
    Link out{length, mass, vec2(com), {}};
    for (const auto& [begin, end, radius] : capsules) out.capsules.push_back({vec2(begin), vec2(end), radius});
    return out;
}

Robot robot(const std::vector<std::vector<Pair>>& trunk, double mass, const Pair& com, const std::array<Leg, 2>& legs, double wheel_radius) {
    Robot out{{}, mass, vec2(com), legs, wheel_radius};
    for (const std::vector<Pair>& piece : trunk) {
        if (piece.empty()) throw nb::value_error("a piece of the trunk needs corners");
        std::transform(piece.begin(), piece.end(), std::back_inserter(out.trunk.emplace_back()), vec2);
    }
    return out;
}

Postures postures(const Robot& robot, const In<double, nb::shape<-1, 3>>& body, const In<double, nb::shape<-1, 4>>& joints) {
    if (body.shape(0) != joints.shape(0)) throw nb::value_error("as many trunks as joints, please");
    nb::gil_scoped_release release;
    std::vector<Pose> poses;
    poses.reserve(body.shape(0));
    for (std::size_t k = 0; k < body.shape(0); ++k)
        poses.push_back({{body(k, 0), body(k, 1)}, body(k, 2), {joints(k, 0), joints(k, 1), joints(k, 2), joints(k, 3)}});
    return Postures(robot, poses);
}

Array joints(const Postures& postures) {
    using Joints = decltype(Posture::joints);
    static_assert(sizeof(Joints) == 12 * sizeof(double));
    const std::size_t n = postures.all().size();
    std::vector<double> out(12 * n);
    for (std::size_t k = 0; k < n; ++k) std::memcpy(&out[12 * k], &postures.all()[k].joints, sizeof(Joints));
    return give(std::move(out), {n, 3, 2, 2});
}

Array centres_of_mass(const Postures& postures) {
    std::vector<double> out;
    out.reserve(2 * postures.all().size());
    for (const Vec2 com : postures.com()) out.insert(out.end(), {com.x, com.z});
    return give(std::move(out), {postures.all().size(), 2});
}

// Numbers (n,) that are found while Python goes on.
template <typename Find>
Array found(Find find) {
    std::vector<double> out;
    {
        nb::gil_scoped_release release;
        out = find();
    }
    return give(std::move(out));
}

std::span<const double> slack_of(const Postures& postures, const Vector& slack) {
    if (slack.size() != postures.all().size()) throw nb::value_error("as many slacks as postures, please");
    return view(slack);
}

std::tuple<Array, Array, Array> faces(const Ground& ground, const Points& centres, double sight) {
    const std::size_t n = centres.shape(0);
    std::vector<double> at(2 * kFaces * n), normals(2 * kFaces * n), distances(kFaces * n);
    {
        nb::gil_scoped_release release;
        for (std::size_t k = 0, row = 0; k < n; ++k)
            for (const Face& face : ground.faces({centres(k, 0), centres(k, 1)}, sight)) {
                at[2 * row] = face.at.x, at[2 * row + 1] = face.at.z;
                normals[2 * row] = face.normal.x, normals[2 * row + 1] = face.normal.z;
                distances[row++] = face.distance;
            }
    }
    return {give(std::move(at), {n, kFaces, 2}), give(std::move(normals), {n, kFaces, 2}), give(std::move(distances), {n, kFaces})};
}

nb::ndarray<nb::numpy, bool> balanced_samples(const ThreeByTwo& at, const ThreeByTwo& normals, const In<bool, nb::shape<-1, kFaces>>& touched,
                                              const Vector& com_x, double friction) {
    const std::size_t n = com_x.size(), wheels = 2 * n;
    if (at.shape(0) != wheels || normals.shape(0) != wheels || touched.shape(0) != wheels) throw nb::value_error("two wheels a sample, please");
    auto* out = new bool[n];
    nb::capsule owner(out, [](void* p) noexcept { delete[] static_cast<bool*>(p); });
    {
        nb::gil_scoped_release release;
        for (std::size_t k = 0; k < n; ++k) {
            std::array<Face, 2 * kFaces> found;
            std::size_t count = 0;
            for (std::size_t w = 2 * k; w < 2 * k + 2; ++w)
                for (std::size_t f = 0; f < kFaces; ++f)
                    if (touched(w, f)) found[count++] = {{at(w, f, 0), at(w, f, 1)}, {normals(w, f, 0), normals(w, f, 1)}};
            out[k] = balanced({found.data(), count}, com_x(k), friction);
        }
    }
    return {out, {n}, owner};
}

using PerMotor = In<double, nb::shape<-1, kMotors>>;

// One row of an array (n, N).
template <std::size_t N>
std::array<double, N> row(const In<double, nb::shape<-1, static_cast<nb::ssize_t>(N)>>& rows, std::size_t k) {
    std::array<double, N> out;
    std::copy_n(rows.data() + k * N, N, out.begin());
    return out;
}

std::pair<Array, Array> least_shares(const In<double, nb::shape<-1, kConeEdges, 3>>& wrenches, const In<double, nb::shape<-1, kConeEdges, kMotors>>& turned,
                                     const In<double, nb::shape<-1, 3>>& loads, const PerMotor& torques, const PerMotor& lowest, const PerMotor& highest) {
    const std::size_t n = loads.shape(0);
    for (const std::size_t each : {wrenches.shape(0), turned.shape(0), torques.shape(0), lowest.shape(0), highest.shape(0)})
        if (each != n) throw nb::value_error("as many of each as poses, please");
    std::vector<double> share(n), missed(n);
    {
        nb::gil_scoped_release release;
        for (std::size_t k = 0; k < n; ++k) {
            Motion motion{{}, row<3>(loads, k), row<kMotors>(torques, k), row<kMotors>(lowest, k), row<kMotors>(highest, k)};
            for (std::size_t e = 0; e < kConeEdges; ++e) {
                std::copy_n(&wrenches(k, e, 0), 3, motion.edges[e].wrench.begin());
                std::copy_n(&turned(k, e, 0), kMotors, motion.edges[e].torques.begin());
            }
            const DynamicBalance balance = least_share(motion);
            share[k] = balance.share, missed[k] = balance.missed;
        }
    }
    return {give(std::move(share)), give(std::move(missed))};
}

}  // namespace

void bind_certificate(nb::module_& m) {
    nb::class_<Link>(m, "CertificateLink").def("__init__", [](Link* self, double length, double mass, const Pair& com, const Capsules& capsules) {
        new (self) Link(link(length, mass, com, capsules));
    }, nb::arg("length"), nb::arg("mass"), nb::arg("com"), nb::arg("capsules"));
    nb::class_<Leg>(m, "CertificateLeg").def("__init__", [](Leg* self, const Pair& hip, const Link& thigh, const Link& calf, double wheel_mass) {
        new (self) Leg{vec2(hip), thigh, calf, wheel_mass};
    }, nb::arg("hip"), nb::arg("thigh"), nb::arg("calf"), nb::arg("wheel_mass"));
    nb::class_<Robot>(m, "CertificateRobot").def("__init__", [](Robot* self, const std::vector<std::vector<Pair>>& trunk, double mass, const Pair& com,
                                                                 const std::array<Leg, 2>& legs, double wheel_radius) {
        new (self) Robot(robot(trunk, mass, com, legs, wheel_radius));
    }, nb::arg("trunk"), nb::arg("trunk_mass"), nb::arg("trunk_com"), nb::arg("legs"), nb::arg("wheel_radius"));
    nb::class_<Ground>(m, "CertificateGround")
        .def("__init__", [](Ground* self, const Points& vertices) { new (self) Ground(points(vertices)); }, nb::arg("vertices"))
        .def("faces", &faces, nb::arg("centres"), nb::arg("sight"),
             "Faces near to wheels (n, 2): points (n, 3, 2), normals (n, 3, 2) and distances (n, 3) [m], nearest first.");
    nb::class_<Postures>(m, "CertificatePostures")
        .def("__init__", [](Postures* self, const Robot& robot, const In<double, nb::shape<-1, 3>>& body, const In<double, nb::shape<-1, 4>>& joints) {
            new (self) Postures(postures(robot, body, joints));
        }, nb::arg("robot"), nb::arg("body"), nb::arg("joints"))
        .def("joints", &joints, "Hips, knees and wheels (n, 3, 2, 2): joint, front and rear, x and z [m].")
        .def("com", &centres_of_mass, "Centres of mass (n, 2) [m].")
        .def("way", [](const Postures& postures) { return give(std::vector(postures.way())); },
             "From the first to each posture (n,) [m]: from one to the next no joint and no point of the trunk moves farther.")
        .def("trunk", [](const Postures& postures, const Ground& ground, const Vector& slack) {
            return found([&, s = slack_of(postures, slack)] { return postures.trunk(ground, s); });
        }, nb::arg("ground"), nb::arg("slack"),
           "Distance (n,) of the trunk from the ground [m], -1 below it; a bound where it is more than the slack (n,) and not the least.")
        .def("links", [](const Postures& postures, const Ground& ground, const Vector& slack) {
            return found([&, s = slack_of(postures, slack)] { return postures.links(ground, s); });
        }, nb::arg("ground"), nb::arg("slack"), "The same of thighs and calves, less than -1 where they begin below the ground.")
        .def("rims", [](const Postures& postures, std::size_t pair, const Ground& ground) {
            if (pair > 1) throw nb::value_error("front wheels are 0, rear ones 1");
            return found([&] { return postures.rims(pair, ground); });
        }, nb::arg("pair"), nb::arg("ground"), "Distance (n,) of the front (0) or rear (1) wheels' rims from the ground [m]; negative where sunk.")
        .def("between_legs", [](const Postures& postures) { return found([&] { return postures.between_legs(); }); },
             "Distance (n,) between links and wheels of the front and of the rear leg [m]; a bound where it is not the least.");
    m.def("certificate_balanced", &balanced_samples, nb::arg("points"), nb::arg("normals"), nb::arg("touched"), nb::arg("com_x"), nb::arg("friction"),
          "Whether faces (2 n, 3) that the wheels of n samples in turn touch can hold the robot in balance (n,).");
    m.def("certificate_least_share", &least_shares, nb::arg("wrenches"), nb::arg("torques"), nb::arg("load"), nb::arg("without_contact"), nb::arg("lowest"),
          nb::arg("highest"),
          "Least share of the motors (n,), and what of the load (n, 3) no force balances (n,): unit forces along 12 edges of friction cones "
          "give wrenches (n, 12, 3) and take torques (n, 12, 6), moving takes more (n, 6), and motors give the lowest to the highest (n, 6) [Nm].");
    m.attr("CERTIFICATE_STRONGEST") = kStrongest;
}

}  // namespace stairwright::python
