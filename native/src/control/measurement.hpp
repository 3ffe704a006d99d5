// The robot's state read in the world's x-z plane. The trunk may roll and yaw a little: points are placed in 3D.
#pragma once

#include "stairwright/control/controller.hpp"

namespace stairwright::control {

struct MeasuredLeg {
    Vec2 hip, knee, wheel, thigh_com, calf_com;  // world [m]
};

struct Measurement {
    std::array<MeasuredLeg, 4> legs;
    Vec2 com, com_velocity;
    double inertia = 0.0;               // of the whole robot about its mass centre [kg m^2]
    double pitch = 0.0, heading = 0.0;  // of the lateral axis about z: no singularity at 90 degrees of pitch
    double roll = 0.0, roll_rate = 0.0; // sine of the lateral axis' rise, the left side up positive
    double pitch_rate = 0.0, yaw_rate = 0.0;
};

Measurement measure(const Robot& robot, double mass, const RobotState& state);

}  // namespace stairwright::control
