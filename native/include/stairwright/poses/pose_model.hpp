// One pose of the optimisation: legs in closed form, and how every point of the robot moves.
//
// The joints are eliminated: unknown are y = (x, z, pitch, s_front, s_rear), with the wheels on the wheel-centre curve
// (eq 19) by construction. Points are the trunk's place plus vectors that each turn with one absolute angle (pitch,
// front thigh, front calf, rear thigh, rear calf); all turn about +y, where v' = (v_z, -v_x) and v'' = -v.
#pragma once

#include <array>
#include <vector>

#include "stairwright/poses/cells.hpp"
#include "stairwright/posture.hpp"
#include "stairwright/wheel_path.hpp"

namespace stairwright::poses {

inline constexpr int kUnknowns = 5;  // y
inline constexpr int kAngles = 5;    // absolute: pitch, front thigh, front calf, rear thigh, rear calf
inline constexpr int kU = kAngles + 4;  // u = (x, z, angles, s_front, s_rear), by which constraints are differentiated

using Unknowns = std::array<double, kUnknowns>;
using Joints = std::array<double, 4>;     // front thigh, front calf, rear thigh, rear calf
using Variables = std::array<double, 9>;  // x, z, pitch, joints, s_front, s_rear

Unknowns unknowns_of(const Variables& x);

// A point fixed to the trunk (frame 0) or to a link (frames 1 to 4: front thigh, front calf, rear thigh, rear calf).
struct PointSpec {
    int frame = 0;
    Vec2 at;
};

struct TrunkShape {
    int first = 0, count = 0;     // its corners among the points
    std::vector<Vec2> normals;    // of the edge from each corner, in the trunk's frame
};

struct LinkShape {
    int a = 0, b = 0;  // ends among the points
    int frame = 0;     // that it turns with
    Vec2 normal;       // across it, in that frame
    double radius = 0.0, length = 0.0;
};

// A point of a leg that is kept clear of the other leg.
struct LegNode {
    int point = 0;
    double radius = 0.0;
};

// The paper's collision points: on the trunk [m], and as shares of thigh and calf.
struct CollisionPoints {
    std::vector<Vec2> trunk;
    std::vector<double> thigh, calf;
};

// What all poses of one robot have in common.
struct PoseModel {
    PoseModel(const Robot& robot, const CollisionPoints& collision);

    RobotModel robot;
    std::vector<PointSpec> points;
    std::array<int, 2> hip{}, knee{}, wheel{};
    std::vector<TrunkShape> trunk;
    std::array<std::vector<LinkShape>, 2> links;
    std::array<std::vector<LegNode>, 2> nodes;
    int first_collision_point = 0, last_collision_point = 0;
    Joints standing{};  // of the nominal pose

  private:
    int add(int frame, Vec2 at);
};

struct PosePoint {
    Vec2 at;
    std::array<Vec2, kAngles> arms{};  // the part that turns with each angle
};

struct PoseState {
    explicit PoseState(const PoseModel& model) : points(model.points.size()) {}

    Unknowns y{};
    std::array<double, kAngles> angles{};
    std::array<Turn, kAngles> turns;
    Joints q{};
    std::vector<PosePoint> points;
    PosePoint com;  // centre of mass of the whole robot
    std::array<Vec2, 2> tangent;           // of the wheel-centre curve at the wheels
    std::array<double, 2> curvature{};     // of it
    double rear_contact = 0.0, rear_contact_slope = 0.0;  // x of the rear contact, and its derivative by s_rear
    std::array<std::array<double, kUnknowns>, 4> link_turns{};  // derivative of the four link angles by y
    std::array<bool, 2> reached{};         // whether the leg reaches its wheel

    Variables variables() const;
};

// Fill `state` for the unknowns; false where a leg cannot reach its wheel.
bool place(const PoseModel& model, const WheelPath& path, const Unknowns& y, PoseState& state);

// Set the joints of a placed state: those that reach, else `q`; a joint less than `rounding` beyond its limit is put
// onto it. Points move to where the joints put them.
void stand_on(const PoseModel& model, const Joints& q, double rounding, PoseState& state);

}  // namespace stairwright::poses
