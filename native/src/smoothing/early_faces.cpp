#include "early_faces.hpp"

#include <algorithm>

namespace stairwright::smoothing {

namespace {

constexpr double kEarlyFace = 0.06;  // m before its place that a face may come
constexpr double kUnsureClimb = 0.04;  // m that wheels with little load may climb on the map before they feel the face
constexpr double kFelt = -1.0;       // no next face, or one that is felt
constexpr double kConfined = 0.02;   // m, of the CoM of a robot with legs of 0.4 m
constexpr double kLeastLevel = 0.99, kLeastSteep = 0.7;  // z of a tread's normal, -x of a face's

// How far a wheel is from the next face, at most kEarlyFace, and 0 where it begins to climb it [m]; or kFelt.
double gap_before_face(const WheelPath& path, double s) {
    const std::vector<double>& corners = path.corners();
    std::size_t k = path.corner_from(s);
    const bool climbs = path.normal(s).z < kLeastLevel;
    if (climbs && (k == 0 || s - corners[--k] > kUnsureClimb)) return kFelt;
    if (k == corners.size() || -path.normal(corners[k] + kBeside).x < kLeastSteep) return kFelt;
    return climbs ? 0.0 : std::min(path.centre(corners[k]).x - path.centre(s).x, kEarlyFace);
}

}  // namespace

std::vector<std::array<double, 2>> early_faces(const RefineProblem& problem, std::span<const Node> nodes,
                                               std::span<const NodeIntervals> intervals) {
    std::vector<std::array<double, 2>> out(nodes.size(), {kFelt, kFelt});
    const double confined = kConfined * problem.robot.scale();
    const WheelPath& path = problem.path;
    for (std::size_t node = 0; node < nodes.size(); ++node) {
        const Interval& com = intervals[node].full;
        if (com.upper - com.lower < confined) continue;
        for (const int pair : {kFront, kRear}) out[node][pair] = gap_before_face(path, nodes[node].s[pair]);
    }
    return out;
}

EarlyClearances early_clearances(const SmoothingProblem& problem, std::size_t node, const Body& body, const Posture& posture) {
    const double wanted = problem.objective.early.target;
    EarlyClearances out;
    out.fill(wanted);
    for (const int pair : {kFront, kRear}) {
        const double gap = problem.early[node][pair];
        if (gap == kFelt) continue;
        const Vec2 nearer = {kEarlyFace, 0.0};
        const Vec2 hip = posture.legs[pair].hip, wheel = posture.legs[pair].wheel;
        const Leg& leg = problem.robot.legs[pair].leg;
        const Vec2 held_hip = hip + nearer, held_wheel = wheel + Vec2{gap, 0.0};
        const LegPoints at = {held_hip, held_hip + knee_offset(leg, held_wheel - held_hip), held_wheel};
        double* of_pair = &out[3 * pair];
        for (const int link : {0, 1}) of_pair[link] = link_clearance(problem.terrain, leg, at, link, wanted);
        of_pair[2] = trunk_clearance(problem.terrain, problem.robot, {body.x + nearer.x, body.z, body.pitch}, wanted);
    }
    return out;
}

}  // namespace stairwright::smoothing
