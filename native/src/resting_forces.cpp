#include "stairwright/resting_forces.hpp"

#include <algorithm>
#include <cmath>

namespace stairwright {

std::array<ContactForce, 2> resting_forces(const std::array<Contact, 2>& contacts, double com_x) {
    std::array<ContactForce, 2> out;
    if (std::isfinite(least_friction(contacts, com_x, 0.0, out))) return out;
    const double front = contacts[kFront].point.x, rear = contacts[kRear].point.x;
    const double share = std::clamp((com_x - rear) / std::max(front - rear, 1e-6), 0.0, 1.0);
    for (const int k : {kFront, kRear}) {
        const double weight = k == kFront ? share : 1.0 - share;
        const Vec2 n = contacts[k].normal;
        out[k] = {-weight * n.x, weight * std::max(n.z, 0.0)};
    }
    return out;
}

}  // namespace stairwright
