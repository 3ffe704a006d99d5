// The balance controller (form `contact`): PD on mass centre and pitch, contact forces by a QP, torques by J' F,
// joint tracking and rolling feedback. It needs neither Python nor a simulator.
//
// Wheels and legs are in the order FL, FR, RL, RR; pairs are front, rear. SI units; angles about +y.
#pragma once

#include <optional>
#include <span>

#include "stairwright/control/balance_qp.hpp"
#include "stairwright/control/wheel_support.hpp"
#include "stairwright/robot.hpp"

namespace stairwright::control {

inline constexpr double kPeriod = 0.002;  // s, between control steps
// A wheel creeps: under a traction of a quarter of the weight it moves slower than it rolls by this, until a test of the
// grip tells better [m/s].
inline constexpr double kCreep = 0.014;

// What is measured.
struct RobotState {
    std::array<double, 3> position{};               // trunk point in the world [m]
    std::array<double, 4> quaternion{1.0, 0, 0, 0}; // trunk to world, w x y z
    std::array<double, 12> joints{};                // thigh, calf, wheel of each leg [rad]
    std::array<double, 3> velocity{};               // in the world [m/s]
    std::array<double, 3> angular_velocity{};       // in the trunk frame [rad/s]
    std::array<double, 12> joint_rates{};           // rad/s
};
inline constexpr std::size_t kPositions = 19, kVelocities = 18;  // numbers in the halves of a RobotState

// Planned quantities, and likewise their rates and accelerations.
struct Planned {
    std::array<double, 2> wheels{};  // place of each pair on the wheel-centre curve [m]
    std::array<double, 4> joints{};  // front thigh, front calf, rear thigh, rear calf [rad]
    double pitch = 0.0;
    Vec2 com, trunk;
};
inline constexpr std::size_t kPlannedWidth = 11;
static_assert(sizeof(Planned) == kPlannedWidth * sizeof(double));

// One instant of the plan: what the robot is asked to do now. All numbers, in the order of a row of the plan's table.
struct Reference {
    Planned value, rate, acceleration;
    std::array<Vec2, 2> forces{};  // static force of the ground on each pair, world [N]
    double friction_share = 0.0;   // of the friction, that the static forces need
    double progress = 0.0;         // the plan's [m]
    std::array<double, 2> lean{2.0, 2.0};  // what each pair leans on in a corner, see Lean
};
inline constexpr std::size_t kReferenceWidth = 41;
static_assert(sizeof(Reference) == kReferenceWidth * sizeof(double));
static_assert(sizeof(RobotState) == (kPositions + kVelocities) * sizeof(double));

// See the descriptions of the controller's settings; equation numbers are the paper's.
struct Gains {
    double joint_stiffness = 0.0, joint_damping = 0.0;  // eq 27 [Nm/rad, Nm s/rad]
    double wheel_damping = 0.0;                         // eq 14 [Nm s/rad]
    double wheel_sync = 0.0;                            // 1/s
    double yaw_damping = 0.0;                           // eq 16, per wheel radius and track
    double heading_stiffness = 0.0;                     // 1/s
    double com_stiffness = 0.0, com_damping = 0.0;      // eq 8 [1/s^2, 1/s]
    double pitch_stiffness = 0.0, pitch_damping = 0.0;  // eq 8 [1/s^2, 1/s]
    double pitch_integral = 0.0;                        // 1/s^3
    double roll_stiffness = 0.0, roll_damping = 0.0;    // 1/s^2, 1/s
    double force_weight = 1.0, moment_weight = 1.0;     // S of eq 11
    double alpha = 1e-3, beta = 0.0;                    // eq 11
    double friction_share = 1.0;                        // of the friction, that the QP may use
    double force_limit = 0.0;                           // largest normal force of a wheel [N]
};

using Torques = std::array<double, 12>;  // thigh, calf, wheel of each leg [Nm]

// What the drives are told (the low-level commands of such robots): torque = torques + stiffness (joints - q) +
// damping (rates - dq), with their own q and dq, which are not late.
struct Command {
    Torques torques{};
    std::array<double, 12> joints{}, rates{};       // rad, rad/s
    std::array<double, 12> stiffness{}, damping{};  // Nm/rad, Nm s/rad; wheels have no stiffness
};

// The torques that a drive makes of it.
Torques drive(const Command& command, const std::array<double, 12>& joints, const std::array<double, 12>& joint_rates);

class Controller {
  public:
    // `friction` is the one the plan was made for.
    Controller(Robot robot, WheelPath path, double friction, const Gains& gains);

    // What the drives are to do. `places` of the wheels on the wheel-centre curve [m] are those nearest to where
    // the state puts the wheels, unless they are given; `feels_ground` are pairs that do not hang in the air for sure.
    Command command(const RobotState& state, const Reference& target, const std::optional<std::array<double, 4>>& places = {},
                    const std::array<bool, 2>& feels_ground = {});
    // The torques of that command at the same state, before the motors' limits.
    Torques step(const RobotState& state, const Reference& target);

    // To stand as the robot does at `state`, its wheels at `places`: still, with the forces that hold it there.
    Reference standing(const RobotState& state, const std::array<double, 4>& places) const;

    // A friction, a wheel-centre curve or a robot (the same one with other masses) other than the one it was made with.
    void believe(double friction) { friction_ = friction; }
    void believe(const Robot& robot) { robot_ = robot, mass_ = robot.mass(); }
    void believe(WheelPath path) { path_ = std::move(path); }
    // How wheels creep, see kCreep [m/s].
    void believe_creep(double creep) { creep_ = creep; }

    const Robot& robot() const { return robot_; }
    double friction() const { return friction_; }
    const WheelPath& path() const { return path_; }
    const Forces& forces() const { return forces_; }
    // Arc length of each wheel on the wheel-centre curve, NaN before the first step [m].
    const std::array<double, 4>& places() const { return places_; }
    // What the planned motion takes of the motors, as of the last command: of legs, wheels and rotors [Nm].
    const Torques& moving() const { return moving_; }
    // Pitch acceleration that the model does not know of [rad/s^2].
    double pitch_integral() const { return pitch_integral_; }
    // Whether the robot tips, as of the last command: then its plan must not go on.
    bool tips() const { return lift_off_ > 0.5; }

  private:
    Robot robot_;
    WheelPath path_;
    double friction_, mass_, creep_ = kCreep;
    Gains gains_;
    Forces forces_{};
    std::array<double, 4> places_;
    Torques moving_{};
    double pitch_integral_ = 0.0;
    double lift_off_ = 0.0;  // how far a pair has lifted off the ground, from 0 to 1
};

// What a motor that turns at `speed` can give of `torque`: speed limits only torque in the direction of motion.
double available_torque(const Motor& motor, double torque, double speed);
// The same for all joints.
Torques limit_torques(const Robot& robot, std::span<const double, 12> joint_rates, const Torques& wanted);

}  // namespace stairwright::control
