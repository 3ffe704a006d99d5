#include "stairwright/terrain.hpp"

#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "stairwright/obstacles.hpp"
#include "stairwright/wheel_path.hpp"

namespace stairwright::python {

namespace {

// Rows [kind, s0, length, x, z, a, b], see Piece.
constexpr std::size_t kColumns = 7;

nb::ndarray<nb::numpy, double> pieces(const WheelPath& path) {
    std::vector<double> out;
    for (const Piece& p : path.pieces())
        out.insert(out.end(), {p.arc ? 1.0 : 0.0, p.s, p.length, p.origin.x, p.origin.z, p.a, p.b});
    const std::size_t rows = path.pieces().size();
    return give(std::move(out), {rows, kColumns});
}

// Rows (x, z, nx, nz) at each arc length.
nb::ndarray<nb::numpy, double> sample(const WheelPath& path, const Vector& s) {
    std::vector<double> out;
    out.reserve(4 * s.size());
    for (const double at : view<double>(s)) {
        const CurvePoint p = path.at(at);
        out.insert(out.end(), {p.centre.x, p.centre.z, p.normal.x, p.normal.z});
    }
    return give(std::move(out), {s.size(), 4});
}

}  // namespace

void bind_terrain(nb::module_& m) {
    nb::class_<Terrain>(m, "Terrain")
        .def("__init__", [](Terrain* self, const Points& vertices) { new (self) Terrain(points(vertices)); })
        .def("height", &Terrain::height)
        .def("distance", [](const Terrain& t, double x, double z, double r) { return t.distance({x, z}, r); })
        .def("link_clearance", [](const Terrain& t, double ax, double az, double bx, double bz, double radius,
                                  double r) { return t.link_clearance({ax, az}, {bx, bz}, radius, r); })
        .def("polygon_clearance", [](const Terrain& t, const Polygon& polygon, double x, double z, double pitch,
                                     double r) { return t.polygon_clearance(polygon, {x, z}, Turn::by(pitch), r); });
    nb::class_<WheelPath>(m, "WheelPath")
        .def("__init__", [](WheelPath* self, const Points& v, double radius) { new (self) WheelPath(points(v), radius); })
        .def_prop_ro("radius", &WheelPath::radius)
        .def_prop_ro("length", &WheelPath::length)
        .def_prop_ro("pieces", &pieces, nb::rv_policy::automatic)
        .def_prop_ro("corners", [](const WheelPath& path) { return give(std::vector<double>(path.corners())); }, nb::rv_policy::automatic)
        .def("sample", &sample)
        .def("project", [](const WheelPath& path, double x, double z, double lower, double upper) {
            return path.project({x, z}, lower, upper);
        });
    nb::class_<Obstacle>(m, "Obstacle", "A rise or descent of the wheel's centre between two treads. Lengths in m.")
        .def_ro("begin", &Obstacle::begin, "Arc length where the wheel arrives at the face (eq 25).")
        .def_ro("end", &Obstacle::end, "Arc length where the next tread is reached.")
        .def_ro("height", &Obstacle::height, "Gained, or lost where negative (h of eq 26).")
        .def_ro("face", &Obstacle::face, "h / sin(gamma), gamma the steepest slope of the wheel's way.")
        .def_ro("steepest", &Obstacle::steepest, "Arc length of the last place that is as steep.");
    m.def("find_obstacles", &find_obstacles, nb::arg("path"), nb::arg("lower"), nb::arg("upper"));
}

}  // namespace stairwright::python
