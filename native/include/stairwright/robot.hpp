// The robot in the x-z plane: what planner, controller and player know of it. SI units.
//
// The left and the right leg of a pair move alike. Link and wheel masses here are those of ONE leg; whoever
// works with pairs doubles them (`Leg::pair_mass`). No kernel may assume that front and rear legs are alike,
// that the trunk is one box, that its mass centre is its middle, or that a knee bends backward.
#pragma once

#include <array>
#include <vector>

#include "stairwright/polygon.hpp"

namespace stairwright {

inline constexpr double kGravity = 9.81;  // m/s^2

struct Range {
    double lower = 0.0, upper = 0.0;

    constexpr double middle() const { return 0.5 * (lower + upper); }
    // How far `q` is inside, the smaller way; negative outside.
    constexpr double slack(double q) const { return std::fmin(q - lower, upper - q); }
};

// Peak torque at standstill that falls linearly to zero at the no-load speed.
struct Motor {
    double torque = 0.0;  // Nm
    double speed = 0.0;   // rad/s
    double armature = 0.0;  // rotor inertia, as the joint feels it [kg m^2]
    double damping = 0.0;   // viscous friction in motor and joint [Nm s/rad]
};

struct Capsule {
    Vec2 a, b;
    double radius = 0.0;
};

// A thigh or a calf. Its frame sits in its upper joint; at angle 0 `end` of a straight link is (0, -length).
struct Link {
    Vec2 end;              // next joint, or the wheel's axis [m]
    Vec2 com;              // mass centre [m]
    double mass = 0.0;     // kg
    double inertia = 0.0;  // Iyy about the mass centre [kg m^2]
    std::vector<Capsule> shape;
    double length = norm(end);
    double per_square = 1.0 / (length * length);  // 1 / length^2
    // Angle of the line from joint to joint when the link's own angle is 0: 0 for a straight link.
    double bend = std::atan2(-end.x, -end.z);
};

struct Wheel {
    double radius = 0.0, mass = 0.0;
    double inertia = 0.0;  // Iyy [kg m^2]
};

struct Leg {
    Vec2 hip;  // in the trunk frame [m]
    Link thigh, calf;
    Wheel wheel;
    Range thigh_range, calf_range;  // joint angles [rad]
    Motor thigh_motor, calf_motor, wheel_motor;
    double knee = -1.0;  // +1: the calf turns forward against the thigh, -1: backward

    double pair_mass() const { return 2.0 * (thigh.mass + calf.mass + wheel.mass); }
};

struct Trunk {
    double mass = 0.0;     // with what is fixed to it and the payload [kg]
    double inertia = 0.0;  // Iyy about its mass centre [kg m^2]
    Vec2 com;              // in the trunk frame, whose origin is the midpoint of the hip axes [m]
    std::vector<Polygon> outline;
};

enum Pair { kFront = 0, kRear = 1 };

struct Robot {
    Trunk trunk;
    std::array<Leg, 2> legs;     // front, rear
    double half_track = 0.0;     // distance of the leg planes from the middle [m]
    double nominal_height = 0.0; // of the trunk point, standing [m]

    double mass() const { return trunk.mass + legs[kFront].pair_mass() + legs[kRear].pair_mass(); }
};

// The trunk's pose.
struct Body {
    double x = 0.0, z = 0.0, pitch = 0.0;
};

}  // namespace stairwright
