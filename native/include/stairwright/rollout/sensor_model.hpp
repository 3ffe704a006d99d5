// What the controller sees: the truth with noise, some control steps late.
#pragma once

#include <span>
#include <vector>

#include "stairwright/control/controller.hpp"

namespace stairwright::rollout {

using control::RobotState;

// Added to the numbers of a RobotState, and half a small turn about each axis of the trunk.
inline constexpr std::size_t kNoiseWidth = control::kPositions + control::kVelocities + 3;

// How what is known of the whole state is wrong all the time.
struct Misbelief {
    double start = 0.0;   // x of the trunk point at the start, as it is believed [m]
    double offset = 0.0;  // what is believed to be farther along than it is [m]
    double scale = 0.0;   // share of the way since the start that is believed to be longer
    double pitch = 0.0;   // added to the pitch [rad]
};

class SensorModel {
  public:
    explicit SensorModel(std::size_t delay_steps, const Misbelief& misbelief = {})
        : history_(delay_steps + 1), misbelief_(misbelief) {}

    // The measurement of `truth`; `noise` is of kNoiseWidth numbers, or empty for none.
    const RobotState& perceive(const RobotState& truth, std::span<const double> noise);

  private:
    std::vector<RobotState> history_;  // a ring
    Misbelief misbelief_;
    std::size_t seen_ = 0;
};

}  // namespace stairwright::rollout
