#include <algorithm>
#include <sstream>

#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "stairwright/player/player.hpp"

namespace stairwright::python {

namespace {

using namespace player;

using Imu = In<double, nb::shape<6>>;
using Motors = In<double, nb::shape<kMotors, 3>>;

auto numbers(const LowCommand& command) {
    std::vector<double> out;
    for (const MotorCommand& m : command.motors) out.insert(out.end(), {m.q, m.dq, m.tau, m.kp, m.kd});
    return give(std::move(out), {kMotors, 5});
}

LowState low_state(double time, const Imu& imu, const Motors& motors) {
    LowState out;
    out.time = time;
    for (int i = 0; i < 3; ++i) out.gyro[i] = imu(i), out.accelerometer[i] = imu(i + 3);
    for (std::size_t k = 0; k < kMotors; ++k) out.motors[k] = {motors(k, 0), motors(k, 1), motors(k, 2)};
    return out;
}

}  // namespace

void bind_player(nb::module_& m) {
    nb::class_<player::Player>(m, "Player", "What stairwright_player is without its socket, see player/player.hpp.")
        .def("__init__", [](player::Player* self, const std::string& text) {
            std::istringstream lines(text);
            new (self) player::Player(read_plan_file(lines));
        }, nb::arg("plan_file"), "Raises RuntimeError if the text is no plan file.")
        .def("step", [](player::Player& self, double time, const Imu& imu, const Motors& motors) {
            return numbers(self.step(low_state(time, imu, motors)));
        }, nb::arg("time"), nb::arg("imu"), nb::arg("motors"), nb::rv_policy::automatic,
           "What the motors are to do (16, 5): q, dq, tau, kp, kd; after gyro and accelerometer (6,) and q, dq, tau (16, 3).")
        .def("pause", &player::Player::pause)
        .def("damp", &player::Player::damp, nb::arg("why"))
        .def_prop_ro("phase", [](const player::Player& p) {
            return std::string(name(p.phase()));
        }, "waiting, settling, driving, arrived, gave up, refused or damped.")
        .def_prop_ro("reason", &player::Player::reason)
        .def_prop_ro("done", &player::Player::done)
        .def_prop_ro("pitch", &player::Player::pitch);
}

}  // namespace stairwright::python
