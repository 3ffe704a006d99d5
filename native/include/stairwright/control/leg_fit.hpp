// Legs that fit the ground as it is found to be: where front and rear wheels stand higher or farther apart than drawn,
// the legs reach differently, so that the trunk keeps its planned attitude, the mass centre its place against the wheels
// that carry it, and no joint pulls against the ground.
#pragma once

#include "stairwright/control/controller.hpp"
#include "stairwright/kinematics.hpp"

namespace stairwright::control {

class LegFit {
  public:
    explicit LegFit(Robot robot);

    // `planned` with the joints that put each pair's wheels `ground` [m] off their planned place. What is asked
    // for follows a change of the ground within some tenths of a second.
    Reference fit(const Reference& planned, const std::array<Vec2, 2>& ground, double dt);

    // The robot's place is believed to be another one by this [m]: no leg is to move for it.
    void follow(Vec2 by) { off_[0] += by, off_[1] += by; }

    void reset() { off_ = {}; }

  private:
    // The trunk's `shift` [m], changed as little as makes both legs reach their wheels, which from the hips are planned at
    // `reach` [m]: by projections in turn onto what each leg allows.
    Vec2 give_way(const std::array<Vec2, 2>& reach, Vec2 shift) const;

    Robot robot_;
    std::array<ReachRange, 2> range_;  // of the legs
    std::array<Vec2, 2> off_{};
};

}  // namespace stairwright::control
