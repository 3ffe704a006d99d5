// The ground as the certificate sees it: what is above it, how far away it is, and its faces near to a wheel.
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "stairwright/certificate/shapes.hpp"

namespace stairwright::certificate {

// A point of the ground near to a wheel.
struct Face {
    Vec2 at, normal;                                             // from there towards the wheel's centre
    double distance = std::numeric_limits<double>::infinity();  // of the centre [m]; infinite: there is no such face
};

inline constexpr std::size_t kFaces = 3;  // most that one wheel touches
using Faces = std::array<Face, kFaces>;   // nearest first

class Ground {
  public:
    // Vertices of a profile whose x never falls [m]. Throws std::invalid_argument if there are fewer than two.
    explicit Ground(std::vector<Vec2> vertices);

    // Whether there is ground below all points that are no farther than `reach` from `p`.
    bool spans(Vec2 p, double reach) const { return p.x - reach >= vertices_.front().x && p.x + reach <= vertices_.back().x; }
    // Whether `p` lies above the ground, which goes on level for a metre beyond its ends.
    bool above(Vec2 p) const;
    // Distance [m] of a convex shape by its corners (see shapes.hpp), 0 where they meet; `enough` if it is no less.
    double distance(std::span<const Vec2> corners, double enough = std::numeric_limits<double>::infinity()) const;
    // The faces within `sight` of a wheel at `centre`.
    Faces faces(Vec2 centre, double sight) const;

  private:
    Segment segment(std::size_t k) const { return {vertices_[k], vertices_[k + 1]}; }
    // Segments, the last excluded, that have a part with an x from `low` to `high`.
    std::array<std::size_t, 2> between(double low, double high) const;

    std::vector<Vec2> vertices_;
    std::vector<Box> boxes_;  // of the segments
};

}  // namespace stairwright::certificate
