#include "stairwright/control/leg_fit.hpp"

#include <algorithm>

#include "stairwright/control/trunk_shift.hpp"

namespace stairwright::control {

namespace {

constexpr double kTime = 0.15;   // s
constexpr double kMost = 0.07;   // m; more is a wrong estimate
constexpr double kLeast = 1e-5;  // m

}  // namespace

Reference LegFit::fit(const Reference& planned, const std::array<Vec2, 2>& ground, const WheelPath& path, double friction, double dt) {
    Reference out = planned;
    const double share = dt / (kTime + dt);
    for (int pair = 0; pair < 2; ++pair)
        off_[pair] += share * (Vec2{std::clamp(ground[pair].x, -kMost, kMost), std::clamp(ground[pair].z, -kMost, kMost)} - off_[pair]);
    const Vec2 shift = trunk_shift(robot_, planned, path, friction, off_);
    out.value.com += shift, out.value.trunk += shift;
    for (int pair = 0; pair < 2; ++pair) {
        const Vec2 off = off_[pair] - shift;
        if (norm(off) < kLeast) continue;
        const Leg& leg = robot_.robot.legs[pair];
        const ReachRange& range = robot_.legs[pair].reach;
        const double pitch = planned.value.pitch, thigh = planned.value.joints[2 * pair], calf = planned.value.joints[2 * pair + 1];
        Vec2 reach = Turn::by(pitch + thigh) * leg.thigh.end + Turn::by(pitch + thigh + calf) * leg.calf.end + off;
        const double length = norm(reach);
        reach = (std::clamp(length, range.least, range.most) / length) * reach;
        const JointAngles q = joint_angles(leg, pitch, knee_offset(leg, reach), reach);
        out.value.joints[2 * pair] = nearest_turn(q.thigh, thigh), out.value.joints[2 * pair + 1] = q.calf;
    }
    return out;
}

}  // namespace stairwright::control
