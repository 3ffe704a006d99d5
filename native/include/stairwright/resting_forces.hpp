// Static contact forces of the two wheel pairs.
#pragma once

#include "stairwright/statics.hpp"

namespace stairwright {

// In robot weights: the equilibrium with the least friction need. Where two pushing contacts hold no equilibrium,
// each wheel's share of the weight by its lever, in the contact's frame.
std::array<ContactForce, 2> resting_forces(const std::array<Contact, 2>& contacts, double com_x);

}  // namespace stairwright
