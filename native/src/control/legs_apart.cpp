#include "stairwright/control/legs_apart.hpp"

#include <algorithm>
#include <cmath>

namespace stairwright::control {

namespace {

constexpr double kRoom = 0.03;   // m between front and rear legs; where less is planned, that is enough
constexpr double kTread = 0.9;   // cosine of the slope of the ground that wheels stay back on
constexpr double kGain = 100.0;  // 1/s
constexpr double kSpeed = 0.3;   // m/s
constexpr double kHeight = 0.005;  // m that heights are off as a rule

}  // namespace

Reference LegsApart::step(const Reference& planned) const {
    Reference out = planned;
    out.value.wheels[kRear] -= back_, out.rate.wheels[kRear] -= back_rate_;
    return out;
}

std::array<Vec2, 2> LegsApart::ground(const WheelPath& path, const Reference& planned, std::array<Vec2, 2> ground) const {
    const double at = planned.value.wheels[kRear];
    if (back_ > 0.0) ground[kRear] += path.centre(at - back_) - path.centre(at);
    return ground;
}

void LegsApart::watch(const Reference& planned, const Reference& fitted, const WheelPath& path, const std::array<Vec2, 2>& ground, double dt) {
    const Vec2 off = ground[kRear] - ground[kFront];
    const double nearer = std::hypot(std::max(0.0, off.x), std::max(0.0, std::abs(off.z) - kHeight));
    double lacking = nearer > 0.0 || back_ > 0.0 ? std::min(kRoom, apart(planned)) - apart(fitted) : 0.0;
    if (path.normal(planned.value.wheels[kRear]).z < kTread) lacking = std::min(lacking, 0.0);
    const double next = std::clamp(back_ + std::clamp(kGain * lacking, -kSpeed, kSpeed) * dt, 0.0, std::max(nearer, back_ - kSpeed * dt));
    back_rate_ = (next - back_) / dt;
    back_ = next;
}

double LegsApart::apart(const Reference& at) const {
    std::array<LegPoints, 2> legs;
    for (const int pair : {kFront, kRear})
        legs[pair] = forward(robot_.robot.legs[pair], {at.value.trunk.x, at.value.trunk.z, at.value.pitch},
                             {at.value.joints[2 * pair], at.value.joints[2 * pair + 1]});
    return legs_distance(robot_, legs, kRoom);
}

}  // namespace stairwright::control
