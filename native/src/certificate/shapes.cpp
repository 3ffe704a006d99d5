#include "stairwright/certificate/shapes.hpp"

#include <limits>

namespace stairwright::certificate {

namespace {

// Whether the ends of `s` lie on either side of the line through `line`.
bool astride(const Segment& line, const Segment& s) {
    const Vec2 along = line.end - line.begin;
    return cross(along, s.begin - line.begin) * cross(along, s.end - line.begin) < 0.0;
}

bool inside(std::span<const Vec2> corners, Vec2 p) {
    bool left = true, right = true;  // of all edges, whichever way round the corners go
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const double side = cross(corners[(k + 1) % corners.size()] - corners[k], p - corners[k]);
        left = left && side >= 0.0, right = right && side <= 0.0;
    }
    return left || right;
}

}  // namespace

double square_distance(const Segment& a, const Segment& b) {
    if (astride(a, b) && astride(b, a)) return 0.0;
    return std::min({square_distance(a.begin, b), square_distance(a.end, b), square_distance(b.begin, a),
                     square_distance(b.end, a)});
}

double square_distance(std::span<const Vec2> corners, const Segment& s, double enough) {
    const std::size_t n = corners.size();
    if (n < 3) return square_distance(Segment{corners.front(), corners.back()}, s);
    if (inside(corners, s.begin)) return 0.0;
    const Box box = box_of(s);
    for (std::size_t k = 0; k < n; ++k) {
        const Segment edge{corners[k], corners[(k + 1) % n]};
        if (square_distance(box_of(edge), box) < enough) enough = std::min(enough, square_distance(edge, s));
    }
    return enough;
}

}  // namespace stairwright::certificate
