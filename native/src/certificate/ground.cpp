#include "stairwright/certificate/ground.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace stairwright::certificate {

namespace {

constexpr double kSameX = 1e-9;    // m; vertices this near in x are of one vertical face
constexpr double kBeyond = 1.0;    // m of level ground beyond either end
constexpr double kOnGround = 1e-9; // m; a centre this near to the ground sees no face there
constexpr double kAlike = 0.9999;  // cosine between normals of what counts as one face

constexpr auto kBefore = [](Vec2 vertex, double x) { return vertex.x < x; };
constexpr auto kAfter = [](double x, Vec2 vertex) { return x < vertex.x; };

}  // namespace

Ground::Ground(std::vector<Vec2> vertices) : vertices_(std::move(vertices)) {
    if (vertices_.size() < 2) throw std::invalid_argument("a profile has at least two vertices");
    const Vec2 first = vertices_.front(), last = vertices_.back();
    vertices_.insert(vertices_.begin(), {first.x - kBeyond, first.z});
    vertices_.push_back({last.x + kBeyond, last.z});
    for (std::size_t k = 0; k + 1 < vertices_.size(); ++k) boxes_.push_back(box_of(segment(k)));
}

bool Ground::above(Vec2 p) const {
    if (!spans(p, 0.0)) return true;
    const auto first = std::lower_bound(vertices_.begin(), vertices_.end(), p.x - kSameX, kBefore);
    const auto last = std::upper_bound(first, vertices_.end(), p.x + kSameX, kAfter);
    if (first == last) {
        const Vec2 a = first[-1], b = *first;
        return p.z > (b.z - a.z) / (b.x - a.x) * (p.x - a.x) + a.z;
    }
    return std::all_of(first, last, [&](Vec2 vertex) { return p.z > vertex.z; });
}

std::array<std::size_t, 2> Ground::between(double low, double high) const {
    const auto first = std::lower_bound(vertices_.begin(), vertices_.end(), low, kBefore);
    const auto last = std::upper_bound(first, vertices_.end(), high, kAfter);
    const auto index = [&](auto it) { return static_cast<std::size_t>(it - vertices_.begin()); };
    return {std::clamp<std::size_t>(index(first), 1, boxes_.size()) - 1, std::min(index(last), boxes_.size())};
}

double Ground::distance(std::span<const Vec2> corners, double enough) const {
    const Box box = box_of(corners);
    double least = enough * enough;
    const auto look = [&](std::size_t k) {
        if (square_distance(boxes_[k], box) < least) least = std::min(least, square_distance(corners, segment(k), least));
    };
    // What is below or above the middle tells how far to look.
    const double middle = 0.5 * (box.low.x + box.high.x);
    look(between(middle, middle)[0]);
    const double reach = std::sqrt(least);
    const auto [first, last] = between(box.low.x - reach, box.high.x + reach);
    for (std::size_t k = first; k < last; ++k) look(k);
    return std::sqrt(least);
}

Faces Ground::faces(Vec2 centre, double sight) const {
    Faces out;
    const Box here{centre, centre};
    const auto [first, last] = between(centre.x - sight, centre.x + sight);
    for (std::size_t found = 0; found < kFaces; ++found) {
        Face& next = out[found];
        for (std::size_t k = first; k < last; ++k) {
            if (square_distance(boxes_[k], here) > sight * sight) continue;
            const Vec2 at = nearest(centre, segment(k)), off = centre - at;
            const double distance = norm(off);
            if (distance < kOnGround || distance > sight || distance >= next.distance) continue;
            const auto alike = [&](const Face& face) { return dot(off, face.normal) >= kAlike * distance; };
            if (std::none_of(out.begin(), out.begin() + found, alike))
                next = {at, {off.x / distance, off.z / distance}, distance};
        }
        if (std::isinf(next.distance)) break;
    }
    return out;
}

}  // namespace stairwright::certificate
