// The ground's force on each wheel, from the torques of its leg.
#pragma once

#include "stairwright/estimation/readings.hpp"
#include "stairwright/robot.hpp"

namespace stairwright::estimation {

struct LegPlaces {
    Vec2 hip, knee, wheel, thigh_com, calf_com;  // world x-z [m]
};

struct WheelForce {
    Vec2 force;             // world x-z [N], but for what is along `untold`
    double traction = 0.0;  // wheel torque over radius: sum of the tangential forces [N]
    Vec2 untold;            // direction of a leg that is nearly straight or folded, whose torques tell no force along it; else 0
};

// Statics of the leg: torques balance the force at the wheel, the wheel's own torque and the weight of the links.
WheelForce wheel_force(const Leg& leg, const LegPlaces& at, double thigh_torque, double calf_torque, double wheel_torque);

}  // namespace stairwright::estimation
