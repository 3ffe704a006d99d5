// Exact distance of a posture from the terrain, and where on it: what documents state.
#pragma once

#include "stairwright/posture.hpp"

namespace stairwright {

struct Clearance {
    double distance = 0.0;  // m; negative where bodies overlap: then the depth of the deepest point on a 1 mm raster
    Vec2 at;                // on the ground, or the deepest point
};

// Of trunk and links (wheels touch); larger distances than kFar are cut off.
inline constexpr double kFar = 0.5;  // m
Clearance least_clearance(const Terrain& terrain, const Robot& robot, const Body& body, const std::array<LegPoints, 2>& legs);

}  // namespace stairwright
