// Banded symmetric systems, and what uneven motion along the nodes of a path costs.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "stairwright/robot.hpp"

namespace stairwright::smoothing {

// Second differences tie an unknown to those of two nodes further; each node has three unknowns.
inline constexpr int kBand = 6;

// H[i, i + k] of a symmetric H in row i, column k; kBand rows more than there are unknowns.
using BandMatrix = std::vector<std::array<double, kBand + 1>>;

// Solve H x = b in place: `b`, which has kBand more entries than there are unknowns, becomes x. H is spent.
void solve_banded(BandMatrix& h, std::span<double> b);

// Squared first and second differences of the trunk's x, z, pitch along the nodes.
struct Evenness {
    double rate = 0.0;       // weight of first differences
    double curvature = 0.0;  // weight of second differences
    double lever = 0.0;      // length that one radian counts as [m]

    std::array<double, 3> units() const { return {1.0, 1.0, lever}; }
    // Cost; `gradient` (3 a node) becomes half its gradient.
    double cost(std::span<const Body> nodes, std::span<double> gradient) const;
    // Half the second derivatives of the cost of `n` nodes.
    BandMatrix hessian(std::size_t n) const;
};

}  // namespace stairwright::smoothing
