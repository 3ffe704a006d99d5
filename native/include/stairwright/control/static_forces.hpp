// Static forces along a plan: what each wheel pair shall rest on while nothing else is asked for.
//
// The controller's QP is pulled to them (eq 11). They are the smallest forces that hold the robot at rest with part
// of the friction kept in reserve. Small matters as much as reserve: wheels on opposite faces of a curb could always
// need less friction by pinching it harder, but pinching overloads legs and turns a small error of a normal into a
// large sideways force.
#pragma once

#include "stairwright/control/wheel_support.hpp"

namespace stairwright::control {

struct StaticForces {
    std::array<Vec2, 2> force{};         // of the ground on each pair, world [N]
    double friction_share = 0.0;         // of the friction, that they keep to
    std::array<Lean, 2> lean{Lean::both, Lean::both};  // what each pair leans on in a corner
};

// For wheel pairs at arc lengths `places`, a robot of `weight` [N] with its mass centre at `com`.
StaticForces static_forces(const WheelPath& path, double weight, double friction, std::array<double, 2> places, Vec2 com);

}  // namespace stairwright::control
