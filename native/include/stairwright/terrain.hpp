// The ground below an x-monotone profile, and exact distances of points, links and polygons from it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "stairwright/polygon.hpp"

namespace stairwright {

// Squared distance from a point to the segment a-b.
inline double point_segment_squared(Vec2 p, Vec2 a, Vec2 b) {
    const Vec2 d = b - a;
    const double square = dot(d, d);
    double t = square > 1e-18 ? dot(p - a, d) / square : 0.0;
    t = std::min(1.0, std::max(0.0, t));
    const Vec2 e = p - a - t * d;
    return dot(e, e);
}

// Squared distance of the segments a-b and c-d; 0 where they cross.
inline double segment_distance_squared(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
    const double s1 = cross(b - a, c - a), s2 = cross(b - a, d - a);
    const double s3 = cross(d - c, a - c), s4 = cross(d - c, b - c);
    if (s1 * s2 < 0.0 && s3 * s4 < 0.0) return 0.0;
    return std::min(std::min(point_segment_squared(a, c, d), point_segment_squared(b, c, d)),
                    std::min(point_segment_squared(c, a, b), point_segment_squared(d, a, b)));
}

inline double segment_distance(Vec2 a, Vec2 b, Vec2 c, Vec2 d) { return std::sqrt(segment_distance_squared(a, b, c, d)); }

// A profile whose x never decreases (equal x: a vertical face), and a metre of level ground beyond either end, as a
// simulation has it; indexed by buckets of x.
class Terrain {
  public:
    // Throws std::invalid_argument if the profile has fewer than two points, runs back or holds what is no number.
    explicit Terrain(const std::vector<Vec2>& profile);

    const std::vector<Vec2>& vertices() const { return vertices_; }
    std::size_t segments() const { return vertices_.size() - 1; }
    // Index of a segment at or before the first that touches abscissas from `x` on.
    std::size_t first_segment(double x) const;
    // Upper height of the ground at `x`; -inf where there is none.
    double height(double x) const;
    // Distance of a point from the profile, at most `query_radius`.
    double distance(Vec2 point, double query_radius) const;
    // Distance of the capsule a-b from the ground, at most `query_radius`; minus its depth if inside [m].
    // The depth counts from the capsule's axis, so that it shrinks as the link backs out.
    double link_clearance(Vec2 a, Vec2 b, double radius, double query_radius) const;
    // Distance of a convex polygon of the trunk frame at `body`, at most `query_radius`; minus its depth if inside [m].
    double polygon_clearance(const Polygon& polygon, Vec2 at, Turn pitch, double query_radius) const;

  private:
    // Depth of the axis of a link that is in the ground [m]: the deepest of five of its points.
    double depth_below(Vec2 a, Vec2 b) const;
    // Of one whose beginning is not: how far the corners that it cuts off stand out beyond it.
    double depth_beyond(Vec2 a, Vec2 b) const;

    std::vector<Vec2> vertices_;
    std::vector<std::int32_t> first_;  // per bucket of x: the first segment that reaches into it
};

}  // namespace stairwright
