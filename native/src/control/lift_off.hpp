// Whether the robot tips: a pair of wheels hangs above the ground that is to carry it, and the trunk leans that way.
//
// On its other pair alone the robot is an inverted pendulum on wheels. What rights it is a force along the ground towards
// the side that it falls to, so its place must give way, that pair must roll freely, and the plan must not go on meanwhile.
#pragma once

#include "measurement.hpp"

namespace stairwright::control {

// The pair that lifts off if any does: the front one where the nose is higher than it is to be.
inline int lifting_pair(const Measurement& m, double pitch) { return m.pitch < pitch ? kFront : kRear; }

// How far that pair has lifted off: from 0 (not at all) to 1. `places` of the wheels on the wheel-centre
// curve [m]. Of pairs that feel the ground it is the map that is wrong.
double lift_off(const Measurement& m, const WheelPath& path, const std::array<double, 4>& places,
                const std::array<bool, 2>& feels_ground, const Planned& wanted);

}  // namespace stairwright::control
