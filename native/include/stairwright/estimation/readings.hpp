// What the robot's own sensors say at one instant: nothing global. SI units; joints are thigh, calf, wheel of the legs
// FL, FR, RL, RR, as everywhere.
#pragma once

#include <array>

namespace stairwright::estimation {

struct Readings {
    std::array<double, 12> joints{}, joint_rates{};  // encoders [rad, rad/s]
    std::array<double, 12> torques{};                // of the motors, from their currents, less what moves the legs as planned [Nm]
    std::array<double, 3> angular_rate{};            // gyro, trunk frame [rad/s]
    std::array<double, 3> specific_force{};          // accelerometer, trunk frame: (0, 0, g) at rest [m/s^2]
};

}  // namespace stairwright::estimation
