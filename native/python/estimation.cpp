#include <nanobind/stl/array.h>
#include <nanobind/stl/tuple.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "stairwright/estimation/curve_match.hpp"
#include "stairwright/estimation/estimator.hpp"

namespace stairwright::python {

namespace {

using namespace estimation;
using Pair = std::array<double, 2>;

Vec2 vec(const Pair& p) { return {p[0], p[1]}; }

nb::typed<nb::dict, nb::str, nb::object> curve_match(const WheelPath& path, const Pair& centre, const std::array<double, 3>& spread, const Pair& force,
                     double traction, double force_deviation, double last, double window) {
    const WheelBelief wheel = {vec(centre), {spread[0], spread[1], spread[2]}, vec(force), traction, force_deviation};
    const CurveMatch found = match(path, wheel, last, window);
    nb::dict out;
    out["s"] = found.s, out["corner"] = found.corner, out["cost"] = found.cost, out["beyond"] = found.beyond;
    out["blocked"] = found.blocked, out["normal"] = Pair{found.point.normal.x, found.point.normal.z};
    return out;
}

void bind_noise(nb::module_& m) {
    nb::class_<Noise>(m, "EstimatorNoise", "Standard deviations that the estimator counts on, see estimation/estimator.hpp.")
        .def(nb::init<>())
        .def_rw("start_place", &Noise::start_place)
        .def_rw("start_height", &Noise::start_height)
        .def_rw("start_tilt", &Noise::start_tilt)
        .def_rw("start_heading", &Noise::start_heading)
        .def_rw("start_gyro_bias", &Noise::start_gyro_bias)
        .def_rw("start_force_bias", &Noise::start_force_bias)
        .def_rw("scale", &Noise::scale)
        .def_rw("gyro", &Noise::gyro)
        .def_rw("specific_force", &Noise::specific_force)
        .def_rw("joint_rate", &Noise::joint_rate)
        .def_rw("gyro_bias", &Noise::gyro_bias)
        .def_rw("force_bias", &Noise::force_bias)
        .def_rw("map_along", &Noise::map_along)
        .def_rw("map_height", &Noise::map_height)
        .def_rw("face_place", &Noise::face_place)
        .def_rw("tread_height", &Noise::tread_height)
        .def_rw("creep", &Noise::creep)
        .def_rw("place", &Noise::place)
        .def_rw("rolling", &Noise::rolling)
        .def_rw("aside", &Noise::aside)
        .def_rw("off_face", &Noise::off_face)
        .def_rw("place_lasts", &Noise::place_lasts)
        .def_rw("rolling_lasts", &Noise::rolling_lasts)
        .def_rw("force", &Noise::force);
}

}  // namespace

void bind_estimation(nb::module_& m) {
    bind_noise(m);
    m.def("curve_match", &curve_match, nb::arg("path"), nb::arg("centre"), nb::arg("spread"), nb::arg("force"), nb::arg("traction"),
          nb::arg("force_deviation"), nb::arg("last"), nb::arg("window"),
          "The most likely place of a wheel on its path, see estimation/curve_match.hpp; `spread` is xx, xz, zz [m^2].");
    m.def("wheel_force", [](const Robot& robot, int pair, double pitch, double thigh, double calf, const std::array<double, 3>& torques) {
        const Leg& leg = robot.legs.at(static_cast<std::size_t>(pair));
        const Turn upper = Turn::by(pitch + thigh), lower = Turn::by(pitch + thigh + calf);
        const Vec2 hip = Turn::by(pitch) * leg.hip, knee = hip + upper * leg.thigh.end;
        const LegPlaces at = {hip, knee, knee + lower * leg.calf.end, hip + upper * leg.thigh.com, knee + lower * leg.calf.com};
        const WheelForce f = estimation::wheel_force(leg, at, torques[0], torques[1], torques[2]);
        return std::tuple(Pair{f.force.x, f.force.z}, f.traction, Pair{f.untold.x, f.untold.z});
    }, nb::arg("robot"), nb::arg("pair"), nb::arg("pitch"), nb::arg("thigh"), nb::arg("calf"), nb::arg("torques"),
       "What the torques of thigh, calf and wheel [Nm] tell of the ground's force on a wheel, see estimation/wheel_forces.hpp:\n"
       "the force in x and z, the traction [N], and the direction in which a straight leg tells none.");
}

}  // namespace stairwright::python
