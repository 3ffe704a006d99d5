#include "stairwright/rollout/perception.hpp"

#include <cmath>

namespace stairwright::rollout {

namespace {

// The state after `time` at constant rates.
RobotState ahead(const RobotState& state, double time) {
    if (time <= 0.0) return state;
    RobotState out = state;
    for (int i = 0; i < 3; ++i) out.position[i] += time * state.velocity[i];
    for (int j = 0; j < 12; ++j) out.joints[j] += time * state.joint_rates[j];
    const auto [w, x, y, z] = state.quaternion;
    const double a = 0.5 * time * state.angular_velocity[0], b = 0.5 * time * state.angular_velocity[1], c = 0.5 * time * state.angular_velocity[2];
    std::array<double, 4> q = {w - x * a - y * b - z * c, x + w * a + y * c - z * b, y + w * b + z * a - x * c, z + w * c + x * b - y * a};
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4; ++i) out.quaternion[i] = q[i] / length;
    return out;
}

}  // namespace

Perceived RobotSense::perceive(const RobotState& truth, const control::Torques& torques, double dt) {
    const std::size_t slot = seen_ % late_.size();
    late_[slot] = sensors_.read(truth, torques, dt), truths_[slot] = truth;
    ++seen_;
    const estimation::Readings& now = late_[slot];
    const estimation::Estimate& estimate = estimator_.step(late_[oldest()], dt);
    Perceived out = {ahead(estimate.state, static_cast<double>(late_.size() - 1) * dt), estimate.places, estimate.ground};
    out.ahead = {estimate.searching, estimate.on_tread, estimate.hanging};
    out.used_grip = estimate.used_grip, out.map_error = estimate.map_error;
    out.joints = now.joints, out.joint_rates = now.joint_rates;
    return out;
}

}  // namespace stairwright::rollout
