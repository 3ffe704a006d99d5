#include "stairwright/control/face_search.hpp"

#include <algorithm>

namespace stairwright::control {

namespace {

constexpr double kSpeed = 0.04;     // m/s
constexpr double kMostLead = 0.12;  // m ahead of the wheels, which makes them push
constexpr double kLeadTime = 2.0;   // s until it is reached
constexpr double kLetGo = 4.0;      // times as fast it goes once they move

}  // namespace

Reference FaceSearch::step(const Reference& planned, const Ahead& ahead, const std::array<double, 4>& places, bool stalled, double dt) {
    pushed_ = stalled && (ahead.nearing[0] || ahead.nearing[1]) ? std::min(pushed_ + dt, kLeadTime) : std::max(0.0, pushed_ - kLetGo * dt);
    if (!ahead.any()) {
        waited_ = std::max(0.0, waited_ - dt);
        Reference out = planned;
        for (double& wheels : out.value.wheels) wheels += kMostLead * pushed_ / kLeadTime;
        return out;
    }
    waited_ = std::min(waited_ + dt, kLeadTime);
    Reference out = planned;
    double body = 0.0;
    for (int pair = 0; pair < 2; ++pair) {
        if (!ahead.searching[pair] && !ahead.on_tread[pair]) continue;
        out.rate.wheels[pair] += kSpeed;
        out.value.wheels[pair] = 0.5 * (places[2 * pair] + places[2 * pair + 1]) + kMostLead * waited_ / kLeadTime;
        body += 0.5 * kSpeed;
        if (ahead.searching[pair]) out.lean[pair] = static_cast<double>(Lean::before);
    }
    out.rate.com.x += body, out.rate.trunk.x += body;
    return out;
}

}  // namespace stairwright::control
