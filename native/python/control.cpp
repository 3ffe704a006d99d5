#include <algorithm>
#include <bit>
#include <span>

#include "arrays.hpp"
#include "bindings.hpp"
#include "stairwright/control/controller.hpp"
#include "stairwright/control/leg_fit.hpp"
#include "stairwright/control/safe_stop.hpp"
#include "stairwright/control/static_forces.hpp"

namespace stairwright::python {

namespace {

using namespace control;

template <nb::ssize_t... N>
using Fixed = In<double, nb::shape<N...>>;

nb::ndarray<nb::numpy, double> balance_forces(const Fixed<8, 8>& H, const Fixed<8>& g, const Fixed<4>& friction,
                                              double load_limit, const Fixed<8>& start) {
    BalanceQp qp;
    for (int i = 0; i < 8; ++i) std::copy_n(H.data() + 8 * i, 8, qp.H[i].begin());
    std::copy_n(g.data(), 8, qp.g.begin());
    std::copy_n(friction.data(), 4, qp.friction.begin());
    qp.load_limit = load_limit;
    Forces forces;
    std::copy_n(start.data(), 8, forces.begin());
    solve(qp, forces);
    return give(std::vector<double>(forces.begin(), forces.end()));
}

RobotState robot_state(const Fixed<19>& qpos, const Fixed<18>& qvel) {
    RobotState out;
    std::copy_n(qpos.data(), 3, out.position.begin());
    std::copy_n(qpos.data() + 3, 4, out.quaternion.begin());
    std::copy_n(qpos.data() + 7, 12, out.joints.begin());
    std::copy_n(qvel.data(), 3, out.velocity.begin());
    std::copy_n(qvel.data() + 3, 3, out.angular_velocity.begin());
    std::copy_n(qvel.data() + 6, 12, out.joint_rates.begin());
    return out;
}

Reference reference(const Fixed<kReferenceWidth>& row) {
    std::array<double, kReferenceWidth> numbers;
    std::copy_n(row.data(), kReferenceWidth, numbers.begin());
    return std::bit_cast<Reference>(numbers);
}

template <std::size_t N>
auto numbers(const std::array<double, N>& values) {
    return give(std::vector<double>(values.begin(), values.end()));
}

nb::ndarray<nb::numpy, double> static_forces_along(const WheelPath& path, double weight, double friction, const Points& places,
                                                   const Points& com) {
    if (places.shape(0) != com.shape(0)) throw std::invalid_argument("places and com must have as many rows");
    std::vector<double> out;
    {
        nb::gil_scoped_release release;
        for (std::size_t k = 0; k < places.shape(0); ++k) {
            const StaticForces f = static_forces(path, weight, friction, {places(k, 0), places(k, 1)}, {com(k, 0), com(k, 1)});
            out.insert(out.end(), {f.force[0].x, f.force[0].z, f.force[1].x, f.force[1].z, f.friction_share,
                                   static_cast<double>(f.lean[0]), static_cast<double>(f.lean[1])});
        }
    }
    return give(std::move(out), {places.shape(0), 7});
}

void bind_gains(nb::module_& m) {
    nb::class_<Gains>(m, "Gains", "Gains and weights of the controller, see native/include/stairwright/control.")
        .def(nb::init<>())
        .def_rw("joint_stiffness", &Gains::joint_stiffness)
        .def_rw("joint_damping", &Gains::joint_damping)
        .def_rw("wheel_damping", &Gains::wheel_damping)
        .def_rw("wheel_sync", &Gains::wheel_sync)
        .def_rw("yaw_damping", &Gains::yaw_damping)
        .def_rw("heading_stiffness", &Gains::heading_stiffness)
        .def_rw("com_stiffness", &Gains::com_stiffness)
        .def_rw("com_damping", &Gains::com_damping)
        .def_rw("pitch_stiffness", &Gains::pitch_stiffness)
        .def_rw("pitch_damping", &Gains::pitch_damping)
        .def_rw("pitch_integral", &Gains::pitch_integral)
        .def_rw("roll_stiffness", &Gains::roll_stiffness)
        .def_rw("roll_damping", &Gains::roll_damping)
        .def_rw("force_weight", &Gains::force_weight)
        .def_rw("moment_weight", &Gains::moment_weight)
        .def_rw("alpha", &Gains::alpha)
        .def_rw("beta", &Gains::beta)
        .def_rw("friction_share", &Gains::friction_share)
        .def_rw("force_limit", &Gains::force_limit);
}

// What a robot that senses by itself does beside balancing, for tests.
void bind_own_senses(nb::module_& m) {
    nb::class_<LegFit>(m, "LegFit", "Legs that fit the ground as it is found to be, see control/leg_fit.hpp.")
        .def(nb::init<Robot>(), nb::arg("robot"))
        .def("fit", [](LegFit& self, const Fixed<kReferenceWidth>& planned, const Fixed<2, 2>& ground, const WheelPath& path, double friction, double dt) {
            const auto row = std::bit_cast<std::array<double, kReferenceWidth>>(
                self.fit(reference(planned), {Vec2{ground(0, 0), ground(0, 1)}, Vec2{ground(1, 0), ground(1, 1)}}, path, friction, dt));
            return numbers(row);
        }, nb::arg("planned"), nb::arg("ground"), nb::arg("path"), nb::arg("friction"), nb::arg("dt"), nb::rv_policy::automatic,
           "A set point's row for front and rear ground (2, 2) off its planned place [m], after another time step [s].");
    nb::class_<SafeStop>(m, "SafeStop", "When to give up, see control/safe_stop.hpp.")
        .def(nb::init<>())
        .def("watch", [](SafeStop& self, double position, bool advancing, double dt, double pitch_error, bool lost) {
            return static_cast<int>(self.watch(position, advancing, pitch_error, 0.0, lost, dt));
        }, nb::arg("position"), nb::arg("advancing"), nb::arg("dt"), nb::arg("pitch_error") = 0.0, nb::arg("lost") = false,
           "Why to stop: 0 not at all, 1 no progress, 2 the trunk leans too far, 3 lost.");
}

}  // namespace

void bind_control(nb::module_& m) {
    m.attr("CREEP") = kCreep;
    m.def("balance_forces", &balance_forces, nb::arg("H"), nb::arg("g"), nb::arg("friction"), nb::arg("load_limit"),
          nb::arg("start"), nb::rv_policy::automatic,
          "Forces (8,) of the balance QP (eqs 11-12) [N], per wheel tangential and normal; `start` is a guess.");
    m.def("static_forces", &static_forces_along, nb::arg("path"), nb::arg("weight"), nb::arg("friction"), nb::arg("places"),
          nb::arg("com"), nb::rv_policy::automatic,
          "Rows (n, 7): smallest forces of front and rear pair (x, z) at rest [N], share of the friction that they keep\n"
          "to, and what front and rear wheels lean on in a corner; for places and mass centres (n, 2) [m].");
    bind_gains(m);
    bind_own_senses(m);
    nb::class_<Controller>(m, "Controller", "The balance controller, form contact; keeps forces and places.")
        .def(nb::init<Robot, WheelPath, double, const Gains&>(), nb::arg("robot"), nb::arg("path"), nb::arg("friction"), nb::arg("gains"))
        .def("step", [](Controller& self, const Fixed<19>& qpos, const Fixed<18>& qvel, const Fixed<kReferenceWidth>& target) {
            return numbers(self.step(robot_state(qpos, qvel), reference(target)));
        }, nb::arg("qpos"), nb::arg("qvel"), nb::arg("target"), nb::rv_policy::automatic,
           "Torques (12,) before the motors' limits [Nm]; `target` is a row in the order of control.setpoint.")
        .def_prop_ro("forces", [](const Controller& c) { return numbers(c.forces()); }, nb::rv_policy::automatic)
        .def_prop_ro("places", [](const Controller& c) { return numbers(c.places()); }, nb::rv_policy::automatic)
        .def_prop_ro("pitch_integral", &Controller::pitch_integral)
        .def_prop_ro("tips", &Controller::tips);
    m.def("available_torque", &available_torque, nb::arg("motor"), nb::arg("torque"), nb::arg("speed"),
          "The part of `torque` [Nm] that a motor can give while it turns at `speed` [rad/s].");
    m.def("limit_torques", [](const Robot& robot, const Fixed<12>& rates, const Fixed<12>& wanted) {
        Torques torques;
        std::copy_n(wanted.data(), 12, torques.begin());
        return numbers(limit_torques(robot, std::span<const double, 12>(rates.data(), 12), torques));
    }, nb::arg("robot"), nb::arg("joint_rates"), nb::arg("wanted"), nb::rv_policy::automatic,
       "What the motors give of the wanted torques (12,) [Nm].");
}

}  // namespace stairwright::python
