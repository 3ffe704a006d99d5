// Faces that may come before their place: a robot that finds its way by its own sensors meets them with its wheels only where
// trunk and legs, whose knees may lead the wheels, keep clear of them until then.
#pragma once

#include "stairwright/smoothing/objective.hpp"

namespace stairwright::smoothing {

// By node and pair: how far wheels are from the next face, as far as it may be nearer than drawn [m]; negative where they have
// felt it, there is none, or the CoM is confined, whose place is what matters there.
std::vector<std::array<double, 2>> early_faces(const RefineProblem& problem, std::span<const Node> nodes,
                                               std::span<const NodeIntervals> intervals);

// Clearances of thigh, calf and trunk if the next face holds the front wheels as early as it may come and the trunk goes on as
// planned, then of the rear ones; no more than is wanted [m]. Each for itself: of their least the derivative is that of one,
// which the others do not follow.
using EarlyClearances = std::array<double, 6>;
EarlyClearances early_clearances(const SmoothingProblem& problem, std::size_t node, const Body& body, const Posture& posture);

}  // namespace stairwright::smoothing
