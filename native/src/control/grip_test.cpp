#include "stairwright/control/grip_test.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace stairwright::control {

namespace {

constexpr double kStands = 0.3;    // s before it begins
constexpr double kRamp = 0.6;      // 1/s, growth of the friction that is asked for
constexpr double kRelease = 2.0;   // 1/s
constexpr double kHold = 0.2;      // s at the full need
constexpr double kSmooth = 0.05;   // s
constexpr double kSlips = 0.045;   // m/s of rolling that gets nowhere; tyres creep by less

}  // namespace

std::array<double, 4> GripTest::rolled(const RobotState& state) const {
    const auto [w, x, y, z] = state.quaternion;
    const double pitch = std::atan2(2 * (x * z + w * y), 1 - 2 * (x * x + y * y));
    std::array<double, 4> out;
    for (int i = 0; i < 4; ++i) {
        const Leg& leg = robot_.legs[i / 2];
        const double thigh = pitch + state.joints[3 * i], calf = thigh + state.joints[3 * i + 1];
        const Vec2 wheel = Turn::by(pitch) * leg.hip + Turn::by(thigh) * leg.thigh.end + Turn::by(calf) * leg.calf.end;
        out[i] = leg.wheel.radius * (calf + state.joints[3 * i + 2]) - wheel.x;
    }
    return out;
}

Reference GripTest::step(const Reference& planned, const RobotState& state, const std::array<double, 4>& used, bool level, double dt) {
    if (over_) return planned;
    time_ += dt;
    if (time_ < kStands) return planned;
    const std::array<double, 4> now = rolled(state);
    if (!begun_) before_.fill(now), begun_ = true;
    for (std::size_t i = 0; i < 4; ++i) used_[i] += dt / (kSmooth + dt) * (used[i] - used_[i]);
    const std::array<double, 4> then = std::exchange(before_[steps_++ % before_.size()], now);
    if (!level) over_ = true;
    if (releasing_) {
        push_ = std::max(0.0, push_ - kRelease * dt);
        over_ = over_ || push_ == 0.0;
    } else {
        push_ = std::min(need_, push_ + kRamp * dt);
        releasing_ = time_ > kStands + need_ / kRamp + kHold;
        double speed[2];
        for (std::size_t pair = 0; pair < 2; ++pair) {
            const double left = now[2 * pair] - then[2 * pair], right = now[2 * pair + 1] - then[2 * pair + 1];
            speed[pair] = (std::abs(left) > std::abs(right) ? left : right) / (static_cast<double>(before_.size()) * dt);
        }
        // What the trunk moves by is the same for both.
        if (std::abs(speed[1] - speed[0]) > kSlips) {
            const bool front = std::abs(speed[0]) > std::abs(speed[1]);
            const std::size_t at = front ? 0 : 2;
            slipped_ = Grip{0.5 * (used_[at] + used_[at + 1]), front};
            releasing_ = true;
        }
    }
    Reference out = planned;
    const double load = std::max(planned.forces[0].z, planned.forces[1].z);
    out.forces[0].x -= push_ * load, out.forces[1].x += push_ * load;
    out.friction_share = 1.0;
    return out;
}

}  // namespace stairwright::control
