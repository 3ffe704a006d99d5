#include "stairwright/control/grip_test.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "stairwright/kinematics.hpp"
#include "stairwright/statics.hpp"

namespace stairwright::control {

namespace {

constexpr double kStands = 0.3;    // s before it begins
constexpr double kRamp = 1.0;      // 1/s, growth of the friction that is asked for
constexpr double kRelease = 3.0;   // 1/s
constexpr double kHold = 0.1;      // s at the full need
constexpr double kSmoothPlace = 0.02;  // s; noise of encoders grows with the legs, that of a long one would look like slip
constexpr double kLeastPull = 0.05;  // s; less says nothing of creep
constexpr double kMostCreep = 0.03; // m/s
constexpr double kTorque = 0.85;     // of what a motor gives: the test leaves the rest to the balance
constexpr double kSlips = 0.045;   // m/s of rolling that gets nowhere; tyres creep by less
constexpr double kLongLeg = 0.6;   // m of reach, from which on noise of encoders asks for more than that
constexpr double kFeels = 0.05;    // s for which wheels that slip are pushed on: with it most of the window is of slip

double longest_leg(const Robot& robot) {
    double longest = 0.0;
    for (const Leg& leg : robot.legs) longest = std::max(longest, norm(leg.thigh.end) + norm(leg.calf.end));
    return longest;
}

double largest_load(const Reference& planned) { return std::max(planned.forces[0].z, planned.forces[1].z); }

}  // namespace

std::array<double, 4> GripTest::rolled(const RobotState& state) const {
    const auto [w, x, y, z] = state.quaternion;
    const double pitch = std::atan2(2 * (x * z + w * y), 1 - 2 * (x * x + y * y));
    std::array<double, 4> out;
    for (int i = 0; i < 4; ++i) {
        const Leg& leg = robot_.legs[i / 2];
        const Vec2 wheel = forward(leg, {0.0, 0.0, pitch}, {state.joints[3 * i], state.joints[3 * i + 1]}).wheel;
        const double turned = pitch + state.joints[3 * i] + state.joints[3 * i + 1] + state.joints[3 * i + 2];
        out[i] = leg.wheel.radius * turned - wheel.x;
    }
    return out;
}

double GripTest::most_push(const Reference& planned) const {
    const double load = largest_load(planned);
    double most = need_;
    for (std::size_t pair = 0; pair < 2; ++pair) {
        const Leg& leg = robot_.legs[pair];
        const Planned& pose = planned.value;
        const LegLevers levers = leg_levers(leg, forward(leg, {pose.trunk.x, pose.trunk.z, pose.pitch}, {pose.joints[2 * pair], pose.joints[2 * pair + 1]}));
        const auto torques = [&](double push) {
            const Vec2 force = {0.5 * (planned.forces[pair].x + (pair == 0 ? -push : push) * load), 0.5 * planned.forces[pair].z};
            return static_torques(levers, {force, leg.wheel.radius * -force.x});
        };
        const LegTorques now = torques(0.0), more = torques(1.0);
        const auto keep_within = [&](double at_rest, double pushing, const Motor& motor) {
            const double slope = std::abs(pushing - at_rest), towards = pushing > at_rest ? at_rest : -at_rest;
            most = std::min(most, std::max(0.0, kTorque * motor.torque - towards) / std::max(slope, 1e-9));
        };
        keep_within(now.thigh, more.thigh, leg.thigh_motor);
        keep_within(now.calf, more.calf, leg.calf_motor);
        keep_within(now.wheel, more.wheel, leg.wheel_motor);
    }
    return most;
}

double GripTest::used_in_slip(bool front) const {
    const std::size_t left = front ? 0 : 2;
    double sum = 0.0;
    for (const Moment& moment : window_) sum += 0.5 * (moment.used[left] + moment.used[left + 1]);
    return sum / static_cast<double>(window_.size());
}

// Rear wheels roll forward under the traction by which front wheels are pushed back; the trunk's motion is the same for both.
void GripTest::watch_creep(const Reference& planned, const Moment& now, double dt) {
    const double apart = 0.5 * (now.rolled[2] + now.rolled[3] - now.rolled[0] - now.rolled[1]);
    if (steps_ > 1) crept_ += apart - apart_;
    apart_ = apart;
    const double front = planned.forces[0].z, rear = planned.forces[1].z, quarter = (front + rear) / 4;
    const double pull = 0.25 * ((now.used[0] + now.used[1]) * front + (now.used[2] + now.used[3]) * rear);
    pulled_ += dt * pull / std::max(quarter, 1e-9);
}

Reference GripTest::step(const Reference& planned, const RobotState& state, const std::array<double, 4>& used, bool level, double dt) {
    if (over_) return planned;
    time_ += dt;
    if (time_ < kStands) return planned;
    const std::array<double, 4> reading = rolled(state);
    if (!begun_) {
        begun_ = true, rolled_ = reading, most_ = most_push(planned);
        release_at_ = kStands + most_ / kRamp + kHold;
        window_.fill({reading, {}});
    }
    for (std::size_t i = 0; i < 4; ++i) rolled_[i] += dt / (kSmoothPlace + dt) * (reading[i] - rolled_[i]);
    const Moment now{rolled_, used}, then = std::exchange(window_[steps_++ % window_.size()], now);
    watch_creep(planned, now, dt);
    if (!level) over_ = true;
    if (time_ > release_at_) {
        push_ = std::max(0.0, push_ - kRelease * dt);
        over_ = over_ || push_ == 0.0;
        if (over_ && !slipped_ && pulled_ > kLeastPull) creep_ = std::clamp(crept_ / pulled_, 0.0, kMostCreep);
    } else if (slipped_) {
        slipped_->found = used_in_slip(slipped_->front);
    } else {
        push_ = std::min(most_, push_ + kRamp * dt);
        double speed[2];
        for (std::size_t pair = 0; pair < 2; ++pair) {
            const double left = now.rolled[2 * pair] - then.rolled[2 * pair], right = now.rolled[2 * pair + 1] - then.rolled[2 * pair + 1];
            speed[pair] = (std::abs(left) > std::abs(right) ? left : right) / (static_cast<double>(window_.size()) * dt);
        }
        // What the trunk moves by is the same for both.
        if (std::abs(speed[1] - speed[0]) > kSlips * std::max(1.0, longest_leg(robot_) / kLongLeg)) {
            const bool front = std::abs(speed[0]) > std::abs(speed[1]);
            slipped_ = Grip{used_in_slip(front), front};
            release_at_ = time_ + kFeels;
        }
    }
    Reference out = planned;
    const double load = largest_load(planned);
    out.forces[0].x -= push_ * load, out.forces[1].x += push_ * load;
    out.friction_share = 1.0;
    return out;
}

}  // namespace stairwright::control
