// Legs that fit the ground as it is found to be: where front and rear wheels stand higher or farther apart than drawn,
// the legs reach differently, so that the trunk keeps its planned attitude, goes where they can (trunk_shift.hpp), and no
// joint pulls against the ground.
#pragma once

#include "stairwright/control/controller.hpp"
#include "stairwright/posture.hpp"

namespace stairwright::control {

class LegFit {
  public:
    explicit LegFit(const Robot& robot) : robot_(robot) {}

    // `planned` on `path` with the joints that put each pair's wheels `ground` [m] off their planned place; `friction` is
    // the plan's. What is asked for follows a change of the ground within some tenths of a second.
    Reference fit(const Reference& planned, const std::array<Vec2, 2>& ground, const WheelPath& path, double friction, double dt);

    // The robot's place is believed to be another one by this [m]: no leg is to move for it.
    void follow(Vec2 by) { off_[0] += by, off_[1] += by; }

    // A pair's wheels are to be elsewhere by this at once [m].
    void follow(int pair, Vec2 by) { off_[pair] += by; }

    void reset() { off_ = {}; }

  private:
    RobotModel robot_;
    std::array<Vec2, 2> off_{};
};

}  // namespace stairwright::control
