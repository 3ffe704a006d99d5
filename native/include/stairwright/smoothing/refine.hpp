// From lattice poses to nodes of a path: resampling, Gaussian smoothing, Levenberg-Marquardt, dense nodes, margins.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "stairwright/smoothing/objective.hpp"

namespace stairwright::smoothing {

struct RefinedPath {
    std::vector<Node> nodes;
    std::vector<NodeMargins> margins;
};

// Turn the poses of a search into dense, smooth nodes. `ends` replace the first and the last pose; that many nodes at
// either end stay where they are as `held` says. Round places `as_drawn` no room is kept for ground that is not.
RefinedPath refine(const RefineProblem& problem, const std::array<Node, 2>& ends, std::span<const Node> poses,
                   const NodeSpacing& spacing, std::size_t held, std::span<const WheelPlaces> as_drawn);

}  // namespace stairwright::smoothing
