// Whether the ground grips as the plan believes, found out before it is needed: on the level ground where the robot
// starts, rear wheels push forward and front wheels hold against them, ever harder, until the plan's need is reached
// or wheels slip. Friction is known only where it is used up (R. Rajamani et al., "Algorithms for real-time estimation
// of individual wheel tire-road friction coefficients", IEEE/ASME Trans. Mechatronics 17(6), 2012).
#pragma once

#include "stairwright/control/controller.hpp"

namespace stairwright::control {

struct Grip {
    double found = 0.0;       // friction at which wheels slip [1]
    bool front = false;       // which pair did
};

class GripTest {
  public:
    // `need` is the friction to be tested for, 0 for no test. Motors that cannot give that bound the test.
    GripTest(Robot robot, double need) : robot_(std::move(robot)), need_(need), over_(!(need > 0.0)) {}

    // One control step of a robot that stands: `planned` with the wheels pushing against each other. `used` is the
    // tangential force over the normal force that each wheel feels. Ends at once where the robot does not stand on
    // level ground on all wheels.
    Reference step(const Reference& planned, const RobotState& state, const std::array<double, 4>& used, bool level, double dt);

    bool over() const { return over_; }
    // How much slower wheels move than they roll under a traction of a quarter of the weight [m/s], once the test is over
    // and if none slipped.
    const std::optional<double>& creep() const { return creep_; }
    // What was found, if wheels slipped.
    const std::optional<Grip>& slipped() const { return slipped_; }

  private:
    struct Moment {
        std::array<double, 4> rolled;  // m, smoothed, of each wheel
        std::array<double, 4> used;    // grip [1]
    };

    // How far each wheel has rolled less how far it has moved against the trunk [m].
    std::array<double, 4> rolled(const RobotState& state) const;

    // The friction that can be asked for: `need_`, or what the motors leave of it.
    double most_push(const Reference& planned) const;

    // Their mean over the window, of the pair that slips.
    double used_in_slip(bool front) const;

    void watch_creep(const Reference& planned, const Moment& now, double dt);

    Robot robot_;
    double need_;
    bool over_, begun_ = false;
    double time_ = 0.0, push_ = 0.0, most_ = 0.0;  // s; friction asked for now, and at most
    double release_at_ = 0.0;  // s
    std::array<Moment, 60> window_{};  // a ring of the last moments
    std::array<double, 4> rolled_{};  // m, smoothed
    std::size_t steps_ = 0;
    std::optional<Grip> slipped_;
    double pulled_ = 0.0, crept_ = 0.0, apart_ = 0.0;  // s and m, of rear wheels against front ones
    std::optional<double> creep_;
};

}  // namespace stairwright::control
