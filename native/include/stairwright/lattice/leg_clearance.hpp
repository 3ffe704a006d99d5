// Front leg against rear leg for many poses of the trunk, written so that it vectorises.
#pragma once

#include <cstdint>

#include "stairwright/posture.hpp"

namespace stairwright::lattice {

// Trunk poses, structure of arrays: place from the front wheel's centre [m], and the pitch.
struct TrunkPoses {
    const float *x = nullptr, *z = nullptr, *cos = nullptr, *sin = nullptr;
    int count = 0;
};

// Sets clear[k]: whether the legs are at least `distance` [m] apart, with the rear wheel's centre at `rear_wheel` from
// the front one's. Links count as straight capsules as thick as their thickest part. Good for 1e-6 m.
void legs_clear(const RobotModel& robot, double distance, Vec2 rear_wheel, const TrunkPoses& poses, std::uint8_t* clear);

}  // namespace stairwright::lattice
