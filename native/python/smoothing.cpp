#include "stairwright/smoothing/refine.hpp"

#include <nanobind/stl/map.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "stairwright/smoothing/densify.hpp"
#include "stairwright/smoothing/smoothing.hpp"

namespace stairwright::python {

namespace {

using smoothing::BandMatrix;
using smoothing::Evenness;
using smoothing::kBand;
using smoothing::Node;
using smoothing::NodeMargins;
using smoothing::NodeSpacing;
using smoothing::PathWeights;
using smoothing::RefinedPath;
using smoothing::RefineProblem;
using smoothing::ExtraMargins;

// Rows (s_front, s_rear, x, z, pitch).
using Nodes = In<double, nb::shape<-1, 5>>;

std::vector<Node> nodes(const Nodes& rows) {
    std::vector<Node> out(rows.shape(0));
    for (std::size_t k = 0; k < out.size(); ++k)
        out[k] = {{rows(k, 0), rows(k, 1)}, {rows(k, 2), rows(k, 3), rows(k, 4)}};
    return out;
}

// An array (n, ...) with what `read` writes of each node's margins.
template <std::size_t Width, typename Read>
nb::ndarray<nb::numpy, double> column(const std::vector<NodeMargins>& margins, std::initializer_list<std::size_t> shape, Read read) {
    std::vector<double> out(Width * margins.size());
    for (std::size_t k = 0; k < margins.size(); ++k) {
        const std::array<double, Width> row = read(margins[k]);
        std::copy(row.begin(), row.end(), out.begin() + static_cast<std::ptrdiff_t>(Width * k));
    }
    std::vector<std::size_t> full = {margins.size()};
    full.insert(full.end(), shape);
    auto owned = std::make_unique<std::vector<double>>(std::move(out));
    double* data = owned->data();
    nb::capsule owner(owned.release(), [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
    return {data, full.size(), full.data(), owner};
}

using Arrays = nb::typed<nb::dict, nb::str, nb::ndarray<nb::numpy, double>>;

// The margins of all nodes by name, each an array over the nodes.
Arrays arrays(const std::vector<NodeMargins>& m) {
    Arrays out;
    const auto scalar = [&](const char* name, auto read) {
        out[name] = column<1>(m, {}, [&](const NodeMargins& n) { return std::array<double, 1>{read(n)}; });
    };
    out["q"] = column<4>(m, {4}, [](const NodeMargins& n) {
        const auto& q = n.geometry.joints.q;
        return std::array{q[0].thigh, q[0].calf, q[1].thigh, q[1].calf};
    });
    out["com"] = column<2>(m, {2}, [](const NodeMargins& n) { return std::array{n.geometry.posture.com.x, n.geometry.posture.com.z}; });
    scalar("trunk_clearance", [](const NodeMargins& n) { return n.geometry.trunk; });
    scalar("link_clearance", [](const NodeMargins& n) { return n.geometry.links; });
    scalar("legs_distance", [](const NodeMargins& n) { return n.geometry.legs; });
    scalar("joint_slack", [](const NodeMargins& n) { return n.geometry.joints.slack; });
    scalar("com_margin", [](const NodeMargins& n) { return n.com; });
    scalar("firm_com_margin", [](const NodeMargins& n) { return n.firm_com; });
    scalar("strayed_com_margin", [](const NodeMargins& n) { return n.strayed_com; });
    scalar("com_height", [](const NodeMargins& n) { return n.com_height; });
    scalar("friction_needed", [](const NodeMargins& n) { return n.friction_needed; });
    out["forces"] = column<4>(m, {2, 2}, [](const NodeMargins& n) {
        return std::array{n.forces[0].tangential, n.forces[0].normal, n.forces[1].tangential, n.forces[1].normal};
    });
    out["torques"] = column<6>(m, {2, 3}, [](const NodeMargins& n) {
        const auto& [f, r] = n.torques;
        return std::array{f.thigh, f.calf, f.wheel, r.thigh, r.calf, r.wheel};
    });
    return out;
}

nb::ndarray<nb::numpy, double> rows(const std::vector<Node>& path) {
    std::vector<double> out;
    out.reserve(5 * path.size());
    for (const auto& [s, body] : path) out.insert(out.end(), {s.front, s.rear, body.x, body.z, body.pitch});
    return give(std::move(out), {path.size(), 5});
}

nb::ndarray<nb::numpy, double> rows(const BandMatrix& h) {
    std::vector<double> out;
    for (const auto& row : h) out.insert(out.end(), row.begin(), row.end());
    return give(std::move(out), {h.size(), kBand + 1});
}

RefinedPath run(const RefineProblem& problem, const Nodes& ends, const Nodes& poses, const NodeSpacing& spacing, std::size_t held,
                const Points& as_drawn) {
    if (ends.shape(0) != 2 || poses.shape(0) < 2 || held < 1 || held > 20)
        throw nb::value_error("a way needs two ends, two poses and 1 to 20 nodes held");
    const std::vector<Node> given = nodes(poses), two = nodes(ends);
    std::vector<WheelPlaces> drawn;
    for (std::size_t k = 0; k < as_drawn.shape(0); ++k) drawn.push_back({as_drawn(k, 0), as_drawn(k, 1)});
    const nb::gil_scoped_release released;
    return smoothing::refine(problem, {two[0], two[1]}, given, spacing, held, drawn);
}

}  // namespace

void bind_smoothing(nb::module_& m) {
    nb::class_<RobotModel>(m, "RobotModel", "A robot, with what planning derives from it once.")
        .def(nb::init<const Robot&>())
        .def_prop_ro("reach", [](const RobotModel& r) {
            std::vector<std::pair<double, double>> out;
            for (const LegModel& leg : r.legs) out.emplace_back(leg.reach.least, leg.reach.most);
            return out;
        }, "Least and largest distance from hip to wheel of front and rear leg [m].")
        .def_prop_ro("most_wheel_distance", &RobotModel::most_wheel_distance, "Of the wheels' centres, in any pose [m].")
        .def_prop_ro("legs_alike", &RobotModel::legs_alike, "Whether front and rear leg reach alike, whatever their hips.");
    m.attr("LEGS_GAP") = kLegsGap;
    m.attr("LIGHT") = smoothing::kLight;
    m.attr("LEAN") = smoothing::kLean;
    m.attr("LOW") = smoothing::kLow;
    m.attr("SPARE") = smoothing::kSpare;
    m.attr("BESIDE") = kBeside;
    nb::class_<PathWeights>(m, "PathWeights")
        .def(nb::init<double, double, double, double, double>(), nb::arg("com_margin"), nb::arg("clearance"),
             nb::arg("torque"), nb::arg("smoothness"), nb::arg("pitch"));
    nb::class_<NodeSpacing>(m, "NodeSpacing")
        .def(nb::init<double, double, double, bool>(), nb::arg("softness"), nb::arg("spacing"), nb::arg("swing"),
             nb::arg("thorough") = false);
    nb::class_<ExtraMargins>(m, "ExtraMargins", "What a path keeps beyond its bounds, for ground that is not as drawn.")
        .def(nb::init<double, double, double, double, double>(), nb::arg("trunk") = 0.0, nb::arg("links") = 0.0, nb::arg("legs") = 0.0,
             nb::arg("reach") = 0.0, nb::arg("joints") = 0.0);
    nb::class_<RefineProblem>(m, "RefineProblem")
        .def(nb::init<const Terrain&, const WheelPath&, const RobotModel&, double, double, double, double, PathWeights, bool, ExtraMargins>(),
             nb::arg("terrain"), nb::arg("path"), nb::arg("robot"), nb::arg("friction"), nb::arg("reserve"), nb::arg("lag"),
             nb::arg("standing_height"), nb::arg("weights"), nb::arg("torques") = false,
             nb::arg("extra") = ExtraMargins(), nb::keep_alive<1, 2>(), nb::keep_alive<1, 3>(), nb::keep_alive<1, 4>())
        .def("refine", [](const RefineProblem& problem, const Nodes& ends, const Nodes& poses, const NodeSpacing& spacing,
                          std::size_t held, const Points& as_drawn) {
            const RefinedPath found = run(problem, ends, poses, spacing, held, as_drawn);
            return std::pair(rows(found.nodes), arrays(found.margins));
        }, nb::arg("ends"), nb::arg("poses"), nb::arg("spacing"), nb::arg("held"), nb::arg("as_drawn"),
           "Rows (s_front, s_rear, x, z, pitch) of the nodes, and their margins by name. Round the arc lengths (s_front, s_rear)\n"
           "`as_drawn` no room is kept for ground that is not.")
        .def("cost", [](const RefineProblem& problem, const Nodes& path) {
            const smoothing::PathCost found = smoothing::path_cost(problem, nodes(path));
            const smoothing::CostTerms& t = found.terms;
            const std::map<std::string, double> terms = {{"com_margin", t.com_margin}, {"clearance", t.clearance},
                                                         {"torque", t.torque}, {"smoothness", t.smoothness}, {"pitch", t.pitch}};
            return std::pair(found.total, terms);
        }, nb::arg("nodes"), "What the smoothing makes small, and the quantity of each weight by name.")
        .def("margins", [](const RefineProblem& p, const Nodes& path) {
            return arrays(smoothing::node_margins(p.terrain, p.path, p.robot, nodes(path), p.friction, p.lag));
        }, nb::arg("nodes"));
    nb::class_<Evenness>(m, "Evenness")
        .def(nb::init<double, double, double>(), nb::arg("rate"), nb::arg("curvature"), nb::arg("lever"))
        .def("cost", [](const Evenness& self, const In<double, nb::shape<-1, 3>>& nodes) {
            std::vector<Body> bodies(nodes.shape(0));
            for (std::size_t k = 0; k < bodies.size(); ++k) bodies[k] = {nodes(k, 0), nodes(k, 1), nodes(k, 2)};
            std::vector<double> gradient(3 * bodies.size());
            const double cost = self.cost(bodies, gradient);
            return std::pair(cost, give(std::move(gradient)));
        }, nb::arg("nodes"), "The cost, and half its gradient.")
        .def("hessian", [](const Evenness& self, std::size_t n) { return rows(self.hessian(n)); }, nb::arg("n"),
             "Half the second derivatives: rows i with H[i, i + k].");
    m.def("solve_banded", [](const In<double, nb::shape<-1, kBand + 1>>& h, const Vector& b) {
        if (h.shape(0) != b.size()) throw nb::value_error("as many rows as right-hand sides, please");
        BandMatrix matrix(b.size() + kBand);
        for (std::size_t i = 0; i < b.size(); ++i)
            for (int k = 0; k <= kBand; ++k) matrix[i][k] = h(i, k);
        std::vector<double> x(b.data(), b.data() + b.size());
        x.resize(b.size() + kBand);
        smoothing::solve_banded(matrix, x);
        x.resize(b.size());
        return give(std::move(x));
    }, "Solve H x = b for rows i with H[i, i + k].");
    m.def("contact_changes", [](const WheelPath& path, const Nodes& given) {
        return give(smoothing::contact_changes(path, nodes(given)));
    }, "Where contacts change between nodes, as fractional node numbers.");
    m.def("intervals_along", [](const WheelPath& path, const Nodes& given, double friction, double reserve, double lag) {
        const std::vector<Node> path_nodes = nodes(given);
        const std::vector<double> changes = smoothing::contact_changes(path, path_nodes);
        std::vector<double> out;
        for (const NodeIntervals& n : smoothing::intervals_along(path, path_nodes, changes, friction, reserve, lag))
            for (const Interval& i : {n.full, n.reserve, n.lagged}) out.insert(out.end(), {i.lower, i.upper});
        return give(std::move(out), {path_nodes.size(), 6});
    }, "CoM intervals (n, 6) that the smoothing keeps: at friction, at the reserve, with lag.");
    m.def("firm_com_margins", [](const WheelPath& path, const In<double, nb::shape<-1, 2>>& s, const Vector& com_x, double friction) {
        if (s.shape(0) != com_x.size()) throw nb::value_error("as many arc lengths as mass centres, please");
        std::vector<double> out(com_x.size());
        for (std::size_t k = 0; k < out.size(); ++k)
            out[k] = com_margin(pair_interval(path, {s(k, 0), s(k, 1)}, friction), com_x(k));
        return give(std::move(out));
    }, "CoM margins (n,) with the wheels at `s` (n, 2), friction on one face of a corner only [m].");
}

}  // namespace stairwright::python
