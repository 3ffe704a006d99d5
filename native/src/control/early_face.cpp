#include "stairwright/control/early_face.hpp"

#include <algorithm>

namespace stairwright::control {

Reference EarlyFace::step(const Reference& planned, const std::array<double, 2>& found, const std::array<double, 4>& places, double dt) {
    Reference out = planned;
    for (std::size_t pair = 0; pair < 2; ++pair) {
        const double rate = std::max(0.0, planned.rate.wheels[pair]);
        // Not beyond the face, where the plan has lagged behind.
        const double most = std::max(places[2 * pair], places[2 * pair + 1]) - planned.value.wheels[pair];
        ahead_[pair] = std::max(0.0, ahead_[pair] - rate * dt);
        if (found[pair] > 0.0) ahead_[pair] = std::clamp(most, ahead_[pair], ahead_[pair] + found[pair]);
        if (ahead_[pair] == 0.0) continue;
        out.value.wheels[pair] += ahead_[pair];
        out.rate.wheels[pair] -= rate;
    }
    return out;
}

std::array<Vec2, 2> EarlyFace::ground(const WheelPath& path, const Reference& planned, std::array<Vec2, 2> ground) const {
    for (std::size_t pair = 0; pair < 2; ++pair) {
        const double at = planned.value.wheels[pair];
        if (ahead_[pair] > 0.0) ground[pair] += path.centre(at + ahead_[pair]) - path.centre(at);
    }
    return ground;
}

}  // namespace stairwright::control
