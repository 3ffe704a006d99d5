#include "stairwright/timing/time_optimal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace stairwright::timing {

namespace {

constexpr int kSteps = 100;         // more than any set of limits has corners that count
constexpr double kFlat = 1e-12;     // a limit with a smaller b does not bound u
constexpr double kRounding = 1e-9;  // of a limit's c

// u from `at_rest` on, along with x.
struct Bound {
    double at_rest, slope;

    double at(double x) const { return at_rest + slope * x; }
};

struct Accelerations {
    Bound least, most;  // the tightest at the x that was asked for
    double largest_x = std::numeric_limits<double>::infinity();  // by limits that do not bound u
};

// What bounds the accelerations at x; they also have to lead to squares in [0, next].
Accelerations allowed(std::span<const Limit> limits, double x, double next, double step) {
    Accelerations u = {{0.0, -0.5 / step}, {0.5 * next / step, -0.5 / step}};
    double least = u.least.at(x), most = u.most.at(x);
    for (const Limit& limit : limits) {
        if (std::abs(limit.b) <= kFlat) {
            if (limit.a < 0.0) u.largest_x = std::min(u.largest_x, (limit.c + kRounding) / -limit.a);
            continue;
        }
        const Bound bound = {-limit.c / limit.b, -limit.a / limit.b};
        const double value = bound.at(x);
        if (limit.b > 0.0 && value > least) least = value, u.least = bound;
        if (limit.b < 0.0 && value < most) most = value, u.most = bound;
    }
    return u;
}

// The largest x up to `cap` from which squares in [0, next] can be reached: those x are an interval from 0. What is
// left between the bounds of u is concave in x, so Newton's steps from above end at its root.
double largest(std::span<const Limit> limits, double cap, double next, double step) {
    double x = cap;
    for (int i = 0; i < kSteps; ++i) {
        const Accelerations u = allowed(limits, x, next, step);
        if (x > u.largest_x) {
            x = u.largest_x;
            continue;
        }
        const double gap = u.most.at(x) - u.least.at(x), closing = u.least.slope - u.most.slope;
        if (gap >= -kRounding * (1.0 + std::abs(u.most.at(x)))) return x;
        if (!(closing > 0.0)) return 0.0;
        x = std::max(x + gap / closing, 0.0);
    }
    return x;
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
        const double most = allowed(at(i), x[i], reachable[i + 1], step).most.at(x[i]);
        x[i + 1] = std::clamp(x[i] + 2.0 * step * most, 0.0, reachable[i + 1]);
    }
    return x;
}

}  // namespace stairwright::timing
