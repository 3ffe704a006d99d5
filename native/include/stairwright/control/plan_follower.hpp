// How fast the plan advances: its own timing, limits along it, and a largest lead over the robot.
//
// The plan runs on its own phase, because a purely measured progress stalls (the robot waits for the plan and the
// plan for the robot). It slows down when it is ahead of the wheels, stops when it is too far ahead and retreats with
// a robot that slides back. It hurries after a robot that runs ahead only a little, because it must not jump.
#pragma once

#include <vector>

#include "stairwright/control/controller.hpp"

namespace stairwright::control {

// Whether a plan goes on, comes to rest as gently as its centre of mass is to be slowed down, or stops here and now.
enum class Motion { go, halt, stop };

class PlanFollower {
  public:
    // Set points on an even grid of path positions, the first at `start`, with rates per metre of path and
    // accelerations per its square, the allowed `speeds` there [m/s], and how far the plan may be ahead of the wheels
    // [m].
    // Throws std::invalid_argument unless there are two rows at least and as many speeds.
    PlanFollower(double start, double step, std::vector<Reference> rows, std::vector<double> speeds, double maximum_lead);

    // One control step on; `places` of the wheels are NaN before the first measurement. Of wheels that hang over a
    // corner the plan is ahead by much less.
    const Reference& advance(const std::array<double, 4>& places, Motion motion, double dt, bool hanging = false);

    const Reference& first() const { return rows_.front(); }
    double position() const { return position_; }  // along the path [m]
    bool arrived() const { return position_ >= start_ + step_ * static_cast<double>(rows_.size() - 1) - 1e-9; }
    double rate() const { return rate_; }  // m/s
    double lag() const { return lag_; }    // of the wheels behind the plan [m]
    const Reference& target() const { return target_; }

  private:
    struct Spot {
        std::size_t row;
        double share;
    };
    Spot spot(double position) const;
    double wheel_lag(Spot at, const std::array<double, 4>& places) const;
    double planned_acceleration(Spot at) const;
    double gentle_braking(Spot at) const;
    void set_target(Spot at);

    double start_, step_, maximum_lead_;
    std::vector<Reference> rows_;
    std::vector<double> speeds_;
    double position_, rate_ = 0.0, lag_ = 0.0;
    Reference target_{};
};

}  // namespace stairwright::control
