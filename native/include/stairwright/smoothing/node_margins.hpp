// What every node of a path is worth: joints, margins, forces and torques.
#pragma once

#include <span>
#include <vector>

#include "stairwright/posture.hpp"
#include "stairwright/wheel_contacts.hpp"

namespace stairwright::smoothing {

// Where a pair of wheels carries less than this share of the weight, the robot stands on the other one. There it may lean by so
// much from what is planned [rad] without tipping over, about a height of that share of its legs: a robot that is low tips slowly.
inline constexpr double kLight = 0.15, kLean = 0.05, kLow = 0.75;
// What is kept with less than that beyond its bound is kept with next to nothing to spare [m].
inline constexpr double kSpare = 5e-4;

struct Node {
    WheelPlaces s;
    Body body;
};

// Linear interpolation.
inline double between(double a, double b, double share) { return (b - a) * share + a; }
inline Body between(const Body& a, const Body& b, double share) {
    return {between(a.x, b.x, share), between(a.z, b.z, share), between(a.pitch, b.pitch, share)};
}
inline Node between(const Node& a, const Node& b, double share) {
    return {{between(a.s.front, b.s.front, share), between(a.s.rear, b.s.rear, share)}, between(a.body, b.body, share)};
}

struct NodeMargins {
    PoseGeometry geometry;
    double com = 0.0;                    // CoM margin at the friction there is [m]
    double firm_com = 0.0;               // the same with friction on one face of a corner only, which robots can hold [m]
    double strayed_com = 0.0;            // the same where a wheel on an edge is kLeastStray from its place [m]
    double friction_needed = 0.0;
    double com_height = 0.0;             // of the CoM above the contacts of the pair that carries more [m]
    std::array<ContactForce, 2> forces;  // of each wheel pair [N]; a wheel between two faces: along what carries it
    // Of each leg; a pair's force is shared by its two legs.
    std::array<LegTorques, 2> torques;
};

std::vector<NodeMargins> node_margins(const Terrain& terrain, const WheelPath& path, const RobotModel& robot,
                                      std::span<const Node> nodes, double friction, double lag);

}  // namespace stairwright::smoothing
