// Poses whose static torques the motors do not hold: a bound of the search for robots that are weak for their weight.
#pragma once

#include <optional>
#include <vector>

#include "stairwright/gentlest_support.hpp"
#include "stairwright/lattice/problem.hpp"

namespace stairwright::lattice {

class TorqueLimits {
  public:
    // Torques of at most `share` of the motors' peak, at the friction that the path is planned for.
    TorqueLimits(const WheelPath& path, double friction, double share, std::size_t cells)
        : path_(path), friction_(friction), share_(share), loads_(cells) {}

    // Whether the motors hold the trunk at `body` with the wheels of `cell`, number `number`, whose CoM is at `com_x`.
    bool hold(const Problem& problem, const Cell& cell, std::size_t number, const ComIntervals& com, const Body& body,
              Turn pitch, double com_x);

  private:
    WheelPath path_;
    double friction_, share_;
    std::vector<std::optional<WheelLoads>> loads_;  // by cell
};

}  // namespace stairwright::lattice
