#include "stairwright/control/wheel_support.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stairwright::control {

namespace {

constexpr double kWindow = 0.15;           // m; a wheel is looked for this far from where it was
constexpr double kCornerReach = 0.04;      // m; how far from a corner the planned face may count
constexpr double kCornerMeasured = 1.25;   // times how near the plan must be; a wheel this near gets there at once
constexpr double kWidest = 80.0 * std::numbers::pi / 180.0;  // half of the widest cone
constexpr double kBeside = 1e-6;           // m

}  // namespace

double WheelSupport::traction(Vec2 f) const {
    const double det = cross(before, after);
    if (std::abs(det) < 1e-9) return f.x * before.z - f.z * before.x;
    const double on_before = cross(f, after) / det, on_after = cross(before, f) / det;
    if (on_after < 0.0) return f.x * before.z - f.z * before.x;
    if (on_before < 0.0) return f.x * after.z - f.z * after.x;
    return 0.0;
}

double locate(const WheelPath& path, Vec2 centre, double last) {
    if (std::isnan(last)) return path.project(centre, 0.0, path.length());
    return path.project(centre, std::max(0.0, last - kWindow), last + kWindow);
}

Vec2 face_normal(const WheelPath& path, double measured, double planned) {
    double at = measured;
    if (std::abs(planned - measured) < kCornerReach) {
        const auto [low, high] = std::minmax(planned, measured);
        for (std::size_t k = path.corner_from(low); k < path.corners().size() && path.corners()[k] < high; ++k)
            at = planned > measured ? path.corners()[k] + kBeside : path.corners()[k] - kBeside;
    }
    return path.normal(at);
}

WheelSupport wheel_support(const WheelPath& path, double measured, double planned, double friction, Lean lean) {
    const auto& corners = path.corners();
    const double near = corner_planned(path);
    for (std::size_t k = path.corner_from(planned - near); k < corners.size(); ++k) {
        const double corner = corners[k];
        if (corner > planned + near) break;
        if (std::abs(planned - corner) >= near) continue;
        if (std::abs(measured - corner) >= kCornerMeasured * near) {
            if (lean != (measured < corner ? Lean::before : Lean::after)) continue;
            const Vec2 n = path.normal(measured);
            return {n, friction, path.radius(), n, n};
        }
        const Vec2 a = path.normal(corner - kBeside), b = path.normal(corner + kBeside);
        if (lean == Lean::both) {
            const Vec2 sum = a + b;
            const double length = std::hypot(sum.x, sum.z);
            const double half = 0.5 * std::acos(std::clamp(dot(a, b), -1.0, 1.0));
            return {{sum.x / length, sum.z / length}, std::tan(std::min(kWidest, half + std::atan(friction))), 0.0, a, b};
        }
        const Vec2 n = lean == Lean::before ? a : b;
        return {n, friction, path.radius(), n, n};
    }
    const Vec2 n = face_normal(path, measured, planned);
    return {n, friction, path.radius(), n, n};
}

}  // namespace stairwright::control
