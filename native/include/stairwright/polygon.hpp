// Convex polygons of the trunk's outline.
#pragma once

#include <vector>

#include "stairwright/vec2.hpp"

namespace stairwright {

class Polygon {
  public:
    // Corners anticlockwise, seen with x right and z up. Throws std::invalid_argument if they are not convex.
    explicit Polygon(std::vector<Vec2> corners);

    const std::vector<Vec2>& corners() const { return corners_; }
    Vec2 middle() const { return middle_; }
    // Radius of the circle round the middle that holds all corners.
    double radius() const { return radius_; }
    // How far `p` is outside the edge that it is farthest outside of; negative: minus its depth inside.
    double separation(Vec2 p) const;
    // Distance from the segment a-b if it is less than `query_radius`, else some value that is not; 0 where they meet.
    double distance(Vec2 a, Vec2 b, double query_radius) const;

  private:
    bool meets(Vec2 a, Vec2 b) const;

    std::vector<Vec2> corners_, normals_;  // normal k: of the edge from corner k, outward
    Vec2 middle_;
    double radius_ = 0.0;
};

}  // namespace stairwright
