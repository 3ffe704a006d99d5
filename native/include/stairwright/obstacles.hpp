// The obstacles of a terrain: rises and descents of the wheel's centre between two treads.
#pragma once

#include <vector>

#include "stairwright/wheel_path.hpp"

namespace stairwright {

// Lengths in m.
struct Obstacle {
    double begin = 0.0;     // arc length where the curve leaves the tread before it: the wheel arrives at the face (eq 25)
    double end = 0.0;       // arc length where the next tread is reached
    double height = 0.0;    // gained, or lost where negative (h of eq 26)
    double face = 0.0;      // h / sin(gamma), gamma the steepest slope of the wheel's way
    double steepest = 0.0;  // arc length of the last place that is as steep
};

// Obstacles between the arc lengths `lower` and `upper`, in order. A tread is a stretch at least 0.1 m long whose
// slope stays below 3 degrees. Between two treads every rise or descent of at least 0.02 m is an obstacle, smaller
// turns within it ignored; a flight whose treads are not level is one obstacle for each of its faces.
std::vector<Obstacle> find_obstacles(const WheelPath& path, double lower, double upper);

}  // namespace stairwright
