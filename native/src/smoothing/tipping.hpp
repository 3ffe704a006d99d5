// Where the robot stands on one pair of wheels, and what CoM margin it takes not to tip over when it leans.
#pragma once

#include "stairwright/smoothing/objective.hpp"

namespace stairwright::smoothing {

// Heights of the contacts over which the robot would tip at the lower and at the upper end of each node's CoM interval; infinite
// where both pairs carry it there, so that it cannot.
std::vector<std::array<double, 2>> tipping_heights(const RefineProblem& problem, std::span<const Node> nodes,
                                                   std::span<const NodeIntervals> intervals);

// CoM margin of a robot that may lean by kLean, with its CoM so high above the contact over which it would tip [m].
double lean_margin(const RobotModel& robot, double height);

}  // namespace stairwright::smoothing
