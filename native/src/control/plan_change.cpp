#include "stairwright/control/plan_change.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace stairwright::control {

namespace {

constexpr double kLeastTime = 0.3;              // s
constexpr double kTurn = 0.5, kMove = 0.1;      // rad/s and m/s, at most on the way

using Numbers = std::array<double, kPlannedWidth>;

}  // namespace

void PlanChange::begin(const Reference& last, const Reference& next) {
    const auto a = std::bit_cast<Numbers>(last.value), b = std::bit_cast<Numbers>(next.value);
    double time = kLeastTime;
    for (std::size_t j = 0; j < kPlannedWidth; ++j) {
        missing_[j] = j < 2 ? 0.0 : a[j] - b[j];  // wheels are on another curve
        time = std::max(time, 1.5 * std::abs(missing_[j]) / (j < 7 ? kTurn : kMove));
    }
    share_ = 1.0, time_ = time;
}

Reference PlanChange::step(const Reference& planned, double dt) {
    if (over()) return planned;
    share_ = std::max(0.0, share_ - dt / time_);
    const double part = share_ * share_ * (3.0 - 2.0 * share_), slope = -6.0 * share_ * (1.0 - share_) / time_;
    auto value = std::bit_cast<Numbers>(planned.value), rate = std::bit_cast<Numbers>(planned.rate);
    for (std::size_t j = 0; j < kPlannedWidth; ++j) value[j] += part * missing_[j], rate[j] += slope * missing_[j];
    Reference out = planned;
    out.value = std::bit_cast<Planned>(value), out.rate = std::bit_cast<Planned>(rate);
    return out;
}

}  // namespace stairwright::control
