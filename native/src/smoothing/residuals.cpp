#include "residuals.hpp"

#include <algorithm>
#include <cmath>

namespace stairwright::smoothing {

namespace {

constexpr double kHard = 600.0;  // weight of what must not be violated
constexpr double kStep = 1e-5;   // m and rad; of finite differences

// Pull towards the term's target, and hard away from less than `least`.
double hinge(double value, const MarginTerm& term, double least) {
    return term.weight * std::max(0.0, term.target - value) + kHard * std::max(0.0, least - value);
}

// Both sides of one CoM interval.
void com_residuals(double x, const Interval& interval, const MarginTerm& term, bool hard, double* out) {
    // A narrow interval cannot give the target on both sides: aim at its middle.
    const double target = std::min(term.target, 0.45 * std::max(0.0, interval.upper - interval.lower));
    const double below = x - interval.lower, above = interval.upper - x;
    out[0] = term.weight * std::max(0.0, target - below);
    out[1] = term.weight * std::max(0.0, target - above);
    if (hard) {
        out[0] += kHard * std::max(0.0, 0.25 * target - below);
        out[1] += kHard * std::max(0.0, 0.25 * target - above);
    }
}

}  // namespace

double query_radius(const Objective& objective) { return std::max(objective.trunk.target, objective.links.target); }

Residuals residuals(const SmoothingProblem& problem, std::size_t node, const Body& body, const PoseGeometry& geometry) {
    const Objective& o = problem.objective;
    const NodeIntervals& interval = problem.intervals[node];
    const double x = geometry.posture.com.x;
    Residuals r;
    com_residuals(x, interval.full, o.com, true, &r[kComLow]);
    com_residuals(x, interval.reserve, o.reserve, false, &r[kReserveLow]);
    com_residuals(x, interval.lagged, o.lagged, false, &r[kLaggedLow]);
    r[kTrunk] = hinge(geometry.trunk, o.trunk, 0.002);
    r[kLinks] = hinge(geometry.links, o.links, 0.004);
    r[kLegs] = hinge(geometry.legs, o.legs, 0.007);
    r[kJoints] = hinge(geometry.joints.slack, o.joints, 0.004);
    r[kReach] = hinge(geometry.posture.reach_slack, o.reach, 0.0005);
    const auto& [front, rear] = problem.wheels[node];
    const double slope = std::atan2(front.z - rear.z, front.x - rear.x);
    r[kPitch] = (body.pitch + o.slope_share * slope) * o.pitch_weight;
    r[kHeight] = (body.z - 0.5 * (front.z + rear.z) - o.height) * o.height_weight;
    return r;
}

NodeJacobian differentiate(const SmoothingProblem& problem, std::size_t node, const Body& body,
                           const PoseGeometry& geometry, const Residuals& at) {
    constexpr std::array<double Body::*, 3> axes = {&Body::x, &Body::z, &Body::pitch};
    const double query = query_radius(problem.objective);
    NodeJacobian out;
    PoseGeometry moved = geometry;
    for (std::size_t a = 0; a < 3; ++a) {
        Body x = body;
        x.*axes[a] += kStep;
        moved.posture = make_posture(problem.robot, x, problem.wheels[node]);
        // What is far enough from its limits stays so; most of the time goes here.
        if (at[kJoints] > 0.0) moved.joints = pose_joints(problem.robot, x.pitch, moved.posture);
        if (at[kTrunk] > 0.0) moved.trunk = trunk_clearance(problem.terrain, problem.robot, x, query);
        if (at[kLinks] > 0.0) moved.links = links_clearance(problem.terrain, problem.robot, moved.posture, query);
        if (at[kLegs] > 0.0) moved.legs = legs_distance(problem.robot, moved.posture.legs);
        const Residuals r = residuals(problem, node, x, moved);
        for (int m = 0; m < kResiduals; ++m) out[a][m] = (r[m] - at[m]) * (1.0 / kStep);
    }
    return out;
}

Residuals extrapolate(const Residuals& at, const NodeJacobian& jacobian, const Body& from, const Body& to) {
    const double x = to.x - from.x, z = to.z - from.z, pitch = to.pitch - from.pitch;
    Residuals r;
    for (int m = 0; m < kResiduals; ++m) r[m] = at[m] + jacobian[0][m] * x + jacobian[1][m] * z + jacobian[2][m] * pitch;
    for (int m = 0; m < kHinges; ++m) r[m] = std::max(0.0, r[m]);
    return r;
}

}  // namespace stairwright::smoothing
