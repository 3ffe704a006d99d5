#include "stairwright/smoothing/banded.hpp"

#include <algorithm>

namespace stairwright::smoothing {

void solve_banded(BandMatrix& h, std::span<double> b) {
    const std::size_t n = b.size() - kBand;
    for (std::size_t i = 0; i < n; ++i) {
        h[i][0] = 1.0 / std::max(h[i][0], 1e-12);
        for (int u = 1; u <= kBand; ++u) {
            const double share = h[i][u] * h[i][0];
            b[i + u] -= share * b[i];
            for (int v = u; v <= kBand; ++v) h[i + u][v - u] -= share * h[i][v];
        }
    }
    std::fill(b.begin() + static_cast<std::ptrdiff_t>(n), b.end(), 0.0);
    for (std::size_t i = n; i-- > 0;) {
        double v = b[i];
        for (int u = 1; u <= kBand; ++u) v -= h[i][u] * b[i + u];
        b[i] = v * h[i][0];
    }
}

double Evenness::cost(std::span<const Body> nodes, std::span<double> gradient) const {
    std::fill(gradient.begin(), gradient.end(), 0.0);
    const std::array<double Body::*, 3> axes = {&Body::x, &Body::z, &Body::pitch};
    double total = 0.0;
    for (std::size_t a = 0; a < 3; ++a) {
        const double unit = units()[a];
        const auto at = [&](std::size_t k) { return nodes[k].*axes[a]; };
        for (std::size_t k = 1; k < nodes.size(); ++k) {
            const double e = (at(k) - at(k - 1)) * unit;
            total += rate * e * e;
            gradient[3 * k + a] += rate * unit * e;
            gradient[3 * (k - 1) + a] -= rate * unit * e;
        }
        for (std::size_t k = 1; k + 1 < nodes.size(); ++k) {
            const double e = (at(k - 1) - 2.0 * at(k) + at(k + 1)) * unit;
            total += curvature * e * e;
            gradient[3 * (k - 1) + a] += curvature * unit * e;
            gradient[3 * k + a] -= 2.0 * curvature * unit * e;
            gradient[3 * (k + 1) + a] += curvature * unit * e;
        }
    }
    return total;
}

BandMatrix Evenness::hessian(std::size_t n) const {
    BandMatrix h(3 * n + kBand);
    constexpr std::array<double, 3> second = {1.0, -2.0, 1.0};
    for (std::size_t a = 0; a < 3; ++a) {
        const double first = rate * (units()[a] * units()[a]), bend = curvature * (units()[a] * units()[a]);
        for (std::size_t k = 1; k < n; ++k) {
            h[3 * (k - 1) + a][0] += first;
            h[3 * k + a][0] += first;
            h[3 * (k - 1) + a][3] -= first;
        }
        for (std::size_t k = 1; k + 1 < n; ++k)
            for (std::size_t u = 0; u < 3; ++u)
                for (std::size_t v = u; v < 3; ++v) h[3 * (k - 1 + u) + a][3 * (v - u)] += bend * second[u] * second[v];
    }
    return h;
}

}  // namespace stairwright::smoothing
