#include <nanobind/stl/array.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "stairwright/kinematics.hpp"

namespace stairwright::python {

void bind_robot(nb::module_& m) {
    nb::class_<Vec2>(m, "Vec2").def(nb::init<double, double>()).def_rw("x", &Vec2::x).def_rw("z", &Vec2::z);
    nb::class_<Range>(m, "Range").def(nb::init<double, double>()).def_rw("lower", &Range::lower).def_rw("upper", &Range::upper);
    nb::class_<Motor>(m, "Motor").def(nb::init<double, double>()).def_rw("torque", &Motor::torque).def_rw("speed", &Motor::speed);
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
}

}  // namespace stairwright::python
