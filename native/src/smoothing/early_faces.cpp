#include "early_faces.hpp"

#include <algorithm>

namespace stairwright::smoothing {

namespace {

constexpr double kEarlyFace = 0.06;  // m before its place that a face may come
constexpr double kConfined = 0.02;   // m, of the CoM of a robot with legs of 0.4 m
constexpr double kLeastLevel = 0.99, kLeastSteep = 0.7;  // z of a tread's normal, -x of a face's

}  // namespace

std::vector<std::array<double, 2>> early_faces(const RefineProblem& problem, std::span<const Node> nodes,
                                               std::span<const NodeIntervals> intervals) {
    std::vector<std::array<double, 2>> out(nodes.size());
    const double confined = kConfined * problem.robot.scale();
    const WheelPath& path = problem.path;
    for (std::size_t node = 0; node < nodes.size(); ++node) {
        const Interval& com = intervals[node].full;
        if (com.upper - com.lower < confined) continue;
        for (const int pair : {kFront, kRear}) {
            const double s = nodes[node].s[pair];
            const std::size_t k = path.corner_from(s);
            if (k == path.corners().size() || path.normal(s).z < kLeastLevel) continue;
            const double corner = path.corners()[k];
            if (-path.normal(corner + kBeside).x >= kLeastSteep)
                out[node][pair] = std::min(path.centre(corner).x - path.centre(s).x, kEarlyFace);
        }
    }
    return out;
}

EarlyClearances early_clearances(const SmoothingProblem& problem, std::size_t node, const Body& body, const Posture& posture) {
    const double wanted = problem.objective.early.target;
    EarlyClearances out;
    out.fill(wanted);
    for (const int pair : {kFront, kRear}) {
        const Vec2 nearer = {problem.early[node][pair], 0.0};
        if (nearer.x == 0.0) continue;
        const auto& [hip, knee, wheel] = posture.legs[pair];
        const LegPoints at = {hip + nearer, knee + nearer, wheel + nearer};
        const Leg& leg = problem.robot.legs[pair].leg;
        double* of_pair = &out[3 * pair];
        for (const int link : {0, 1}) of_pair[link] = link_clearance(problem.terrain, leg, at, link, wanted);
        of_pair[2] = trunk_clearance(problem.terrain, problem.robot, {body.x + nearer.x, body.z, body.pitch}, wanted);
    }
    return out;
}

}  // namespace stairwright::smoothing
