// A face that comes before the map has it: the wheels that have met it stay there until the plan is where they are. Those
// that are over an edge down which came early are called back.
//
// What is found moves the robot on the map, and nothing of it on the ground. Without this the wheels would be ahead of
// the plan all of a sudden, and be called back, while those of the other pair are in the middle of a riser.
#pragma once

#include "stairwright/control/controller.hpp"

namespace stairwright::control {

class EarlyFace {
  public:
    // `planned` with wheels that wait where they are ahead of it. `found`: by how much each pair's place on the map became
    // another one at this step since a wheel met a face, `places` those of the wheels now [m].
    Reference step(const Reference& planned, const std::array<double, 2>& found, const std::array<double, 4>& places, double dt);

    // An edge that leads down and comes early, with the front wheels on it: the plan waits while they are called back
    // gently. At once would be by pulling the trunk over them. Where they are too far round a low one they roll on.
    void watch_edge(const Reference& planned, const WheelPath& path, const std::array<double, 4>& places, double dt);
    bool waits() const { return comes_back_; }

    // How far the wheels of each pair are to be ahead of the plan [m].
    const std::array<double, 2>& ahead() const { return ahead_; }
    // `ground` as `LegFit` takes it, with the way on `path` from where each pair's wheels are planned to where they wait [m].
    std::array<Vec2, 2> ground(const WheelPath& path, const Reference& planned, std::array<Vec2, 2> ground) const;

    void reset() { ahead_ = {}, comes_back_ = false; }

  private:
    std::array<double, 2> ahead_{};
    bool comes_back_ = false;
};

}  // namespace stairwright::control
