#include "stairwright/control/leg_fit.hpp"

#include <algorithm>
#include <utility>

namespace stairwright::control {

namespace {

constexpr double kTime = 0.15;   // s
constexpr double kMost = 0.07;   // m; more is a wrong estimate
constexpr double kLeast = 1e-5;  // m
constexpr int kRounds = 8;       // of projections onto what each leg reaches

}  // namespace

LegFit::LegFit(Robot robot) : robot_(std::move(robot)), range_{reach_range(robot_.legs[kFront]), reach_range(robot_.legs[kRear])} {}

Vec2 LegFit::give_way(const std::array<Vec2, 2>& reach, Vec2 shift) const {
    for (int round = 0; round < kRounds; ++round)
        for (int pair = 0; pair < 2; ++pair) {
            const Vec2 need = reach[pair] + off_[pair] - shift;
            const ReachRange& range = range_[pair];
            const double length = norm(need), planned = norm(reach[pair]);
            const double beyond = length - std::clamp(length, std::min(range.least, planned), std::max(range.most, planned));
            if (beyond != 0.0) shift += (beyond / length) * need;
        }
    return shift;
}

Reference LegFit::fit(const Reference& planned, const std::array<Vec2, 2>& ground, double dt) {
    Reference out = planned;
    const double share = dt / (kTime + dt);
    for (int pair = 0; pair < 2; ++pair)
        off_[pair] += share * (Vec2{std::clamp(ground[pair].x, -kMost, kMost), std::clamp(ground[pair].z, -kMost, kMost)} - off_[pair]);
    std::array<Vec2, 2> reach;
    for (int pair = 0; pair < 2; ++pair) {
        const Leg& leg = robot_.legs[pair];
        const double upper = planned.value.pitch + planned.value.joints[2 * pair], lower = upper + planned.value.joints[2 * pair + 1];
        reach[pair] = Turn::by(upper) * leg.thigh.end + Turn::by(lower) * leg.calf.end;
    }
    // The mass centre keeps its place against the pair that carries it, as far as the legs reach.
    const double front = std::max(planned.forces[0].z, 0.0), rear = std::max(planned.forces[1].z, 0.0);
    const double on_front = front / std::max(front + rear, 1e-6);
    const Vec2 shift = give_way(reach, on_front * off_[0] + (1.0 - on_front) * off_[1]);
    out.value.com += shift, out.value.trunk += shift;
    for (int pair = 0; pair < 2; ++pair) {
        const Vec2 off = off_[pair] - shift;
        if (norm(off) < kLeast) continue;
        const Leg& leg = robot_.legs[pair];
        const ReachRange& range = range_[pair];
        const Vec2 wanted = reach[pair] + off;
        const double length = norm(wanted);
        const Vec2 to = (std::clamp(length, range.least, range.most) / length) * wanted;
        const JointAngles q = joint_angles(leg, planned.value.pitch, knee_offset(leg, to), to);
        out.value.joints[2 * pair] = q.thigh, out.value.joints[2 * pair + 1] = q.calf;
    }
    return out;
}

}  // namespace stairwright::control
