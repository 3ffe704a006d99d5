// Time-optimal speed along a fixed path under limits that are linear in (x, u): x the square of the path's speed, u
// its acceleration. Between two samples u is constant, so x' = x + 2 u step.
//
// Refs: H. Pham, Q.-C. Pham, "A new approach to time-optimal path parameterization based on reachability analysis",
// IEEE T-RO 2018 (TOPP-RA). Standing still is allowed everywhere here, which makes every controllable set [0, K].
#pragma once

#include <span>
#include <vector>

namespace stairwright::timing {

// a x + b u + c >= 0, with c >= 0.
struct Limit {
    double a = 0.0, b = 0.0, c = 0.0;
};

// Squares of the largest speeds (n) from rest at the first sample to rest at the last. `limits` holds n rows of as
// many limits each, `caps` (n) bounds x. Throws std::invalid_argument where sizes do not fit or a c is negative.
std::vector<double> fastest_squares(std::span<const Limit> limits, std::span<const double> caps, double step);

}  // namespace stairwright::timing
