// Where the trunk goes on ground that is not as drawn: with the wheels that carry the robot, but so that no leg comes
// nearer to the ground than planned, nor has to reach farther than it can.
#pragma once

#include "stairwright/control/controller.hpp"
#include "stairwright/posture.hpp"

namespace stairwright::control {

// By how much trunk and mass centre are to be off their planned place [m], pitch as planned. `off`: where the wheels of
// front and rear pair are to be against where the planned joints have them [m]: the way of their ground against `path`,
// and that to where they wait on it, if `planned.value.wheels` says so (early_face.hpp). `friction` is the plan's.
//
//   1. The mass centre keeps its place against the pairs by what they carry, so forces stay as planned.
//   2. A leg goes round edges that have come with its wheel. Where its hip, against them, is so far off its place that
//      the leg has less room than planned, the trunk follows that wheel until it has; the mass centre stays inside of what
//      the ground can hold while it does.
//   3. Where a wheel is out of its leg's reach the trunk gives way, as little as that takes.
Vec2 trunk_shift(const RobotModel& robot, const Reference& planned, const WheelPath& path, double friction, const std::array<Vec2, 2>& off);

}  // namespace stairwright::control
