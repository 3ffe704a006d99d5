// What the ground offers a resting wheel, and where the rear wheels may stand.
#pragma once

#include <vector>

#include "stairwright/statics.hpp"
#include "stairwright/wheel_path.hpp"

namespace stairwright::poses {

// Whether a wheel at `s` rests: on ground that holds it, and well past any that does not. A wheel that has only just
// climbed an edge would leave the whole climb to the short way of the other wheel before. `scale` is the robot's size
// (RobotModel::scale).
bool rests(const WheelPath& path, double s, double friction, double scale);

// Arc length of the next ground that does not hold a resting wheel alone, or infinity.
double steep_ahead(const WheelPath& path, double s, double friction, double scale);

// Mean height of the ground between two abscissas [m]; constant beyond its ends.
double mean_height(const Terrain& terrain, double lower, double upper);

// Which places of the rear wheels are worth trying. SI units.
struct RearSearch {
    double front = 0.0;            // arc length of the front wheels
    double face = 0.0;             // where the front wheels are on the face while the rear ones stay: both must hold the robot
    Range rear;                    // arc lengths allowed
    Range distance;                // of the wheels' centres
    double usual_distance = 0.0;   // of the place tried first
    double step = 0.0;             // between places
    double friction = 0.0;
    double scale = 1.0;            // of the robot
    bool resting = false;          // only where a wheel rests
};

// Arc lengths, from the usual distance outward.
std::vector<double> rear_places(const WheelPath& path, const RearSearch& query);

}  // namespace stairwright::poses
