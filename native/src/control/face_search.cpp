#include "stairwright/control/face_search.hpp"

namespace stairwright::control {

namespace {

constexpr double kSpeed = 0.04;  // m/s

}  // namespace

Reference search(const Reference& waiting, const Ahead& ahead, const std::array<double, 4>& places) {
    Reference out = waiting;
    double body = 0.0;
    for (int pair = 0; pair < 2; ++pair) {
        if (!ahead.searching[pair] && !ahead.on_tread[pair]) continue;
        out.rate.wheels[pair] += kSpeed;
        out.value.wheels[pair] = 0.5 * (places[2 * pair] + places[2 * pair + 1]);
        body += 0.5 * kSpeed;
        if (ahead.searching[pair]) out.lean[pair] = static_cast<double>(Lean::before);
    }
    out.rate.com.x += body, out.rate.trunk.x += body;
    return out;
}

}  // namespace stairwright::control
