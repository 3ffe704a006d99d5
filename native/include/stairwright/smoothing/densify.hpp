// Nodes dense enough that joints may be interpolated linearly between them.
#pragma once

#include <span>
#include <vector>

#include "stairwright/gentlest_support.hpp"
#include "stairwright/smoothing/node_margins.hpp"

namespace stairwright::smoothing {

// What the smoothing takes from nodes, in their order.
struct NodeGeometry {
    std::vector<WheelCentres> wheels, contacts;
    std::vector<double> slopes;  // of the lines from the rear to the front wheels [rad]
    std::vector<Body> bodies;
};

NodeGeometry geometry_along(const WheelPath& path, std::span<const Node> nodes);

// Where contacts change between nodes, as fractional node numbers.
std::vector<double> contact_changes(const WheelPath& path, std::span<const Node> nodes);

// Insert nodes at `changes`, then halve intervals until the wheels follow their curve under linear motion.
std::vector<Node> densify(const WheelPath& path, const RobotModel& robot, std::span<const Node> nodes,
                          std::span<const double> changes);

// Intervals of nodes, each also good to the next ones: where contacts change between two nodes both keep what holds
// there, because the CoM moves linearly.
std::vector<NodeIntervals> intervals_along(const WheelPath& path, std::span<const Node> nodes,
                                           std::span<const double> changes, double friction, double reserve, double lag);

// What the wheels carry at nodes, by the CoM's x; of each node also what they carry where contacts change beside it. A
// robot weighs `weight` [N].
std::vector<std::vector<WheelLoads>> loads_along(const WheelPath& path, std::span<const Node> nodes, std::span<const double> changes,
                                                 double friction, double lag, double weight);

}  // namespace stairwright::smoothing
