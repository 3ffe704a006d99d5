// Clearance of a leg from the ground for all wheel samples at once: loops that compilers vectorise.
//
// Single precision in metres from the first sample: good for 1e-6 m on a window of the search.
#pragma once

#include <span>

#include "stairwright/posture.hpp"

namespace stairwright::lattice {

inline constexpr float kBuried = -1.0F;  // squared distance of a link that begins in the ground or crosses its face

// The ground near wheels whose x rises; lengths are from the first wheel's centre [m].
class GroundNearWheels {
public:
    // What comes within `reach` [m] in x of the wheels.
    GroundNearWheels(const Terrain& terrain, const std::vector<Vec2>& centres, double reach);

    // Lower `best` (one a wheel) to the squared distance of the ground from a capsule's axis that moves with the wheel,
    // from `begin` (relative to its centre) along `line`; kBuried where it begins in the ground or crosses it. Larger
    // distances than `reach` leave `best` as it is.
    void lower(Vec2 begin, Vec2 line, double reach, std::span<float> best) const;

private:
    struct Face {
        float x, z, dx, dz;   // corner, vector
        float top;            // above the lowest of its wheels
        float inverse_square; // of its length
        int first, last;      // wheels that it is near to
    };

    std::vector<float> x_, z_;
    std::vector<Face> faces_;
};

// A leg of given shape that moves with its wheel.
struct MovingLeg {
    Vec2 hip, knee;  // from the wheel's centre [m]
};

// Least clearance [m] of the leg's links at each wheel centre; not told apart beyond `query_radius` and below `least`.
void leg_clearances(const Terrain& terrain, const GroundNearWheels& ground, const Leg& leg, const MovingLeg& moving,
                    const std::vector<Vec2>& centres, double query_radius, double least, std::span<float> out);

}  // namespace stairwright::lattice
