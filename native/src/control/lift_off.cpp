#include "lift_off.hpp"

#include <algorithm>
#include <cmath>

#include "stairwright/robot.hpp"

namespace stairwright::control {

namespace {

constexpr double kTouches = 0.004, kLifted = 0.010;  // m above the ground
constexpr double kNear = 0.10, kFar = 0.15;          // m that the other pair may roll for that, else it would run away

}  // namespace

double lift_off(const Measurement& m, const WheelPath& path, const std::array<double, 4>& places,
                const std::array<bool, 2>& feels_ground, const Planned& wanted) {
    const int pair = lifting_pair(m, wanted.pitch), other = 1 - pair;
    if (feels_ground[pair]) return 0.0;
    double above = 0.0;
    for (int i = 2 * pair; i < 2 * pair + 2; ++i)
        above += 0.5 * dot(m.legs[i].wheel - path.centre(places[i]), path.normal(places[i]));
    const double rolled = std::abs(0.5 * (places[2 * other] + places[2 * other + 1]) - wanted.wheels[other]);
    return std::clamp((above - kTouches) / (kLifted - kTouches), 0.0, 1.0) * std::clamp((kFar - rolled) / (kFar - kNear), 0.0, 1.0);
}

}  // namespace stairwright::control
