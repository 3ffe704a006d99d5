// Smoothing: the trunk's poses along a fixed wheel path, by Levenberg-Marquardt on hinge residuals.
//
//   minimise  sum_k |r(body_k)|^2 + rate sum |d body|^2 + curvature sum |dd body|^2
//
// where r holds, per node, how far each margin is below its target, what clearance lacks to the room wanted, joint
// torques, the pitch's distance from what it follows, and the height's from the standing height.
#pragma once

#include <span>
#include <vector>

#include "stairwright/gentlest_support.hpp"
#include "stairwright/smoothing/banded.hpp"
#include "stairwright/smoothing/node_margins.hpp"

namespace stairwright::smoothing {

// A quantity is drawn to its target with this weight; nothing draws it beyond. Less than `least` is a violation.
struct MarginTerm {
    double target = 0.0, weight = 0.0, least = 0.0;

    // The same with so much more of it.
    MarginTerm with(double more) const { return {target + more, weight, least + more}; }
};

struct Objective {
    // CoM margins: at the friction there is, at the reserved friction, and where a wheel is late [m].
    MarginTerm com, reserve, lagged;
    MarginTerm trunk, links, legs;  // clearances [m]
    MarginTerm joints;              // joint ranges [rad]
    MarginTerm reach;               // hip-wheel distances [m]
    MarginTerm surprised;           // clearances where the ground is not as drawn [m]
    MarginTerm trunk_room, links_room;  // clearances beyond what is safe [m]
    double torque_weight = 0.0;     // of each leg joint's torque over its limit
    MarginTerm torque_room;         // of each motor, as a share of its torque; where loads are known
    double torque_hard = 0.0;       // of motors that are all but overloaded
    double hard = 600.0;            // of what must not be violated
    double pitch_weight = 0.0;      // of pitch + slope_share * slope [1/rad]
    double slope_share = 0.8;       // of the slope between the wheels that the pitch follows
    double height_weight = 0.0;     // of the height above the wheels' mean [1/m]
    double height = 0.0;            // m
    Evenness evenness;
};

// Ground that wheels may meet other than drawn.
struct Surprise {
    enum Kind { none, early_face, other_tread } kind = none;
    double gap = 0.0;  // to an early face, as far as it may be early [m]
    Vec2 edge;         // above the other tread
};

// When a robot tips over.
struct TippingBounds {
    // At the lower and at the upper end of its CoM interval: the margin with which it is held also where a wheel on an edge is
    // kLeastStray from its place [m], and the height of the contact over which it would tip; infinite where both pairs carry it
    // there, so that it cannot.
    std::array<double, 2> strayed, heights;
};

struct SmoothingProblem {
    const Terrain& terrain;
    const RobotModel& robot;
    std::span<const WheelCentres> wheels;
    std::span<const WheelCentres> contacts;  // where the wheels touch
    std::span<const double> slopes;          // of the lines from the rear to the front wheels [rad]
    std::span<const NodeIntervals> intervals;
    std::span<const std::vector<WheelLoads>> loads;  // by node, see loads_along, where motors are weak; else empty
    std::span<const std::array<Surprise, 2>> surprises;  // by node, see surprises
    std::span<const TippingBounds> tipping;  // by node
    std::vector<bool> fixed;  // nodes that must not move
    Objective objective;
};

// Change `nodes` in place; returns the cost left. A node that has hardly moved since it was looked at is not looked at
// again: its residuals are extrapolated. In most iterations few nodes move. With `each` a step is damped where it makes
// things worse and not everywhere: it takes longer, but no place keeps another from coming right.
double smooth(const SmoothingProblem& problem, std::span<Body> nodes, int iterations, bool each = false);

}  // namespace stairwright::smoothing
