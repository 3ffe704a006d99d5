// What the planned motion takes beside carrying weight, of all bodies: trunk, thighs, calves, spinning wheels, rotors.
#pragma once

#include "stairwright/control/controller.hpp"

namespace stairwright::control {

// Motor torques of one leg [Nm].
struct LegLoads {
    double thigh = 0.0, calf = 0.0, wheel = 0.0;
};

struct InertialLoads {
    double moment = 0.0;  // rate of the angular momentum about the mass centre [Nm]
    std::array<LegLoads, 2> legs;
};

InertialLoads inertial_loads(const Robot& robot, const Reference& target);

// What the viscous friction of a leg's motors takes at planned rates.
LegLoads friction_loads(const Leg& leg, int pair, const Planned& rate);

}  // namespace stairwright::control
