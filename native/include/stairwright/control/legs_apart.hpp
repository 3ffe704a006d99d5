// Rear wheels that keep off the front legs: where faces lie nearer to each other than drawn, front wheels wait before one
// while the plan brings the rear ones closer than there is room for. These stay back until the front legs have gone on.
#pragma once

#include "stairwright/control/controller.hpp"
#include "stairwright/posture.hpp"

namespace stairwright::control {

class LegsApart {
  public:
    explicit LegsApart(const Robot& robot) : robot_(robot) {}

    // `planned` with rear wheels that stay back.
    Reference step(const Reference& planned) const;
    // `ground` as `LegFit` takes it, with the way on `path` from where the rear wheels are planned to where they stay [m].
    std::array<Vec2, 2> ground(const WheelPath& path, const Reference& planned, std::array<Vec2, 2> ground) const;

    // Whether legs are too near to each other in what is asked for, `fitted`, and not in what is `planned` on `path`.
    // `ground` is that under the wheels: they never stay back farther than it is nearer to each other than drawn, nor
    // on anything but a tread.
    void watch(const Reference& planned, const Reference& fitted, const WheelPath& path, const std::array<Vec2, 2>& ground, double dt);

    // How far the rear wheels are to be behind the plan [m].
    double back() const { return back_; }

  private:
    double apart(const Reference& at) const;

    RobotModel robot_;
    double back_ = 0.0, back_rate_ = 0.0;  // m, m/s
};

}  // namespace stairwright::control
