// From lattice poses to nodes of a path: resampling, Gaussian smoothing, Levenberg-Marquardt, dense nodes, margins.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "stairwright/smoothing/node_margins.hpp"

namespace stairwright::smoothing {

// What a user trades off; each multiplies the default weight of its term.
struct PathWeights {
    double com_margin = 1.0, clearance = 1.0, torque = 1.0, smoothness = 1.0, pitch = 1.0;
};

// How nodes are laid for the smoothing.
struct NodeSpacing {
    double softness = 1.0;   // how much they are smoothed before, and bent as little as possible by it
    double spacing = 0.009;  // of nodes, for legs of 0.4 m [m]
    double swing = 0.3;      // how much a motion of the trunk counts against the same travel of the wheels
};

struct RefineProblem {
    const Terrain& terrain;
    const WheelPath& path;
    const RobotModel& robot;
    double friction = 0.0;
    double reserve = 0.0;          // lower friction at which poses shall still hold where that is possible
    double lag = 0.0;              // how late a wheel may be at a corner [m]
    double standing_height = 0.0;  // of the trunk above the wheels [m]
    PathWeights weights;
};

struct RefinedPath {
    std::vector<Node> nodes;
    std::vector<NodeMargins> margins;
};

// Turn the poses of a search into dense, smooth nodes. `ends` replace the first and the last pose; that many nodes at
// either end stay where they are as `held` says.
RefinedPath refine(const RefineProblem& problem, const std::array<Node, 2>& ends, std::span<const Node> poses,
                   const NodeSpacing& spacing, std::size_t held);

}  // namespace stairwright::smoothing
