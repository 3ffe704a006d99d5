// Vectors and unit quaternions (w x y z) of three dimensions.
#pragma once

#include <array>
#include <cmath>

namespace stairwright::estimation {

using Vec3 = std::array<double, 3>;

inline Vec3 times(const std::array<Vec3, 3>& R, const Vec3& v) {
    Vec3 out;
    for (int i = 0; i < 3; ++i) out[i] = R[i][0] * v[0] + R[i][1] * v[1] + R[i][2] * v[2];
    return out;
}

inline Vec3 cross3(const Vec3& a, const Vec3& b) { return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}; }
inline double dot3(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

inline std::array<double, 4> product(const std::array<double, 4>& a, const std::array<double, 4>& b) {
    return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
            a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

// Quaternion of a small turn.
inline std::array<double, 4> turn(const Vec3& v) {
    const double angle = std::sqrt(dot3(v, v)), k = angle > 1e-9 ? std::sin(0.5 * angle) / angle : 0.5;
    return {std::cos(0.5 * angle), k * v[0], k * v[1], k * v[2]};
}

inline void normalise(std::array<double, 4>& q) {
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (double& v : q) v /= length;
}

}  // namespace stairwright::estimation
