#include "surprises.hpp"

#include <algorithm>
#include <cmath>

namespace stairwright::smoothing {

namespace {

constexpr double kEarlyFace = 0.06;    // m before its place that a face may come
constexpr double kUnsureClimb = 0.04;  // m that wheels with little load may climb on the map before they feel the face
constexpr double kOtherTread = 0.03;   // m below or above its place that a tread may lie
constexpr double kNearBottom = 0.01;   // m before and behind a drop's lower end that wheels may find it elsewhere
constexpr double kConfined = 0.02;     // m, of the CoM of a robot with legs of 0.4 m
constexpr double kLeastLevel = 0.99, kLeastSteep = 0.7;  // z of a tread's normal, x of a face's

// A face ahead, or one that a wheel begins to climb.
Surprise early_face(const WheelPath& path, double s) {
    const std::vector<double>& corners = path.corners();
    std::size_t k = path.corner_from(s);
    const bool climbs = path.normal(s).z < kLeastLevel;
    if (climbs && (k == 0 || s - corners[--k] > kUnsureClimb)) return {};
    if (k == corners.size() || -path.normal(corners[k] + kBeside).x < kLeastSteep) return {};
    return {Surprise::early_face, climbs ? 0.0 : std::min(path.centre(corners[k]).x - path.centre(s).x, kEarlyFace), {}};
}

// The tread below a face that a wheel has come down.
Surprise other_tread(const WheelPath& path, double s) {
    const std::vector<double>& corners = path.corners();
    const std::size_t k = path.corner_from(s - kNearBottom);
    if (k == corners.size() || corners[k] > s + kNearBottom || path.normal(corners[k] - kBeside).x < kLeastSteep) return {};
    Surprise out;
    for (const Piece& piece : path.pieces()) {
        if (piece.s > corners[k]) break;
        if (piece.arc) out = {Surprise::other_tread, 0.0, piece.origin};
    }
    return out;
}

// Distance of a link from the edge that it hangs over.
double edge_clearance(const Link& link, Vec2 begin, Vec2 end, Vec2 edge, double wanted) {
    const Turn turn = link_turn(link, end - begin);
    double least = wanted;
    for (const Capsule& c : link.shape)
        least = std::min(least, std::sqrt(point_segment_squared(edge, begin + turn * c.a, begin + turn * c.b)) - c.radius);
    return least;
}

}  // namespace

std::vector<std::array<Surprise, 2>> surprises(const RefineProblem& problem, std::span<const Node> nodes,
                                               std::span<const NodeIntervals> intervals) {
    std::vector<std::array<Surprise, 2>> out(nodes.size());
    const double confined = kConfined * problem.robot.scale();
    for (std::size_t node = 0; node < nodes.size(); ++node) {
        const Interval& com = intervals[node].full;
        if (com.upper - com.lower < confined) continue;
        for (const int pair : {kFront, kRear}) {
            const double s = nodes[node].s[pair];
            const Surprise below = other_tread(problem.path, s);
            out[node][pair] = below.kind == Surprise::none ? early_face(problem.path, s) : below;
        }
    }
    return out;
}

SurpriseClearances surprise_clearances(const SmoothingProblem& problem, std::size_t node, const Body& body, const Posture& posture) {
    const double wanted = problem.objective.surprised.target;
    SurpriseClearances out;
    out.fill(wanted);
    for (const int pair : {kFront, kRear}) {
        const Surprise& met = problem.surprises[node][pair];
        if (met.kind == Surprise::none) continue;
        const Leg& leg = problem.robot.legs[pair].leg;
        Vec2 hip = posture.legs[pair].hip, wheel = posture.legs[pair].wheel;
        double* of_pair = &out[3 * pair];
        if (met.kind == Surprise::other_tread) {
            for (const double lower : {-kOtherTread, kOtherTread}) {
                const Vec2 there = {wheel.x, wheel.z - lower}, knee = hip + knee_offset(leg, there - hip);
                of_pair[0] = std::min(of_pair[0], edge_clearance(leg.thigh, hip, knee, met.edge, wanted));
                of_pair[1] = std::min(of_pair[1], edge_clearance(leg.calf, knee, there, met.edge, wanted));
            }
            continue;
        }
        hip.x += kEarlyFace, wheel.x += met.gap;
        const LegPoints held = {hip, hip + knee_offset(leg, wheel - hip), wheel};
        for (const int link : {0, 1}) of_pair[link] = link_clearance(problem.terrain, leg, held, link, wanted);
        of_pair[2] = trunk_clearance(problem.terrain, problem.robot, {body.x + kEarlyFace, body.z, body.pitch}, wanted);
    }
    return out;
}

}  // namespace stairwright::smoothing
