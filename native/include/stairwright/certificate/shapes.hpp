// Distances of segments and convex shapes for the certificate, which shares none with the planner.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "stairwright/vec2.hpp"

namespace stairwright::certificate {

struct Segment {
    Vec2 begin, end;
};

// Holds what it is made of; distances of boxes bound those of what they hold.
struct Box {
    Vec2 low, high;
};

inline Box box_of(std::span<const Vec2> points) {
    Box box{points.front(), points.front()};
    for (const Vec2 p : points) {
        box.low = {std::min(box.low.x, p.x), std::min(box.low.z, p.z)};
        box.high = {std::max(box.high.x, p.x), std::max(box.high.z, p.z)};
    }
    return box;
}

inline Box box_of(const Segment& s) { return box_of(std::array{s.begin, s.end}); }

// All distances here are squares [m^2].
inline double square_distance(const Box& a, const Box& b) {
    const double x = std::max({0.0, a.low.x - b.high.x, b.low.x - a.high.x});
    const double z = std::max({0.0, a.low.z - b.high.z, b.low.z - a.high.z});
    return x * x + z * z;
}

inline Vec2 nearest(Vec2 p, const Segment& s) {
    const Vec2 along = s.end - s.begin;
    const double square = dot(along, along);
    if (!(square > 0.0)) return s.begin;
    return s.begin + std::clamp(dot(p - s.begin, along) / square, 0.0, 1.0) * along;
}

inline double square_distance(Vec2 p, const Segment& s) {
    const Vec2 off = p - nearest(p, s);
    return dot(off, off);
}

// 0 where they cross.
double square_distance(const Segment& a, const Segment& b);

// Of a convex shape by its corners: one is a point, two are a segment, more a polygon with what is inside. Where it is
// no less than `enough`, some number that is not.
double square_distance(std::span<const Vec2> corners, const Segment& s, double enough);

}  // namespace stairwright::certificate
