// When to give up: a robot that cannot go on shall stand where it is and say why, rather than fall.
#pragma once

#include <array>
#include <cstddef>

#include "stairwright/control/controller.hpp"

namespace stairwright::control {

enum class Stop {
    none = 0,
    no_progress = 1,  // the plan has waited for the wheels for too long
    tilted = 2,       // the trunk is far off its planned pitch, or leans sideways
    lost = 3,         // what the wheels find is not what the map has
    blocked = 4,      // a riser is so early that no plan leads on
};

// The same in words.
const char* reason(Stop stop);

// Whether another plan may lead on: the robot knows where it stands, and it was not for want of one that it stopped.
bool may_go_on(Stop stop);

class SafeStop {
  public:
    SafeStop();

    // One control step: the plan's path position [m] and whether it is to advance, pitch against the plan's and roll
    // [rad], whether it has lost its place. Returns why to stop; once given, an answer stays. Time in which the plan is to wait does not count.
    Stop watch(double position, bool advancing, double pitch_error, double roll, bool lost, double dt);

    // There is no way on: to stop at the next step.
    void block() { blocked_ = true; }

    Stop why() const { return why_; }
    // Since it was 5 mm farther than when this began anew, or was to wait [s].
    double waited() const { return waited_; }

  private:
    static constexpr double kEvery = 0.1;          // s
    static constexpr std::size_t kInstants = 31;   // 3 s, and now

    Stop why_ = Stop::none;
    bool blocked_ = false;
    double best_ = -1e9, mark_ = -1e9, waited_ = 0.0;
    double since_ = 0.0;  // the last of these instants [s]
    std::array<double, kInstants> reached_;  // the farthest position until each of the last instants, the oldest first
};

}  // namespace stairwright::control
