#include "stairwright/smoothing/resample.hpp"

#include <cmath>

namespace stairwright::smoothing {

Column path_parameter(std::span<const Node> poses, double swing) {
    Column u = {0.0};
    for (std::size_t k = 1; k < poses.size(); ++k) {
        const Node &a = poses[k - 1], &b = poses[k];
        const double rolled = 0.5 * (std::abs(b.s.front - a.s.front) + std::abs(b.s.rear - a.s.rear));
        const double moved = norm({b.body.x - a.body.x, b.body.z - a.body.z}) + 0.25 * std::abs(b.body.pitch - a.body.pitch);
        u.push_back(u.back() + (std::hypot(rolled, swing * moved) + 1e-9));
    }
    return u;
}

std::vector<Node> resample(std::span<const Node> poses, const Column& u, std::size_t count) {
    std::vector<Node> out;
    const double step = u.back() / static_cast<double>(count - 1);
    std::size_t k = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double at = i + 1 == count ? u.back() : step * static_cast<double>(i);
        while (k + 2 < u.size() && u[k + 1] <= at) ++k;
        out.push_back(between(poses[k], poses[k + 1], (at - u[k]) / (u[k + 1] - u[k])));
    }
    out.back() = poses.back();
    return out;
}

}  // namespace stairwright::smoothing
