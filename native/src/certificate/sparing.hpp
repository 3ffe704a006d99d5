// Distances at many samples of a motion, found only where they may matter.
#pragma once

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

namespace stairwright::certificate {

// Distances [m] at samples: exact where less than the sample's slack, and where they may be the least of all after that
// is taken off; elsewhere bounds, no more than the distance. `exact(k)` tells it at sample k, `moved(j, k)` the most
// that it differs between two samples: a distance changes by no more than the parts move.
template <typename Exact, typename Moved>
std::vector<double> sparing_distances(std::span<const double> slack, Exact exact, Moved moved) {
    constexpr std::size_t kStep = 8;  // every so manieth sample is looked at for sure
    constexpr double kMore = 1e-6;    // m; so much more is looked at than matters: what is not is farther off for sure
    const std::size_t n = slack.size();
    std::vector<double> out(n);
    double least = std::numeric_limits<double>::infinity();
    const auto look = [&](std::size_t k) {
        out[k] = exact(k);
        least = std::min(least, out[k] - slack[k]);
    };
    for (std::size_t k = 0; k < n; k += kStep) look(k);
    std::size_t before = 0;
    for (std::size_t k = 0; k < n; ++k) {
        const std::size_t after = (k / kStep + 1) * kStep;
        if (k % kStep != 0) {
            const auto settled = [&, enough = std::max(least, 0.0) + slack[k] + kMore](std::size_t other) {
                out[k] = out[other] - moved(other, k);
                return out[k] > enough;
            };
            if (settled(before) || (after < n && settled(after))) continue;
            look(k);
        }
        before = k;
    }
    return out;
}

}  // namespace stairwright::certificate
