// Limits on speed and acceleration along a path from the robot's dynamics: what contacts and motors can give.
//
// The wheel pairs' forces are four numbers, the body's equations of motion three; one number is left, by which the
// pairs may push against each other. Friction cones and motor torques are linear in it, in x (the square of the
// speed along the way) and in u (the acceleration); eliminating it (Fourier and Motzkin) leaves limits on x and u
// that hold exactly where some forces carry the motion. Cones are those of the controller, its choice of face in a
// corner included. So limits say what the controller can do, not what the terrain could.
//
// Refs: S. Caron, Q.-C. Pham, "When to make a step? Tackling the timing problem in multi-contact locomotion by
// TOPP-MPC", Humanoids 2017; K. Hauser, "Fast interpolation and time-optimization with contact", IJRR 2014.
#pragma once

#include <span>
#include <vector>

#include "stairwright/control/controller.hpp"
#include "stairwright/timing/time_optimal.hpp"

namespace stairwright::timing {

// The robot at one place of the way: values and their first and second derivatives by it.
struct PathPoint {
    control::Planned value, first, second;
};

// Shares that the motion may take.
struct Reserve {
    double friction = 1.0;  // of the friction
    double torque = 1.0;    // of the motors' torques
    double sway = 1.0;      // of the CoM margin, and less of it where
    double com = 0.0;       // less than this is left [m]
};

struct DynamicLimits {
    std::vector<Limit> balance, torque;  // by cones alone; where a motor counts
};

// At `point`. Where the robot cannot even stand within the reserve, limits are loosened until it just can.
DynamicLimits dynamic_limits(const Robot& robot, const WheelPath& path, double friction, const PathPoint& point,
                             const Reserve& reserve);

}  // namespace stairwright::timing
