// What static torques make of a pose: a bound of the search, and a quality of its poses, for robots that are weak for
// their weight. Ways are the wider the more of their torque the motors have to spare.
#pragma once

#include <cstdint>
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

    // Quality of the pose with the trunk's centre at `trunk` and the wheels of `cell`, number `number`, whose CoM is at
    // `com_x`: 0 where the motors do not hold it.
    std::uint8_t quality(const Problem& problem, const Cell& cell, std::size_t number, const ComIntervals& com, Vec2 trunk,
                         Turn pitch, double com_x);

  private:
    WheelPath path_;
    double friction_, lag_, share_;
    std::vector<std::optional<WheelLoads>> loads_;  // by cell
};

}  // namespace stairwright::lattice
