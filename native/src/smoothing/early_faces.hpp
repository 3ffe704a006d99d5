// Faces that may come before their place: a robot that finds its way by its own sensors meets them with its wheels only where
// trunk and legs, whose knees may lead the wheels, keep clear of them until then.
#pragma once

#include "stairwright/smoothing/objective.hpp"

namespace stairwright::smoothing {

// By node and pair: how much nearer than drawn the next face may be, which the wheels have not met yet [m]. None where the
// CoM is confined somewhere: its place is what matters there.
std::vector<std::array<double, 2>> early_faces(const RefineProblem& problem, std::span<const Node> nodes,
                                               std::span<const NodeIntervals> intervals);

// Least clearance of trunk and leg if the next face of their wheels is so much nearer; no more than is wanted [m].
double early_clearance(const SmoothingProblem& problem, std::size_t node, const Body& body, const Posture& posture);

}  // namespace stairwright::smoothing
