#include <nanobind/stl/array.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "stairwright/clearance.hpp"

namespace stairwright::python {

namespace {

using Trunk3 = In<double, nb::shape<3>>;
using Joints4 = In<double, nb::shape<4>>;

Body body(const Trunk3& t) { return {t(0), t(1), t(2)}; }

std::array<LegPoints, 2> legs(const Robot& robot, const Trunk3& t, const Joints4& q) {
    return {forward(robot.legs[kFront], body(t), {q(0), q(1)}), forward(robot.legs[kRear], body(t), {q(2), q(3)})};
}

}  // namespace

void bind_robot(nb::module_& m) {
    nb::class_<Vec2>(m, "Vec2").def(nb::init<double, double>()).def_rw("x", &Vec2::x).def_rw("z", &Vec2::z);
    nb::class_<Range>(m, "Range").def(nb::init<double, double>()).def_rw("lower", &Range::lower).def_rw("upper", &Range::upper);
    nb::class_<Motor>(m, "Motor").def(nb::init<double, double, double, double>(), nb::arg("torque"), nb::arg("speed"), nb::arg("armature") = 0.0, nb::arg("damping") = 0.0).def_rw("torque", &Motor::torque).def_rw("speed", &Motor::speed);
    nb::class_<Capsule>(m, "Capsule").def(nb::init<Vec2, Vec2, double>());
    nb::class_<Polygon>(m, "Polygon").def("__init__", [](Polygon* self, const Points& corners) { new (self) Polygon(points(corners)); });
    nb::class_<Link>(m, "Link").def("__init__", [](Link* self, Vec2 end, Vec2 com, double mass, double inertia, std::vector<Capsule> shape) {
        new (self) Link{end, com, mass, inertia, std::move(shape)};
    });
    nb::class_<Wheel>(m, "Wheel").def(nb::init<double, double, double>()).def_rw("radius", &Wheel::radius);
    nb::class_<Leg>(m, "Leg")
        .def(nb::init<Vec2, Link, Link, Wheel, Range, Range, Motor, Motor, Motor, double>())
        .def_rw("thigh_range", &Leg::thigh_range)
        .def_rw("calf_range", &Leg::calf_range)
        .def_rw("thigh_motor", &Leg::thigh_motor)
        .def_rw("calf_motor", &Leg::calf_motor)
        .def_rw("wheel_motor", &Leg::wheel_motor)
        .def_rw("wheel", &Leg::wheel)
        .def_rw("knee", &Leg::knee);
    nb::class_<Trunk>(m, "Trunk").def(nb::init<double, double, Vec2, std::vector<Polygon>>());
    nb::class_<Robot>(m, "Robot")
        .def(nb::init<Trunk, std::array<Leg, 2>, double, double>())
        .def("__copy__", [](const Robot& robot) { return robot; })
        .def_rw("legs", &Robot::legs)
        .def_prop_ro("mass", &Robot::mass);
    m.def("least_clearance", [](const Terrain& terrain, const Robot& robot, const Trunk3& trunk, const Joints4& q) {
        return least_clearance(terrain, robot, body(trunk), legs(robot, trunk, q)).distance;
    }, nb::arg("terrain"), nb::arg("robot"), nb::arg("trunk"), nb::arg("q"),
       "Least distance of trunk (x, z, pitch) and links from the ground [m]; minus the depth inside.");
    m.def("legs_distance", [](const Robot& robot, const Trunk3& trunk, const Joints4& q) {
        return legs_distance(RobotModel(robot), legs(robot, trunk, q));
    }, nb::arg("robot"), nb::arg("trunk"), nb::arg("q"), "Distance of the front from the rear leg [m].");
}

}  // namespace stairwright::python
