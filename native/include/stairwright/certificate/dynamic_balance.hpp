// What moving takes at one pose: contact forces and the share of what the motors can give, by a linear program.
#pragma once

#include <array>

#include "stairwright/certificate/ground.hpp"

namespace stairwright::certificate {

inline constexpr std::size_t kMotors = 6;                  // thigh, calf and wheel of a front and of a rear leg
inline constexpr std::size_t kConeEdges = 2 * 2 * kFaces;  // two edges of the cone of every contact of two wheels
using Wrench = std::array<double, 3>;                      // force x, force z, moment about the centre of mass, +y
using Torques = std::array<double, kMotors>;               // [Nm]

// A unit force along one edge of a contact's friction cone: its wrench and what it takes of the motors, the contact of
// a pair shared by its legs.
struct ConeEdge {
    Wrench wrench;
    Torques torques;
};

// A pose in motion. Forces are in units of `ConeEdge`.
struct Motion {
    std::array<ConeEdge, kConeEdges> edges;  // zero where there is no contact
    Wrench load;                             // that moving takes
    Torques torques;                         // that moving takes without contact
    Torques lowest, highest;                 // that the motors can give at their speed: below and above zero
};

struct DynamicBalance {
    double share = 0.0;   // of what the motors can give, the least
    double missed = 0.0;  // of the wrench, largest component; 0 in balance
};

// Missing a wrench costs `kMissed` times as much as the motors' share, so it is missed only where no force balances it.
inline constexpr double kMissed = 100.0;
// All forces together: those that press a wheel between an edge and a riser cancel, and its motors hardly feel them.
inline constexpr double kMostForce = 10.0;

DynamicBalance least_share(const Motion& motion);

}  // namespace stairwright::certificate
