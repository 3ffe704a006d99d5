// What passes between the player and a robot with 16 motors: the low-level interface of such robots (Unitree's Go2-W and
// B2-W among them). Motors 0-11 are abduction, thigh and calf of the legs FR, FL, RR, RL; 12-15 their wheels in the same
// order. Angles, rates and torques are the robot's own: signs and zero angles as its software counts them.
#pragma once

#include <array>

namespace stairwright::player {

inline constexpr std::size_t kMotors = 16;

struct MotorState {
    double q = 0.0, dq = 0.0, tau = 0.0;  // rad, rad/s, Nm
};

struct LowState {
    double time = 0.0;                      // of the robot's own clock [s]
    std::array<double, 3> gyro{};           // x forward, y left, z up [rad/s]
    std::array<double, 3> accelerometer{};  // the same frame; (0, 0, g) at rest [m/s^2]
    std::array<MotorState, kMotors> motors{};
};

// The drive makes of it: tau + kp (q - its q) + kd (dq - its dq).
struct MotorCommand {
    double q = 0.0, dq = 0.0, tau = 0.0;  // rad, rad/s, Nm
    double kp = 0.0, kd = 0.0;            // Nm/rad, Nm s/rad; wheels have no kp
};

struct LowCommand {
    std::array<MotorCommand, kMotors> motors{};
};

}  // namespace stairwright::player
