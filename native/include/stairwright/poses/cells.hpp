// The ground as convex cells: the solid under the profile, cut at concave corners.
#pragma once

#include <vector>

#include "stairwright/vec2.hpp"

namespace stairwright::poses {

struct Face {
    Vec2 normal;  // outward
    double offset = 0.0;

    double distance(Vec2 p) const { return dot(normal, p) - offset; }  // negative inside
};

struct Cell {
    std::vector<Face> faces;
    std::vector<Vec2> corners;
    double left = 0.0, right = 0.0, top = 0.0;
};

// Cells in order of x.
std::vector<Cell> terrain_cells(const std::vector<Vec2>& vertices);

}  // namespace stairwright::poses
