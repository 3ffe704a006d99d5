#include "residuals.hpp"

#include <algorithm>
#include <cmath>

#include "tipping.hpp"

namespace stairwright::smoothing {

namespace {

constexpr double kStep = 1e-5;   // m and rad; of finite differences

double shortfall(double value, const MarginTerm& term) { return term.weight * std::max(0.0, term.target - value); }

// Pull towards the term's target, and hard away from less than its least.
double hinge(double value, const MarginTerm& term, double hard) {
    return term.weight * std::max(0.0, term.target - value) + hard * std::max(0.0, term.least - value);
}

// Both sides of one CoM interval, which must leave `least` beside them.
void com_residuals(double x, const Interval& interval, const MarginTerm& term, double hard, double* out,
                   const std::array<double, 2>& least = {}) {
    // A narrow interval cannot give the target on both sides: aim at its middle.
    const double target = std::min(term.target, 0.45 * std::max(0.0, interval.upper - interval.lower));
    const double below = x - interval.lower, above = interval.upper - x;
    out[0] = term.weight * std::max(0.0, target - below);
    out[1] = term.weight * std::max(0.0, target - above);
    out[0] += hard * std::max(0.0, std::max(0.25 * target, least[0]) - below);
    out[1] += hard * std::max(0.0, std::max(0.25 * target, least[1]) - above);
}

// Static torques of the leg joints over their limits, front thigh, front calf, rear thigh, rear calf. Each wheel pair
// carries its share of the weight by its lever: the gentlest forces take a hundred times as long and differ on walls only.
void torque_residuals(const SmoothingProblem& problem, std::size_t node, const Posture& posture, double* out) {
    const auto& [front, rear] = problem.contacts[node];
    const double lever = std::max(front.x - rear.x, 0.05);
    const double share = std::clamp((posture.com.x - rear.x) / lever, 0.0, 1.0);
    const double half_weight = 0.5 * problem.robot.mass * kGravity, weight = problem.objective.torque_weight;
    for (const int pair : {kFront, kRear}) {
        const Leg& leg = problem.robot.legs[pair].leg;
        const Contact contact{problem.contacts[node][pair], {0.0, 1.0}};
        const ContactForce force{0.0, half_weight * (pair == kFront ? share : 1.0 - share)};
        const LegTorques torques = static_torques(leg, posture.legs[pair], contact, force);
        *out++ = weight * torques.thigh / leg.thigh_motor.torque;
        *out++ = weight * torques.calf / leg.calf_motor.torque;
    }
}

// How far static torques are above what motors shall hold, by front thigh, calf, wheel, then rear.
void torque_limit_residuals(const SmoothingProblem& problem, std::size_t node, const Posture& posture, double* out) {
    const MarginTerm& term = problem.objective.torque_room;
    std::fill(out, out + 6, 0.0);
    std::array<LegLevers, 2> levers;
    for (const int pair : {kFront, kRear}) levers[pair] = leg_levers(problem.robot.legs[pair].leg, posture.legs[pair]);
    for (const WheelLoads& loads : problem.loads[node]) {
        for (int way = 0; way < loads.ways(); ++way) {
            const auto load = loads.at(way, posture.com.x);
            if (!load) continue;
            for (const int pair : {kFront, kRear}) {
                const Leg& leg = problem.robot.legs[pair].leg;
                const LegTorques torques = static_torques(levers[pair], (*load)[pair]);
                const auto lacking = [&](double torque, const Motor& motor) {
                    return hinge(1.0 - std::abs(torque) / motor.torque, term, problem.objective.torque_hard);
                };
                double* of_leg = out + 3 * pair;
                of_leg[0] = std::max(of_leg[0], lacking(torques.thigh, leg.thigh_motor));
                of_leg[1] = std::max(of_leg[1], lacking(torques.calf, leg.calf_motor));
                of_leg[2] = std::max(of_leg[2], lacking(torques.wheel, leg.wheel_motor));
            }
        }
    }
}

}  // namespace

QueryRadii query_radii(const Objective& o) {
    return {std::max(o.trunk.target, o.trunk_room.target), std::max(o.links.target, o.links_room.target),
            std::max(o.legs.target, o.legs.least)};
}

Residuals residuals(const SmoothingProblem& problem, std::size_t node, const Body& body, const PoseGeometry& geometry,
                    const SurpriseClearances& surprised) {
    const Objective& o = problem.objective;
    const NodeIntervals& interval = problem.intervals[node];
    const double x = geometry.posture.com.x;
    Residuals r;
    com_residuals(x, interval.full, o.com, o.hard, &r[kComLow],
                  least_com_margins(problem.robot, problem.tipping[node], geometry.posture.com.z));
    com_residuals(x, interval.reserve, o.reserve, 0.0, &r[kReserveLow]);
    com_residuals(x, interval.lagged, o.lagged, 0.0, &r[kLaggedLow]);
    r[kTrunk] = hinge(geometry.trunk, o.trunk, o.hard);
    r[kLinks] = hinge(geometry.links, o.links, o.hard);
    r[kLegs] = hinge(geometry.legs, o.legs, o.hard);
    r[kJoints] = hinge(geometry.joints.slack, o.joints, o.hard);
    r[kReach] = hinge(geometry.posture.reach_slack, o.reach, o.hard);
    r[kTrunkRoom] = shortfall(geometry.trunk, o.trunk_room);
    r[kLinksRoom] = shortfall(geometry.links, o.links_room);
    for (std::size_t k = 0; k < surprised.size(); ++k) r[kSurprisedFrontThigh + k] = shortfall(surprised[k], o.surprised);
    const auto& [front, rear] = problem.wheels[node];
    r[kPitch] = (body.pitch + o.slope_share * problem.slopes[node]) * o.pitch_weight;
    r[kHeight] = (body.z - 0.5 * (front.z + rear.z) - o.height) * o.height_weight;
    torque_residuals(problem, node, geometry.posture, &r[kFrontThigh]);
    if (problem.loads.empty())
        std::fill(&r[kFrontThighLimit], &r[kPitch], 0.0);
    else
        torque_limit_residuals(problem, node, geometry.posture, &r[kFrontThighLimit]);
    return r;
}

NodeJacobian differentiate(const SmoothingProblem& problem, std::size_t node, const Body& body,
                           const PoseGeometry& geometry, const Residuals& at) {
    constexpr std::array<double Body::*, 3> axes = {&Body::x, &Body::z, &Body::pitch};
    const QueryRadii radii = query_radii(problem.objective);
    NodeJacobian out;
    PoseGeometry moved = geometry;
    SurpriseClearances surprised;
    surprised.fill(problem.objective.surprised.target);
    const auto* lacks = &at[kSurprisedFrontThigh];
    const bool pressed = std::any_of(lacks, lacks + surprised.size(), [](double r) { return r > 0.0; });
    for (std::size_t a = 0; a < 3; ++a) {
        Body x = body;
        x.*axes[a] += kStep;
        moved.posture = make_posture(problem.robot, x, problem.wheels[node]);
        // What is far enough from its limits stays so; most of the time goes here.
        if (at[kJoints] > 0.0) moved.joints = pose_joints(problem.robot, x.pitch, moved.posture);
        if (at[kTrunk] > 0.0 || at[kTrunkRoom] > 0.0) moved.trunk = trunk_clearance(problem.terrain, problem.robot, x, radii.trunk);
        if (at[kLinks] > 0.0 || at[kLinksRoom] > 0.0) 
            moved.links = links_clearance(problem.terrain, problem.robot, moved.posture, radii.links, geometry.by_link);
        if (at[kLegs] > 0.0) moved.legs = legs_distance(problem.robot, moved.posture.legs);
        if (pressed) surprised = surprise_clearances(problem, node, x, moved.posture);
        const Residuals r = residuals(problem, node, x, moved, surprised);
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
