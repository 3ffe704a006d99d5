#include "stairwright/rollout/robot_sensors.hpp"

#include <cmath>

namespace stairwright::rollout {

namespace {

using Vec3 = std::array<double, 3>;

// A world vector in the frame of the trunk.
Vec3 in_trunk(const std::array<double, 4>& q, const Vec3& v) {
    const auto [w, x, y, z] = q;
    return {(1 - 2 * (y * y + z * z)) * v[0] + 2 * (x * y + w * z) * v[1] + 2 * (x * z - w * y) * v[2],
            2 * (x * y - w * z) * v[0] + (1 - 2 * (x * x + z * z)) * v[1] + 2 * (y * z + w * x) * v[2],
            2 * (x * z + w * y) * v[0] + 2 * (y * z - w * x) * v[1] + (1 - 2 * (x * x + y * y)) * v[2]};
}

// A trunk vector as a sensor pitched by `tilt` sees it.
Vec3 tilted(double tilt, const Vec3& v) {
    const double c = std::cos(tilt), s = std::sin(tilt);
    return {c * v[0] - s * v[2], v[1], s * v[0] + c * v[2]};
}

}  // namespace

SensorErrors usual_errors(double scale) {
    SensorErrors e;
    for (double* v : {&e.joint, &e.joint_rate, &e.torque, &e.gyro, &e.gyro_bias, &e.specific_force, &e.force_bias}) *v *= scale;
    return e;
}

RobotSensors::RobotSensors(const Robot& robot, const SensorErrors& errors, std::uint64_t seed) : errors_(errors), noise_(seed) {
    for (std::size_t j = 0; j < 12; ++j) {
        const Leg& leg = robot.legs[j / 6];
        const std::array<const Motor*, 3> motors = {&leg.thigh_motor, &leg.calf_motor, &leg.wheel_motor};
        torque_[j] = errors.torque * motors[j % 3]->torque;
    }
    for (int i = 0; i < 3; ++i) gyro_bias_[i] = errors.gyro_offset[i] + errors.gyro_bias * noise_();
    for (int i = 0; i < 3; ++i) force_bias_[i] = errors.force_offset[i] + errors.force_bias * noise_();
}

estimation::Readings RobotSensors::read(const control::RobotState& truth, const control::Torques& torques, double dt) {
    if (!started_) last_ = truth, started_ = true;
    estimation::Readings out;
    for (int j = 0; j < 12; ++j) {
        const bool wheel = j % 3 == 2;
        out.joints[j] = truth.joints[j] + errors_.joint * noise_();
        out.joint_rates[j] = truth.joint_rates[j] * (wheel ? 1.0 + errors_.wheel_scale : 1.0) + errors_.joint_rate * noise_();
        out.torques[j] = torques[j] + torque_[j] * noise_();
    }
    // Between the two attitudes.
    std::array<double, 4> middle;
    double length = 0.0;
    for (int i = 0; i < 4; ++i) middle[i] = truth.quaternion[i] + last_.quaternion[i], length += middle[i] * middle[i];
    for (double& v : middle) v /= std::sqrt(length);
    Vec3 felt;
    for (int i = 0; i < 3; ++i) felt[i] = (truth.velocity[i] - last_.velocity[i]) / dt + (i == 2 ? kGravity : 0.0);
    out.specific_force = tilted(errors_.tilt, in_trunk(middle, felt));
    out.angular_rate = tilted(errors_.tilt, truth.angular_velocity);
    for (int i = 0; i < 3; ++i) {
        out.specific_force[i] += force_bias_[i] + errors_.specific_force * noise_();
        out.angular_rate[i] += gyro_bias_[i] + errors_.gyro * noise_();
    }
    last_ = truth;
    return out;
}

}  // namespace stairwright::rollout
