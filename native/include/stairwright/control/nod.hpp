// The trunk turns nose down and nose up once about the robot's mass centre, which stays where it is while the wheels
// stand still: what that tells is how high the mass centre really lies.
#pragma once

#include "stairwright/control/controller.hpp"
#include "stairwright/posture.hpp"

namespace stairwright::control {

class Nod {
  public:
    // Of a robot that stands as `planned` on `path`: as far as joint ranges and clearances let it, not at all if not far
    // enough to tell anything.
    Nod(const RobotModel& robot, const Reference& planned, const WheelPath& path);

    double duration() const;  // s; 0 for no nod

    // What is asked for `time` [s] after its beginning.
    Reference at(double time) const;

  private:
    Body body(double turn) const;
    bool possible(double turn, const WheelPath& path) const;
    Planned posed(double time) const;

    RobotModel robot_;
    Reference planned_;
    WheelCentres wheels_{};
    double swing_ = 0.0;  // rad, either way
};

}  // namespace stairwright::control
