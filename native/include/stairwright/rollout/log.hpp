// The recorded series of a rollout: a sample every few control steps.
#pragma once

#include <vector>

#include "stairwright/control/controller.hpp"

namespace stairwright::rollout {

struct Sample {
    double time = 0.0;  // s
    control::RobotState state;
    control::Torques torques{};
    std::array<double, 16> contacts{};  // contact sensors: found, force x, y, z on the ground for each wheel
    double progress = 0.0;              // the plan's [m]
    std::array<double, 7> target{};     // wheels, joints and pitch that were asked for
    std::array<double, 4> places{};     // of the wheels on the wheel-centre curve [m]
};
inline constexpr std::size_t kSampleWidth = sizeof(Sample) / sizeof(double);

class Log {
  public:
    explicit Log(std::size_t every) : every_(every < 1 ? 1 : every) {}

    // Whether this control step is to be kept; to be asked once a step.
    bool due() {
        if (pass_ > 0) return --pass_, false;
        pass_ = every_ - 1;
        return true;
    }
    void add(const Sample& sample) { samples_.push_back(sample); }
    const std::vector<Sample>& samples() const { return samples_; }

  private:
    std::size_t every_, pass_ = 0;
    std::vector<Sample> samples_;
};

}  // namespace stairwright::rollout
