// What the document of a pose states.
#pragma once

#include "stairwright/poses/sqp.hpp"
#include "stairwright/statics.hpp"

namespace stairwright::poses {

// The worst margins are minus infinity: nothing holds the robot there.
struct PoseRecord {
    Joints q{};                               // rad
    std::array<Vec2, 2> wheels, contacts;     // m
    std::array<ContactForce, 2> forces;       // of each wheel pair [N]
    Vec2 com;                                 // m
    double clearance = 0.0, com_margin = 0.0; // m
    double friction_margin = 0.0;
    double torque_margin = 0.0;               // Nm
    std::vector<Vec2> collision_points;       // of the paper [m]
};

// Of a pose with its wheels on the curve; `q` counts where a leg is out of reach.
PoseRecord pose_record(const PoseProblem& problem, double friction, const Unknowns& y, const Joints& q);

}  // namespace stairwright::poses
