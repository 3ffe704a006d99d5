// What a robot's sensors say of the true state: encoders, motor currents, an IMU at the trunk point.
#pragma once

#include "stairwright/control/controller.hpp"
#include "stairwright/estimation/readings.hpp"
#include "stairwright/rollout/normal_noise.hpp"

namespace stairwright::rollout {

// Standard deviations of white noise in a reading (500 Hz), and of biases, which stay as they are from the start. SI
// units. A fair encoder and a cheap MEMS inertial sensor on a robot that shakes.
struct SensorErrors {
    double joint = 0.0005, joint_rate = 0.05;
    double torque = 0.0045;       // share of the motor's peak torque: the range of its current sensor goes with it
    double gyro = 0.01, gyro_bias = 0.005;
    double specific_force = 0.1, force_bias = 0.1;
    double wheel_scale = 0.0;     // share by which the wheels' turning is read too large
    double tilt = 0.0;            // the IMU is mounted pitched by this [rad]
    std::array<double, 3> gyro_offset{}, force_offset{};  // added to the drawn biases
};

// Errors of `scale` times those of the usual sensors.
SensorErrors usual_errors(double scale);

class RobotSensors {
  public:
    RobotSensors(const Robot& robot, const SensorErrors& errors, std::uint64_t seed);

    // Readings of the state `truth` at time step `dt` after the last one; torques are those that acted since. The
    // accelerometer reads the mean over the step, as one does that integrates inside.
    estimation::Readings read(const control::RobotState& truth, const control::Torques& torques, double dt);

  private:
    SensorErrors errors_;
    std::array<double, 12> torque_;  // standard deviations [Nm]
    NormalNoise noise_;
    std::array<double, 3> gyro_bias_{}, force_bias_{};
    control::RobotState last_{};
    bool started_ = false;
};

}  // namespace stairwright::rollout
