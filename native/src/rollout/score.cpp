#include "stairwright/rollout/score.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stairwright::rollout {

void Score::add(const control::RobotState& truth, const control::Torques& torques, const control::Reference& target, double dt) {
    constexpr double full = 2 * std::numbers::pi;
    const auto [w, x, y, z] = truth.quaternion;
    const double pitch = std::atan2(2 * (x * z + w * y), 1 - 2 * (x * x + y * y));
    double error = pitch - target.value.pitch;
    error -= full * std::floor((error + std::numbers::pi) / full);
    pitch_error = error;
    tilt = std::abs(std::asin(std::min(1.0, std::max(-1.0, 2 * (y * z + w * x)))));
    pitch_error_max = std::max(pitch_error_max, std::abs(error));
    pitch_error_squares += error * error;
    steps += 1.0;
    for (int j = 0; j < 12; ++j) {
        const int leg = j / 3, part = j % 3;
        energy += std::abs(torques[j] * truth.joint_rates[j]) * dt;
        if (part == 2) {
            wheel_torque_max = std::max(wheel_torque_max, std::abs(torques[j]));
            continue;
        }
        leg_torque_max = std::max(leg_torque_max, std::abs(torques[j]));
        const double off = truth.joints[j] - target.value.joints[2 * (leg / 2) + part];
        joint_error_squares += off * off;
    }
}

}  // namespace stairwright::rollout
