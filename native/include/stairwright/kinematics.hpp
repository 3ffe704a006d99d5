// Closed-form kinematics of one leg and of the whole robot in the x-z plane.
//
// A link at absolute angle a points along (-sin a, -cos a): down at zero, and a positive angle (about +y)
// swings it backward. Absolute thigh angle = pitch + thigh joint; absolute calf angle adds the calf joint.
#pragma once

#include <algorithm>
#include <numbers>

#include "stairwright/robot.hpp"

namespace stairwright {

struct JointAngles {
    double thigh = 0.0, calf = 0.0;
};

// Joint axes of a leg and its wheel's centre, in the world [m].
struct LegPoints {
    Vec2 hip, knee, wheel;
};

struct ReachRange {
    double least = 0.0, most = 0.0;  // m
};

inline Vec2 hip(const Leg& leg, Vec2 trunk, Turn pitch) { return trunk + pitch * leg.hip; }
inline Vec2 hip(const Leg& leg, const Body& body, Turn pitch) { return hip(leg, Vec2{body.x, body.z}, pitch); }

// Knee relative to the hip for a wheel at `reach` from it, by the leg's knee side; the reach is clamped.
inline Vec2 knee_offset(const Leg& leg, Vec2 reach) {
    const double thigh = leg.thigh.length, calf = leg.calf.length;
    const double d = std::max(norm(reach), 1e-9);
    const Vec2 e = {reach.x / d, reach.z / d};
    const double a = std::clamp((thigh * thigh - calf * calf + d * d) / (2.0 * d), -thigh, thigh);
    const double h = std::sqrt(std::max(0.0, thigh * thigh - a * a));
    return {a * e.x - leg.knee * h * e.z, a * e.z + leg.knee * h * e.x};
}

// `angle` plus the multiple of 2 pi that brings it nearest to `middle`.
inline double nearest_turn(double angle, double middle) {
    constexpr double full = 2.0 * std::numbers::pi;
    const double off = angle - middle;
    return middle + off - full * std::floor((off + std::numbers::pi) / full);
}

// Joint angles that put the knee and the wheel where they are; the thigh's is nearest to the middle of its range.
JointAngles joint_angles(const Leg& leg, double pitch, Vec2 knee, Vec2 reach);

// What takes a link's frame to the world when `line` leads from its upper joint to its lower one: no angle is needed.
inline Turn link_turn(const Link& link, Vec2 line) {
    return {dot(link.end, line) * link.per_square, cross(line, link.end) * link.per_square};
}

// Hip, knee and wheel of a leg at joint angles `q`.
LegPoints forward(const Leg& leg, const Body& body, JointAngles q);
// Hip and knee for a given wheel centre and centre of the trunk.
LegPoints place_leg(const Leg& leg, Vec2 trunk, Turn pitch, Vec2 wheel);
inline LegPoints place_leg(const Leg& leg, const Body& body, Turn pitch, Vec2 wheel) {
    return place_leg(leg, Vec2{body.x, body.z}, pitch, wheel);
}

// Distances from hip to wheel that the calf's range allows.
ReachRange reach_range(const Leg& leg);

// Mass of a leg pair times the place of its mass centre relative to the hip [kg m], for knee and wheel
// relative to the hip.
Vec2 pair_moment(const Leg& leg, Vec2 knee, Vec2 wheel);

// Centre of mass of the whole robot [m].
Vec2 centre_of_mass(const Robot& robot, const Body& body, Turn pitch, const std::array<LegPoints, 2>& legs);

}  // namespace stairwright
