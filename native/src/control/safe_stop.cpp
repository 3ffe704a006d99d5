#include "stairwright/control/safe_stop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stairwright::control {

namespace {

constexpr double kProgress = 0.005;   // m
constexpr double kMostPitch = 0.20;   // rad off the plan: wheels 0.36 m apart that miss a face by 6 cm make 0.17
constexpr double kMostRoll = 0.20;    // rad

}  // namespace

const char* reason(Stop stop) {
    switch (stop) {
        case Stop::no_progress: return "the wheels did not follow the plan for 3 s";
        case Stop::tilted: return "the trunk leant too far from the plan";
        case Stop::lost: return "the ground under the wheels is over 12 cm from where the map has it: it has lost its place";
        case Stop::blocked: return "a riser stopped the front wheels before it was expected, and there is no plan from there";
        default: return "";
    }
}

bool may_go_on(Stop stop) { return stop == Stop::no_progress || stop == Stop::tilted; }

SafeStop::SafeStop() { reached_.fill(-std::numeric_limits<double>::infinity()); }

Stop SafeStop::watch(double position, bool advancing, double pitch_error, double roll, bool lost, double dt) {
    if (why_ != Stop::none) return why_;
    waited_ = advancing ? waited_ + dt : 0.0;
    if (position > mark_ + kProgress) mark_ = position, waited_ = 0.0;
    best_ = std::max(best_, position);
    if (advancing) since_ += dt;
    if (since_ >= kEvery) {
        std::shift_left(reached_.begin(), reached_.end(), 1);
        reached_.back() = best_, since_ -= kEvery;
    }
    if (best_ - reached_.front() < kProgress) why_ = Stop::no_progress;
    if (std::abs(pitch_error) > kMostPitch || std::abs(roll) > kMostRoll) why_ = Stop::tilted;
    if (lost) why_ = Stop::lost;
    if (blocked_) why_ = Stop::blocked;
    return why_;
}

}  // namespace stairwright::control
