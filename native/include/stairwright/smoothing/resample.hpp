// Nodes at even steps of the path parameter.
#pragma once

#include <span>
#include <vector>

#include "stairwright/smoothing/node_margins.hpp"

namespace stairwright::smoothing {

using Column = std::vector<double>;

// Path parameter of nodes: wheel travel and `swing` times the trunk's [m].
Column path_parameter(std::span<const Node> nodes, double swing);

// `count` nodes at even steps of the path parameter `u`, linear in between.
std::vector<Node> resample(std::span<const Node> nodes, const Column& u, std::size_t count);

}  // namespace stairwright::smoothing
