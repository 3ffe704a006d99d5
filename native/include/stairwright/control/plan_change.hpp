// From one plan to another: what was asked for last turns into what the new plan asks for within some tenths of a second,
// while that waits.
#pragma once

#include "stairwright/control/controller.hpp"

namespace stairwright::control {

class PlanChange {
  public:
    // `last` is what was asked for, `next` the new plan's first set point.
    void begin(const Reference& last, const Reference& next);

    bool over() const { return share_ <= 0.0; }
    // The new plan's set point, less what is still missing.
    Reference step(const Reference& planned, double dt);

  private:
    std::array<double, kPlannedWidth> missing_{};
    double share_ = 0.0, time_ = 1.0;  // s
};

}  // namespace stairwright::control
