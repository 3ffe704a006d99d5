// Finding a face that is not where the map has it: farther on, the plan waits before it while the wheels roll on; nearer,
// wheels that have met it unnoticed, and so do not follow the plan, push until it is felt.
#pragma once

#include "stairwright/control/controller.hpp"

namespace stairwright::control {

// How the pairs stand to what is ahead of them.
struct Ahead {
    std::array<bool, 2> searching{};  // a face should be here, and is not felt
    std::array<bool, 2> on_tread{};   // can roll on
    std::array<bool, 2> nearing{};    // are on a tread, near to the next face
    std::array<bool, 2> hanging{};    // hang in the air before a face
    std::array<double, 2> found{};    // how much farther on they are at this step, for a wheel met a face [m]

    bool any() const { return searching[0] || searching[1]; }
};

class FaceSearch {
  public:
    // `planned` is the plan's set point, which waits during a search; `places` of the wheels on the wheel-centre curve
    // [m]. The pairs that can roll on do so slowly, the body with them, and push the more the longer nothing moves;
    // the weight stays on the treads. `stalled`: the plan has waited for the wheels for a while.
    Reference step(const Reference& planned, const Ahead& ahead, const std::array<double, 4>& places, bool stalled, double dt);

  private:
    double waited_ = 0.0, pushed_ = 0.0;  // s
};

}  // namespace stairwright::control
