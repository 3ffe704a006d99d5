// Ground that is not as drawn: faces that come before their place, and treads that lie deeper or higher below an edge. A robot
// that finds its way by its own sensors meets both with its wheels only where legs and trunk, whose knees may lead the wheels,
// keep clear of them until then.
#pragma once

#include "stairwright/smoothing/objective.hpp"

namespace stairwright::smoothing {

// What the wheels of each pair may meet at each node. Nothing where the CoM is confined, whose place is what matters there.
std::vector<std::array<Surprise, 2>> surprises(const RefineProblem& problem, std::span<const Node> nodes,
                                               std::span<const NodeIntervals> intervals);

// Clearances of thigh, calf and trunk if the front wheels are surprised and the trunk goes on as planned, then if the rear ones
// are; no more than is wanted [m]. Each for itself: of their least the derivative is that of one, which the others do not follow.
using SurpriseClearances = std::array<double, 6>;
SurpriseClearances surprise_clearances(const SmoothingProblem& problem, std::size_t node, const Body& body, const Posture& posture);

}  // namespace stairwright::smoothing
