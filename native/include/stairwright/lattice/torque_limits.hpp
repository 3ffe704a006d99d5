// Poses whose static torques the motors do not hold: a bound of the search for robots that are weak for their weight.
#pragma once

#include <optional>
#include <vector>

#include "stairwright/gentlest_support.hpp"
#include "stairwright/lattice/problem.hpp"

namespace stairwright::lattice {

class TorqueLimits {
  public:
    // Torques of at most `share` of the motors' peak, at the friction that the path is planned for, also where
    // a wheel is `lag` [m] late at a corner.
    TorqueLimits(const WheelPath& path, double friction, double lag, double share, std::size_t cells)
        : path_(path), friction_(friction), lag_(lag), share_(share), loads_(cells) {}

    // Whether the motors hold the trunk at `body` with the wheels of `cell`, number `number`, whose CoM is at `com_x`.
    bool hold(const Problem& problem, const Cell& cell, std::size_t number, const ComIntervals& com, const Body& body,
              Turn pitch, double com_x);

  private:
    WheelPath path_;
    double friction_, lag_, share_;
    std::vector<std::optional<WheelLoads>> loads_;  // by cell
};

}  // namespace stairwright::lattice
