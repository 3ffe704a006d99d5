// What static torques make of a pose: a bound of the search, and a quality of its poses, for robots that are weak for
// their weight. Ways are the wider the more of their torque the motors have to spare.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "stairwright/gentlest_support.hpp"
#include "stairwright/lattice/leg_clearance.hpp"
#include "stairwright/lattice/problem.hpp"

namespace stairwright::lattice {

class TorqueLimits {
  public:
    // Torques of at most `share` of the motors' peak, at the friction that the path is planned for, also where
    // a wheel is `lag` [m] late at a corner.
    TorqueLimits(const WheelPath& path, double friction, double lag, double share, std::size_t cells)
        : path_(path), friction_(friction), lag_(lag), share_(share), loads_(cells) {}

    // Sets quality[k] of poses with the wheels of `cell`, number `number`, whose CoM is at com_x[k]: 0 where the motors
    // do not hold them.
    void rate(const Problem& problem, const Cell& cell, std::size_t number, const ComIntervals& com, const TrunkPoses& poses,
              const float* com_x, std::uint8_t* quality);

  private:
    WheelPath path_;
    double friction_, lag_, share_;
    std::vector<std::optional<WheelLoads>> loads_;  // by cell
    std::vector<double> taken_, levers_;            // of the poses at hand
};

}  // namespace stairwright::lattice
