#include "stairwright/terrain.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "stairwright/whole.hpp"

namespace stairwright {

namespace {
constexpr double kBucket = 0.02;    // m
constexpr double kPierced = 0.005;  // m; depth of what a spike goes through that has no width to be deep in
constexpr double kDeepest = 0.5;    // m; larger depths are not told apart
constexpr double kFarthest = 1e4;  // m
constexpr double kRunOut = 1.0;    // m
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void check_profile(const std::vector<Vec2>& vertices) {
    if (vertices.size() < 2) throw std::invalid_argument("a profile needs at least two points");
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const Vec2 p = vertices[i];
        if (!(std::abs(p.x) <= kFarthest && std::abs(p.z) <= kFarthest))
            throw std::invalid_argument("a profile's coordinates must be numbers up to 10,000 m");
        if (i > 0 && p.x < vertices[i - 1].x) throw std::invalid_argument("along a profile x must never decrease");
    }
}

// The ground goes on level beyond its ends.
std::vector<Vec2> run_out(const std::vector<Vec2>& profile) {
    std::vector<Vec2> out = {profile.front() - Vec2{kRunOut, 0.0}};
    out.insert(out.end(), profile.begin(), profile.end());
    out.push_back(profile.back() + Vec2{kRunOut, 0.0});
    return out;
}

}  // namespace

Terrain::Terrain(const std::vector<Vec2>& profile) {
    check_profile(profile);
    vertices_ = run_out(profile);
    const double begin = vertices_.front().x;
    const auto buckets = static_cast<std::size_t>((vertices_.back().x - begin) / kBucket) + 2;
    first_.resize(buckets);
    std::size_t k = 0;
    for (std::size_t i = 0; i < buckets; ++i) {
        const double edge = begin + kBucket * static_cast<double>(i);
        while (k < vertices_.size() && vertices_[k].x < edge) ++k;
        first_[i] = static_cast<std::int32_t>(k > 0 ? k - 1 : 0);
    }
}

std::size_t Terrain::first_segment(double x) const {
    const double bucket = (x - vertices_.front().x) / kBucket;
    return static_cast<std::size_t>(first_[whole_part(bucket, first_.size() - 1)]);
}

double Terrain::height(double x) const {
    double best = -kInfinity;
    for (std::size_t i = first_segment(x); i < segments(); ++i) {
        const Vec2 a = vertices_[i], b = vertices_[i + 1];
        if (a.x > x) break;
        if (x > b.x) continue;
        const double width = b.x - a.x;
        best = std::max(best, width < 1e-12 ? std::max(a.z, b.z) : a.z + (b.z - a.z) * (x - a.x) / width);
    }
    return best;
}

double Terrain::distance(Vec2 point, double query_radius) const {
    double best = query_radius * query_radius;
    for (std::size_t i = first_segment(point.x - query_radius); i < segments(); ++i) {
        if (vertices_[i].x > point.x + query_radius) break;
        best = std::min(best, point_segment_squared(point, vertices_[i], vertices_[i + 1]));
    }
    return std::sqrt(best);
}

double Terrain::link_clearance(Vec2 a, Vec2 b, double radius, double query_radius) const {
    double best = query_radius + radius;
    const double lo = std::min(a.x, b.x) - best, hi = std::max(a.x, b.x) + best, bottom = std::min(a.z, b.z);
    bool inside = false;
    for (std::size_t i = first_segment(lo); i < segments(); ++i) {
        const Vec2 p = vertices_[i], q = vertices_[i + 1];
        if (p.x > hi) break;
        if (q.x < lo || std::max(p.z, q.z) < bottom - best) continue;
        const double square = segment_distance_squared(a, b, p, q);
        if (square < best * best) best = std::min(best, std::sqrt(square));
        if (p.x <= a.x && a.x <= q.x && q.x > p.x && a.z < p.z + (q.z - p.z) * (a.x - p.x) / (q.x - p.x)) inside = true;
    }
    if (best > 0.0 && !inside) return best - radius;
    return -radius - (inside ? depth_below(a, b) : depth_beyond(a, b));
}

double Terrain::depth_below(Vec2 a, Vec2 b) const {
    double depth = 0.0;
    for (int k = 0; k < 5; ++k) {
        const Vec2 p = a + (0.25 * k) * (b - a);
        if (p.z < height(p.x)) depth = std::max({depth, distance(p, kDeepest), 1e-4});
    }
    return depth > 2e-4 ? depth : kPierced;
}

double Terrain::depth_beyond(Vec2 a, Vec2 b) const {
    double depth = 0.0, beyond = 0.0;  // of what lies beyond a-b since the profile last crossed it
    bool crossed = false;
    const double hi = std::max(a.x, b.x);
    for (std::size_t i = first_segment(std::min(a.x, b.x)); i < segments() && vertices_[i].x <= hi; ++i) {
        if (crossed) beyond = std::max(beyond, std::sqrt(point_segment_squared(vertices_[i], a, b)));
        if (segment_distance_squared(a, b, vertices_[i], vertices_[i + 1]) > 0.0) continue;
        if (crossed) depth = std::max(depth, beyond);
        crossed = !crossed, beyond = 0.0;
    }
    return crossed ? std::max(depth, depth_below(a, b)) : depth;
}

double Terrain::polygon_clearance(const Polygon& polygon, Vec2 at, Turn pitch, double query_radius) const {
    double best = query_radius, depth = 0.0, lo = kInfinity, hi = -kInfinity, bottom = kInfinity;
    for (const Vec2 corner : polygon.corners()) {
        const Vec2 p = at + pitch * corner;
        lo = std::min(lo, p.x), hi = std::max(hi, p.x), bottom = std::min(bottom, p.z);
    }
    lo -= query_radius, hi += query_radius;
    const Vec2 middle = at + pitch * polygon.middle();
    bool below = false;
    for (std::size_t i = first_segment(lo); i < segments(); ++i) {
        const Vec2 a = vertices_[i], b = vertices_[i + 1];
        if (a.x > hi) break;
        if (b.x < lo || std::max(a.z, b.z) < bottom - best) continue;
        if (a.x <= middle.x && middle.x <= b.x && b.x > a.x &&
            middle.z < a.z + (b.z - a.z) * (middle.x - a.x) / (b.x - a.x))
            below = true;
        const Vec2 u = pitch.inverse(a - at), v = pitch.inverse(b - at);
        const double inside = -std::min(polygon.separation(u), polygon.separation(v));
        if (inside >= 0.0) depth = std::max(depth, inside);
        best = std::min(best, inside >= 0.0 ? 0.0 : polygon.distance(u, v, best));
    }
    if (best > 0.0 && !below) return best;
    for (const Vec2 corner : polygon.corners()) {
        const Vec2 p = at + pitch * corner;
        if (p.z < height(p.x)) depth = std::max({depth, distance(p, kDeepest), 1e-4});
    }
    return -(depth > 0.0 ? depth : 4.0 * kPierced);
}

}  // namespace stairwright
