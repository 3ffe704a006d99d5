// Static equilibrium for the certificate, by another method than the planner's statics.
#pragma once

#include <span>

#include "stairwright/certificate/ground.hpp"

namespace stairwright::certificate {

inline constexpr double kStrongest = 8.0;  // robot weights; larger contact forces are not taken as equilibrium

// Whether forces inside the friction cones of touched faces, at most 2 * kFaces, balance the weight of a robot whose
// centre of mass is at `com_x` [m].
bool balanced(std::span<const Face> touched, double com_x, double friction);

}  // namespace stairwright::certificate
