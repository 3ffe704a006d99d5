#include "stairwright/execution/perceived.hpp"

#include <cmath>

namespace stairwright::execution {

namespace {

// The state after `time` at constant rates.
control::RobotState ahead(const control::RobotState& state, double time) {
    if (time <= 0.0) return state;
    control::RobotState out = state;
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

Perceived perceived(const estimation::Estimate& estimate, const estimation::Readings& now, double late) {
    Perceived out;
    out.state = ahead(estimate.state, late), out.places = estimate.places, out.ground = estimate.ground;
    out.ahead = {estimate.searching, estimate.on_tread, estimate.nearing, estimate.hanging, estimate.found};
    for (int i = 0; i < 4; ++i) out.feels_ground[i / 2] |= estimate.touching[i];
    out.felt = estimate.felt, out.used_grip = estimate.used_grip;
    out.lost = estimate.lost, out.map_error = estimate.map_error;
    out.joints = now.joints, out.joint_rates = now.joint_rates;
    return out;
}

}  // namespace stairwright::execution
