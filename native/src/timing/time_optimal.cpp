#include "stairwright/timing/time_optimal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace stairwright::timing {

namespace {

constexpr int kHalvings = 52;       // as many as a double has digits
constexpr double kFlat = 1e-12;     // a limit with a smaller b does not bound u
constexpr double kRounding = 1e-9;  // of a limit's c

struct Accelerations {
    double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();

    bool any() const { return least <= most; }
};

// Accelerations that the limits allow at x, and that lead to squares in [0, next].
Accelerations allowed(std::span<const Limit> limits, double x, double next, double step) {
    Accelerations u = {-x / (2.0 * step), (next - x) / (2.0 * step)};
    for (const Limit& limit : limits) {
        const double room = limit.a * x + limit.c;
        if (limit.b > kFlat)
            u.least = std::max(u.least, -room / limit.b);
        else if (limit.b < -kFlat)
            u.most = std::min(u.most, -room / limit.b);
        else if (room < -kRounding)
            return {1.0, -1.0};
    }
    return u;
}

// The largest x up to `cap` from which squares in [0, next] can be reached: those x are an interval from 0.
double largest(std::span<const Limit> limits, double cap, double next, double step) {
    if (allowed(limits, cap, next, step).any()) return cap;
    double good = 0.0, bad = cap;
    for (int i = 0; i < kHalvings; ++i) {
        const double middle = 0.5 * (good + bad);
        (allowed(limits, middle, next, step).any() ? good : bad) = middle;
    }
    return good;
}

}  // namespace

std::vector<double> fastest_squares(std::span<const Limit> limits, std::span<const double> caps, double step) {
    const std::size_t n = caps.size();
    if (n < 2 || limits.size() % n != 0) throw std::invalid_argument("as many limits at each of two samples or more");
    if (!(step > 0.0)) throw std::invalid_argument("step must be positive");
    for (const Limit& limit : limits)
        if (!(limit.c >= 0.0) || !std::isfinite(limit.a + limit.b)) throw std::invalid_argument("standing must be allowed");
    for (const double cap : caps)
        if (!(cap >= 0.0 && std::isfinite(cap))) throw std::invalid_argument("caps must be finite and not negative");
    const std::size_t count = limits.size() / n;
    const auto at = [&](std::size_t i) { return limits.subspan(i * count, count); };
    std::vector<double> reachable(n, 0.0);  // largest x from which rest at the end can be reached
    for (std::size_t i = n - 1; i-- > 0;) reachable[i] = largest(at(i), caps[i], reachable[i + 1], step);
    std::vector<double> x(n, 0.0);
    for (std::size_t i = 0; i + 1 < n; ++i) {
        const double most = allowed(at(i), x[i], reachable[i + 1], step).most;
        x[i + 1] = std::clamp(x[i] + 2.0 * step * most, 0.0, reachable[i + 1]);
    }
    return x;
}

}  // namespace stairwright::timing
