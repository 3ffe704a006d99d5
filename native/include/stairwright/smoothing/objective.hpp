// What a path is smoothed for: the cost terms that users weigh, each with its quantity, and what must not be violated.
#pragma once

#include "stairwright/smoothing/smoothing.hpp"

namespace stairwright::smoothing {

// What a user trades off; each multiplies the default weight of its term.
struct PathWeights {
    double com_margin = 1.0, clearance = 1.0, torque = 1.0, smoothness = 1.0, pitch = 1.0;
};

// What a path keeps beyond its bounds, for ground that is not as drawn.
struct ExtraMargins {
    double trunk = 0.0, links = 0.0;  // clearances [m]
    double legs = 0.0;                // between front and rear leg [m]
    double reach = 0.0;               // of the hip-wheel distances [m]
    double joints = 0.0;              // of the joint ranges [rad]
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
    bool torques = false;          // whether motors are weak: their limits shape the path
    ExtraMargins extra;
};

// How nodes are laid for the smoothing.
struct NodeSpacing {
    double softness = 1.0;   // how much they are smoothed before, and bent as little as possible by it
    double spacing = 0.009;  // of nodes, for legs of 0.4 m [m]
    double swing = 0.3;      // how much a motion of the trunk counts against the same travel of the wheels
    bool thorough = false;   // whether nodes settle each by itself, and wheels stop in every corner: for what has not come right
};

// `share` is the nodes' spacing over kUsualSpacing: weights of a sum over nodes scale with it.
Objective objective(const RefineProblem& problem, const NodeSpacing& spacing, double share);

inline constexpr double kUsualSpacing = 0.015;  // m; of nodes that the weights were chosen with

// The quantity that each weight makes small: root mean squares along the path.
struct CostTerms {
    double com_margin = 0.0;  // what the CoM lacks to the room wanted where a wheel may be late [m]
    double clearance = 0.0;   // what trunk and links lack to the room wanted [m]
    double torque = 0.0;      // static torque of the leg joints over their limits
    double smoothness = 0.0;  // motion of the trunk per travel of the wheels, bends included
    double pitch = 0.0;       // pitch off the slope that it follows [rad]
};

struct PathCost {
    double total = 0.0;  // what the smoothing makes small, weights included
    CostTerms terms;
};

PathCost path_cost(const RefineProblem& problem, std::span<const Node> nodes);

}  // namespace stairwright::smoothing
