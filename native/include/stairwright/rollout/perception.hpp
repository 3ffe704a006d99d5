// What the controller gets to know of the robot's state: the truth with noise, or what the robot's own sensors tell.
#pragma once

#include <span>
#include <variant>

#include "stairwright/execution/perceived.hpp"
#include "stairwright/rollout/robot_sensors.hpp"
#include "stairwright/rollout/sensor_model.hpp"

namespace stairwright::rollout {

using execution::Perceived;

// Readings of the robot's sensors, some control steps late, through the estimator.
class RobotSense {
  public:
    RobotSense(RobotSensors sensors, estimation::Estimator estimator, std::size_t delay_steps)
        : sensors_(std::move(sensors)), estimator_(std::move(estimator)), late_(delay_steps + 1), truths_(delay_steps + 1) {}

    Perceived perceive(const RobotState& truth, const control::Torques& torques, double dt);

    const estimation::Estimator& estimator() const { return estimator_; }
    estimation::Estimator& estimator() { return estimator_; }
    // The estimator against the truth of the moment that its readings are of.
    estimation::Estimator::Judgement judge() const { return estimator_.judge(truths_[oldest()]); }

  private:
    std::size_t oldest() const { return seen_ >= late_.size() ? seen_ % late_.size() : 0; }

    RobotSensors sensors_;
    estimation::Estimator estimator_;
    std::vector<estimation::Readings> late_;  // a ring
    std::vector<RobotState> truths_;
    std::size_t seen_ = 0;
};

using Perception = std::variant<SensorModel, RobotSense>;

}  // namespace stairwright::rollout
