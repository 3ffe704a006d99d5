// What CoM margin a robot keeps at each pose that no lean from it and no wheel a little beside its place makes fall.
#pragma once

#include "stairwright/smoothing/objective.hpp"

namespace stairwright::smoothing {

// For the smoothing, by node.
std::vector<TippingBounds> tipping_bounds(const RefineProblem& problem, std::span<const Node> nodes,
                                          std::span<const NodeIntervals> intervals);

// Least margins at the lower and at the upper end of a node's CoM interval [m].
std::array<double, 2> least_com_margins(const RobotModel& robot, const TippingBounds& bounds, double com_z);

}  // namespace stairwright::smoothing
