// What the controller sees: the truth with noise, some control steps late.
#pragma once

#include <span>
#include <vector>

#include "stairwright/control/controller.hpp"

namespace stairwright::rollout {

using control::RobotState;

// Added to the numbers of a RobotState, and half a small turn about each axis of the trunk.
inline constexpr std::size_t kNoiseWidth = control::kPositions + control::kVelocities + 3;

class SensorModel {
  public:
    explicit SensorModel(std::size_t delay_steps) : history_(delay_steps + 1) {}

    // The measurement of `truth`; `noise` is of kNoiseWidth numbers, or empty for none.
    const RobotState& perceive(const RobotState& truth, std::span<const double> noise);

  private:
    std::vector<RobotState> history_;  // a ring
    std::size_t seen_ = 0;
};

}  // namespace stairwright::rollout
