#include "stairwright/control/early_face.hpp"

#include <algorithm>

namespace stairwright::control {

namespace {

constexpr double kRound = 0.01;  // m round an edge before its time that a wheel is
constexpr double kSteep = 0.75;  // rad round it from which on a wheel does not stay where it is
constexpr double kLow = 2.5;     // wheel radii that an edge may be high for its wheels to roll on
constexpr double kBack = 0.05;   // m/s that wheels are called back with
constexpr double kLead = 0.03;   // m ahead of the wheels, which makes them roll on

}  // namespace

void EarlyFace::watch_edge(const Reference& planned, const WheelPath& path, const std::array<double, 4>& places, double dt) {
    const double at = planned.value.wheels[kFront], place = std::min(places[0], places[1]);
    const auto edge = path.next_drop(at);
    double& ahead = ahead_[kFront];
    const bool is_round = edge && place >= std::max(*edge, at) + kRound;
    if (is_round && place > *edge + kSteep * path.radius()) {
        const std::size_t corner = path.corner_from(*edge);
        const double foot = corner < path.corners().size() ? path.corners()[corner] : path.length();
        if (path.centre(*edge).z - path.centre(foot).z < kLow * path.radius()) {
            ahead = std::min(place, foot) + kLead - at, comes_back_ = false;
            return;
        }
    }
    if (comes_back_) ahead = std::max(0.0, ahead - kBack * dt);
    else if (is_round) ahead = place - at;
    comes_back_ = is_round || (comes_back_ && ahead > 0.0);
}

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
