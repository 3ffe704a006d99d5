#include "stairwright/player/player.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "stairwright/kinematics.hpp"

namespace stairwright::player {

namespace {

constexpr double kSoonest = 0.6;  // of a control period: states that follow sooner are passed over

const char* kJoints[] = {"FL_thigh", "FL_calf", "FL_wheel", "FR_thigh", "FR_calf", "FR_wheel",
                         "RL_thigh", "RL_calf", "RL_wheel", "RR_thigh", "RR_calf", "RR_wheel"};

template <class... Values>
std::string said(const char* format, Values... values) {
    char text[160];
    std::snprintf(text, sizeof text, format, values...);
    return text;
}

const Range& range(const Robot& robot, std::size_t joint) {
    const Leg& leg = robot.legs[joint / 6];
    return joint % 3 == 0 ? leg.thigh_range : leg.calf_range;
}

const Motor& motor(const Robot& robot, std::size_t joint) {
    const Leg& leg = robot.legs[joint / 6];
    return joint % 3 == 0 ? leg.thigh_motor : joint % 3 == 1 ? leg.calf_motor : leg.wheel_motor;
}

bool finite(const LowState& state) {
    double sum = state.time;
    for (int i = 0; i < 3; ++i) sum += std::abs(state.gyro[i]) + std::abs(state.accelerometer[i]);
    for (const MotorState& m : state.motors) sum += std::abs(m.q) + std::abs(m.dq) + std::abs(m.tau);
    return std::isfinite(sum);
}

LowCommand damping(const PlanFile& file) {
    LowCommand out;
    for (std::size_t k = 0; k < kMotors; ++k) {
        const MotorRole& role = file.motors[k];
        if (role.kind == MotorRole::Kind::none) continue;
        const bool wheel = role.kind == MotorRole::Kind::drive && role.joint % 3 == 2;
        out.motors[k].kd = wheel ? file.gains.wheel_damping : file.gains.joint_damping;
    }
    return out;
}

}  // namespace

const char* name(Phase phase) {
    constexpr const char* names[] = {"waiting", "settling", "driving", "arrived", "gave up", "refused", "damped"};
    return names[static_cast<int>(phase)];
}

Player::Player(PlanFile file, const Limits& limits)
    : file_(std::move(file)), limits_(limits), path_(file_.terrain, file_.robot.legs[0].wheel.radius),
      executor_({file_.robot, path_, file_.friction, file_.gains}, {file_.position, file_.step, file_.rows, file_.speeds, file_.lead},
                file_.grip_need, false),
      command_(damping(file_)), damped_(command_) {}

double Player::done() const {
    const double whole = file_.step * static_cast<double>(file_.rows.size() - 1);
    return (executor_.follower().position() - file_.position) / whole;
}

std::array<double, 2> Player::largest_torques() const {
    std::array<double, 2> out{};
    for (std::size_t j = 0; j < torques_.size(); ++j) out[j % 3 == 2] = std::max(out[j % 3 == 2], std::abs(torques_[j]));
    return out;
}

void Player::damp(const std::string& why) {
    if (phase_ == Phase::damped) return;
    phase_ = Phase::damped, command_ = damped_, torques_ = {};
    reason_ = reason_.empty() ? why : reason_ + "; then: " + why;
}

estimation::Readings Player::readings(const LowState& state) const {
    estimation::Readings out;
    for (std::size_t k = 0; k < kMotors; ++k) {
        const MotorRole& role = file_.motors[k];
        if (role.kind != MotorRole::Kind::drive) continue;
        const MotorState& own = state.motors[k];
        out.joints[role.joint] = role.sign * own.q + role.offset;
        out.joint_rates[role.joint] = role.sign * own.dq, out.torques[role.joint] = role.sign * own.tau;
    }
    out.angular_rate = state.gyro, out.specific_force = state.accelerometer;
    for (std::size_t i = 0; i < 2; ++i) out.angular_rate[i] *= file_.facing, out.specific_force[i] *= file_.facing;
    return out;
}

// Why the robot does not stand as the plan begins; empty where it does.
std::string Player::not_at_start(const estimation::Readings& now) const {
    const auto& planned = file_.rows.front().value.joints;
    for (std::size_t j = 0; j < 12; ++j) {
        if (std::abs(now.joint_rates[j]) > limits_.start_rate) return said("%s turns by %.2f rad/s; the robot must stand still", kJoints[j], now.joint_rates[j]);
        if (j % 3 == 2) continue;
        const double wanted = planned[2 * (j / 6) + j % 3];
        if (std::abs(now.joints[j] - wanted) > limits_.start) return said("%s stands at %.2f rad; the plan begins at %.2f", kJoints[j], now.joints[j], wanted);
    }
    double rate = 0.0, force = 0.0;
    for (int i = 0; i < 3; ++i) rate = std::max(rate, std::abs(now.angular_rate[i])), force += now.specific_force[i] * now.specific_force[i];
    if (rate > limits_.start_rate) return said("the trunk turns by %.2f rad/s; it must stand still", rate);
    force = std::sqrt(force);
    if (std::abs(force - kGravity) > limits_.start_force) return said("the accelerometer says %.2f m/s^2 at rest, not %.2f", force, kGravity);
    const double roll = std::atan2(now.specific_force[1], now.specific_force[2]);
    if (std::abs(roll) > limits_.start) return said("the trunk leans sideways by %.2f rad, %.2f at most", roll, limits_.start);
    return {};
}

// The robot stands with its front wheels where the plan has them; its joints say how high and how steep.
estimation::Start Player::start_of(const estimation::Readings& now) const {
    const auto& first = file_.rows.front().value;
    std::array<Vec2, 2> wheels;  // of the pairs, seen from the trunk point
    for (std::size_t pair = 0; pair < 2; ++pair) {
        const std::size_t left = 6 * pair, right = left + 3;
        const JointAngles q = {0.5 * (now.joints[left] + now.joints[right]), 0.5 * (now.joints[left + 1] + now.joints[right + 1])};
        wheels[pair] = forward(file_.robot.legs[pair], {}, q).wheel;
    }
    const Vec2 own = wheels[0] - wheels[1], ground = path_.centre(first.wheels[0]) - path_.centre(first.wheels[1]);
    // Angles about +y: a line that rises forward has a negative one.
    const double pitch = std::atan2(own.z, own.x) - std::atan2(ground.z, ground.x);
    return {path_.centre(first.wheels[0]) - Turn::by(pitch) * wheels[0], pitch};
}

// Why motors must only damp; empty while all is well.
std::string Player::beyond_limits(const estimation::Readings& now) const {
    for (std::size_t j = 0; j < 12; ++j) {
        if (std::abs(now.joint_rates[j]) > limits_.speed * motor(file_.robot, j).speed) return said("%s turns by %.1f rad/s, beyond its %.1f", kJoints[j], now.joint_rates[j], motor(file_.robot, j).speed);
        if (j % 3 == 2) continue;
        const Range& r = range(file_.robot, j);
        if (r.slack(now.joints[j]) < -limits_.joint) return said("%s stands at %.2f rad, outside its range by %.2f", kJoints[j], now.joints[j], -r.slack(now.joints[j]));
    }
    if (std::abs(roll_) > limits_.tilt) return said("the trunk rolled by %.2f rad, %.2f at most", roll_, limits_.tilt);
    const double off = std::remainder(pitch_ - executor_.target().value.pitch, 2 * std::numbers::pi);
    if (std::abs(off) > limits_.tilt) return said("the trunk pitched %.2f rad off the plan, %.2f at most", off, limits_.tilt);
    return {};
}

// What the rollout asks the planner for, where there is none: a map that is off is lived with, and where the ground
// does not grip the robot stays.
void Player::decide() {
    if (executor_.stop() != control::Stop::none) {
        phase_ = Phase::gave_up;
        reason_ = control::reason(executor_.stop());
        return;
    }
    if (!executor_.waits()) return;
    if (!executor_.slipped() || executor_.slipped()->found >= file_.grip_enough) return executor_.go_on();
    phase_ = Phase::gave_up;
    reason_ = said("the %s wheels slipped at a friction of %.2f; the plan needs %.2f", executor_.slipped()->front ? "front" : "rear",
                   executor_.slipped()->found, file_.grip_need);
}

void Player::tell(const control::Command& command, const estimation::Readings& now) {
    // What the motors cannot give is left out here, not there; joints are sent nowhere outside their ranges.
    control::Command limited = command;
    for (std::size_t j = 0; j < 12; ++j)
        if (j % 3 != 2) limited.joints[j] = std::clamp(command.joints[j], range(file_.robot, j).lower, range(file_.robot, j).upper);
    const control::Torques wanted = control::drive(limited, now.joints, now.joint_rates);
    torques_ = control::limit_torques(file_.robot, now.joint_rates, wanted);
    for (std::size_t k = 0; k < kMotors; ++k) {
        const MotorRole& role = file_.motors[k];
        const std::size_t j = role.joint;
        if (role.kind == MotorRole::Kind::hold)
            command_.motors[k] = {role.angle, 0.0, 0.0, file_.hold_stiffness, file_.hold_damping};
        else if (role.kind == MotorRole::Kind::drive)
            command_.motors[k] = {role.sign * (limited.joints[j] - role.offset), role.sign * limited.rates[j],
                                  role.sign * (limited.torques[j] + torques_[j] - wanted[j]), limited.stiffness[j], limited.damping[j]};
    }
}

const LowCommand& Player::step(const LowState& state) {
    if (phase_ == Phase::damped || phase_ == Phase::refused) return command_;
    if (!finite(state)) return damp("a state is not finite"), command_;
    estimation::Readings now = readings(state);
    now.torques = executor_.without_motion(now.torques);
    double dt = control::kPeriod;
    if (phase_ == Phase::waiting) {
        if (reason_ = not_at_start(now); !reason_.empty()) return phase_ = Phase::refused, command_;
        estimator_.emplace(file_.robot, path_, start_of(now), estimation::Noise{});
        begun_ = state.time;
    } else {
        dt = state.time - last_;
        if (dt >= 0.0 && dt < kSoonest * control::kPeriod) return command_;
        if (!(dt > 0.0 && dt <= limits_.gap)) return damp(said("the next state came %.3f s later, %.3f at most are allowed", dt, limits_.gap)), command_;
    }
    last_ = state.time;
    const execution::Perceived seen = execution::perceived(estimator_->step(now, dt), now);
    const auto [w, x, y, z] = seen.state.quaternion;
    pitch_ = std::atan2(2 * (x * z + w * y), 1 - 2 * (x * x + y * y));
    roll_ = std::asin(std::clamp(2 * (y * z + w * x), -1.0, 1.0));
    if (phase_ == Phase::waiting) executor_.begin_from(seen), phase_ = Phase::settling;
    const bool moving = !paused_ && state.time - begun_ >= file_.settle && phase_ != Phase::gave_up;
    const control::Command command = executor_.step(seen, moving, state.time, dt);
    if (const auto creep = executor_.take_creep()) estimator_->believe_creep(*creep);
    if (const std::string why = beyond_limits(now); !why.empty()) return damp(why), command_;
    tell(command, now);
    if (phase_ == Phase::settling && executor_.follower().position() > file_.position) phase_ = Phase::driving;
    if (phase_ == Phase::settling || phase_ == Phase::driving) decide();
    if (phase_ == Phase::driving && executor_.follower().arrived()) {
        rested_ += dt;
        if (rested_ >= file_.settle) phase_ = Phase::arrived, reason_ = "the plan is done";
    }
    return command_;
}

}  // namespace stairwright::player
