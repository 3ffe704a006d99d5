#include "stairwright/control/safe_stop.hpp"

#include <cmath>

namespace stairwright::control {

namespace {

constexpr double kProgress = 0.005;   // m
constexpr double kPatience = 3.0;     // s without that much progress
constexpr double kMostPitch = 0.15;   // rad off the plan
constexpr double kMostRoll = 0.20;    // rad

}  // namespace

Stop SafeStop::watch(double position, bool advancing, double pitch_error, double roll, double dt) {
    if (why_ != Stop::none) return why_;
    waited_ = advancing ? waited_ + dt : 0.0;
    if (position > best_ + kProgress) best_ = position, waited_ = 0.0;
    if (waited_ > kPatience) why_ = Stop::no_progress;
    if (std::abs(pitch_error) > kMostPitch || std::abs(roll) > kMostRoll) why_ = Stop::tilted;
    return why_;
}

}  // namespace stairwright::control
