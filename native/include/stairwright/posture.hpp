// One pose of the robot, and the margins that need no forces: clearances, joint ranges, reach.
#pragma once

#include <array>
#include <limits>

#include "stairwright/kinematics.hpp"
#include "stairwright/terrain.hpp"

namespace stairwright {

inline constexpr double kLegsGap = 0.005;  // m; front and rear leg stay this far apart

// A leg with what planning derives from it once.
struct LegModel {
    Leg leg;           // its thigh's range is what the other leg's hip leaves of it
    ReachRange reach;  // distances from hip to wheel that the calf's range allows [m]
    double girth = 0.0;  // farthest that its links reach from the lines between its joints [m]
};

struct RobotModel {
    explicit RobotModel(const Robot& robot);

    Robot robot;
    std::array<LegModel, 2> legs;
    double mass = 0.0;  // kg

    // Size of the legs against those that lengths in the planner were chosen with (0.4 m).
    double scale() const;
    // Distance of the wheels' centres that no pose of the trunk exceeds [m].
    double most_wheel_distance() const;
    // Whether front and rear leg have the same links, knee side, motors and reach.
    bool legs_alike() const;
};

using WheelCentres = std::array<Vec2, 2>;

// Points of a pose in the world [m], and its CoM.
struct Posture {
    std::array<LegPoints, 2> legs;
    Vec2 com;
    double reach_slack = 0.0;  // least slack of the hip-wheel distances [m]
};
Posture make_posture(const RobotModel& robot, const Body& body, const WheelCentres& wheels);

struct PoseJoints {
    std::array<JointAngles, 2> q;
    double slack = 0.0;  // least distance from a joint limit [rad]; negative outside
};
PoseJoints pose_joints(const RobotModel& robot, double pitch, const Posture& posture);

// Clearances [m]; beyond `query_radius` they are not told apart.
double trunk_clearance(const Terrain& terrain, const RobotModel& robot, const Body& body, double query_radius);
// By pair: of thigh and calf [m].
using LinkClearances = std::array<std::array<double, 2>, 2>;
// A link that is so much farther from the ground than the nearest is left out where only the nearest counts.
inline constexpr double kNearlyNearest = 1e-3;  // m
// Of a thigh (0) or a calf (1).
double link_clearance(const Terrain& terrain, const Leg& leg, const LegPoints& at, int link, double query_radius);
// Of each link, exact for those that are nearly as near as the nearest; of others no more than that they are not.
LinkClearances link_clearances(const Terrain& terrain, const RobotModel& robot, const Posture& posture, double query_radius);
// Of one leg.
double leg_clearance(const Terrain& terrain, const Leg& leg, const LegPoints& at, double query_radius);
// Least clearance after a tiny motion from where the clearances were `before`.
double links_clearance(const Terrain& terrain, const RobotModel& robot, const Posture& posture, double query_radius,
                       const LinkClearances& before);
// Distance of the front from the rear leg in one plane: thighs, calves, wheels; negative if they touch. What is seen at
// a glance to be more than `query_radius` is not told apart.
double legs_distance(const RobotModel& robot, const std::array<LegPoints, 2>& legs,
                     double query_radius = std::numeric_limits<double>::infinity());

// Clearances beyond these are not told apart [m].
struct QueryRadii {
    double trunk = 0.0, links = 0.0, legs = std::numeric_limits<double>::infinity();
};

// Everything of one pose that needs no forces.
struct PoseGeometry {
    Posture posture;
    PoseJoints joints;
    double trunk = 0.0, links = 0.0, legs = 0.0;  // clearances [m]
    LinkClearances by_link{};                     // of the links, see link_clearances
};
PoseGeometry pose_geometry(const Terrain& terrain, const RobotModel& robot, const Body& body,
                           const WheelCentres& wheels, QueryRadii radii);

}  // namespace stairwright
