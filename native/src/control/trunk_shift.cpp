#include "stairwright/control/trunk_shift.hpp"

#include <algorithm>

#include "stairwright/wheel_contacts.hpp"

namespace stairwright::control {

namespace {

constexpr double kRoom = 0.016;    // m between legs and ground; more is as good
constexpr double kBalance = 0.06;  // m between the mass centre and where the robot tips, for legs of 0.4 m; more may be given up
constexpr double kLeast = 1e-3;    // m off its place that a hip can be without a look at the ground
constexpr int kHalvings = 6;       // of the way between two shifts
constexpr int kRounds = 8;         // of projections onto what each leg reaches

LegPoints planned_leg(const Leg& leg, const Planned& at, int pair) {
    return forward(leg, {at.trunk.x, at.trunk.z, at.pitch}, {at.joints[2 * pair], at.joints[2 * pair + 1]});
}

Vec2 by_load(const Reference& planned, const std::array<Vec2, 2>& off) {
    const double front = std::max(planned.forces[kFront].z, 0.0), rear = std::max(planned.forces[kRear].z, 0.0);
    const double share = front / std::max(front + rear, 1e-6);
    return share * off[kFront] + (1.0 - share) * off[kRear];
}

// `shift`, or what is next to it on the way to the pair's own `off`, where its leg has room.
Vec2 with_room(const Leg& leg, const LegPoints& planned, const Terrain& terrain, Vec2 off, Vec2 shift) {
    const Vec2 away = shift - off;  // of the hip, against the ground of its wheel
    if (norm(away) < kLeast) return shift;
    const auto room = [&](double share) {
        const Vec2 hip = planned.hip + share * away;
        return leg_clearance(terrain, leg, {hip, hip + knee_offset(leg, planned.wheel - hip), planned.wheel}, kRoom);
    };
    const double wanted = room(0.0);
    if (room(1.0) >= wanted) return shift;
    double enough = 0.0, much = 1.0;
    for (int k = 0; k < kHalvings; ++k) {
        const double middle = 0.5 * (enough + much);
        (room(middle) >= wanted ? enough : much) = middle;
    }
    return off + enough * away;
}

// As far from `from` to `to` as the ground, off its place by `off`, holds the mass centre well.
Vec2 balanced(const RobotModel& robot, const Reference& planned, const WheelPath& path, double friction, const std::array<Vec2, 2>& off,
              Vec2 from, Vec2 to) {
    if (from.x == to.x) return to;
    const auto [front, rear] = planned.value.wheels;
    const Interval held = pair_interval(path, {front, rear}, friction, kGentleRays, off);
    const double com = planned.value.com.x, keep = kBalance * robot.scale();
    const double lower = std::min(held.lower + keep - com, from.x), upper = std::max(held.upper - keep - com, from.x);
    const double share = (std::clamp(to.x, lower, upper) - from.x) / (to.x - from.x);
    return from + share * (to - from);
}

Vec2 within_reach(const RobotModel& robot, const std::array<LegPoints, 2>& planned, const std::array<Vec2, 2>& off, Vec2 shift) {
    for (int round = 0; round < kRounds; ++round)
        for (const int pair : {kFront, kRear}) {
            const Vec2 reach = planned[pair].wheel - planned[pair].hip, needed = reach + off[pair] - shift;
            const ReachRange& range = robot.legs[pair].reach;
            const double length = norm(needed), as_planned = norm(reach);
            const double beyond = length - std::clamp(length, std::min(range.least, as_planned), std::max(range.most, as_planned));
            if (beyond != 0.0) shift += (beyond / length) * needed;
        }
    return shift;
}

}  // namespace

Vec2 trunk_shift(const RobotModel& robot, const Reference& planned, const WheelPath& path, double friction, const std::array<Vec2, 2>& off) {
    const Vec2 carried = by_load(planned, off);
    Vec2 shift = carried;
    std::array<LegPoints, 2> legs;
    std::array<Vec2, 2> ground;
    for (const int pair : {kFront, kRear}) {
        legs[pair] = planned_leg(robot.legs[pair].leg, planned.value, pair);
        const Vec2 ahead = path.centre(planned.value.wheels[pair]) - legs[pair].wheel;
        ground[pair] = off[pair] - ahead;
        const LegPoints there = {legs[pair].hip + ahead, legs[pair].knee + ahead, legs[pair].wheel + ahead};
        shift = with_room(robot.legs[pair].leg, there, path.terrain(), off[pair], shift);
    }
    shift = balanced(robot, planned, path, friction, ground, carried, shift);
    return within_reach(robot, legs, off, shift);
}

}  // namespace stairwright::control
