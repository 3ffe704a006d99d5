#include "lift_off.hpp"

#include <algorithm>

#include "stairwright/robot.hpp"

namespace stairwright::control {

namespace {

constexpr double kTouches = 0.004, kLifted = 0.010;  // m above the ground

}  // namespace

double lift_off(const Measurement& m, const WheelPath& path, const std::array<double, 4>& places,
                const std::array<bool, 2>& feels_ground, double pitch) {
    // Nose up, or down: the pair at the other end lifts nothing off.
    const int pair = m.pitch < pitch ? kFront : kRear;
    if (feels_ground[pair]) return 0.0;
    double above = 0.0;
    for (int i = 2 * pair; i < 2 * pair + 2; ++i)
        above += 0.5 * dot(m.legs[i].wheel - path.centre(places[i]), path.normal(places[i]));
    return std::clamp((above - kTouches) / (kLifted - kTouches), 0.0, 1.0);
}

}  // namespace stairwright::control
