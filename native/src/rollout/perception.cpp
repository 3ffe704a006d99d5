#include "stairwright/rollout/perception.hpp"

namespace stairwright::rollout {

Perceived RobotSense::perceive(const RobotState& truth, const control::Torques& torques, double dt) {
    const std::size_t slot = seen_ % late_.size();
    late_[slot] = sensors_.read(truth, torques, dt), truths_[slot] = truth;
    ++seen_;
    const estimation::Estimate& estimate = estimator_.step(late_[oldest()], dt);
    return execution::perceived(estimate, late_[slot], static_cast<double>(late_.size() - 1) * dt);
}

}  // namespace stairwright::rollout
