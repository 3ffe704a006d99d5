#include "stairwright/polygon.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "stairwright/terrain.hpp"

namespace stairwright {

Polygon::Polygon(std::vector<Vec2> corners) : corners_(std::move(corners)) {
    const std::size_t n = corners_.size();
    if (n < 3) throw std::invalid_argument("a polygon needs at least three corners");
    for (std::size_t k = 0; k < n; ++k) {
        const Vec2 edge = corners_[(k + 1) % n] - corners_[k], next = corners_[(k + 2) % n] - corners_[(k + 1) % n];
        const double length = norm(edge);
        if (!(length > 0.0) || !(cross(edge, next) >= 0.0))
            throw std::invalid_argument("a polygon's corners must be convex and anticlockwise");
        normals_.push_back({edge.z / length, -edge.x / length});
        middle_ += (1.0 / static_cast<double>(n)) * corners_[k];
    }
    for (const Vec2 corner : corners_) radius_ = std::max(radius_, norm(corner - middle_));
}

double Polygon::separation(Vec2 p) const {
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < corners_.size(); ++k) most = std::max(most, dot(normals_[k], p - corners_[k]));
    return most;
}

double Polygon::distance(Vec2 a, Vec2 b, double query_radius) const {
    for (std::size_t k = 0; k < corners_.size(); ++k) {  // the edge's line separates them by that much
        const double gap = std::min(dot(normals_[k], a - corners_[k]), dot(normals_[k], b - corners_[k]));
        if (gap >= query_radius) return gap;
    }
    if (meets(a, b)) return 0.0;
    double square = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < corners_.size(); ++k) {
        const Vec2 c = corners_[k], d = corners_[(k + 1) % corners_.size()];
        square = std::min({square, point_segment_squared(c, a, b), point_segment_squared(a, c, d),
                           point_segment_squared(b, c, d)});
    }
    return std::sqrt(square);
}

// Clip the segment by every edge (Cyrus and Beck): something is left.
bool Polygon::meets(Vec2 a, Vec2 b) const {
    double from = 0.0, to = 1.0;
    for (std::size_t k = 0; k < corners_.size(); ++k) {
        const double begin = dot(normals_[k], a - corners_[k]), end = dot(normals_[k], b - corners_[k]);
        if (begin > 0.0 && end > 0.0) return false;
        if (begin > 0.0)
            from = std::max(from, begin / (begin - end));
        else if (end > 0.0)
            to = std::min(to, begin / (begin - end));
    }
    return from <= to;
}

}  // namespace stairwright
