#include "stairwright/smoothing/objective.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "residuals.hpp"
#include "stairwright/smoothing/densify.hpp"
#include "stairwright/smoothing/resample.hpp"
#include "stairwright/whole.hpp"
#include "surprises.hpp"
#include "tipping.hpp"

namespace stairwright::smoothing {

namespace {

constexpr double kClearance = 0.016;  // m; clearance that is safe for legs of 0.4 m, and for shorter ones
constexpr double kTrunkClearance = 0.06;   // m of trunk clearance beyond which more is worth nothing, for legs of 0.4 m
// Of the cost terms at a user's weight of 1, per node.
constexpr double kComWeight = 15.0;     // 1/m
constexpr double kRoomWeight = 2.0;     // 1/m, of trunk and links
constexpr double kSurpriseWeight = 100.0;  // 1/m, of clearance where the ground is not as drawn; nobody weighs that
constexpr double kTorqueWeight = 0.3;
constexpr double kPitchWeight = 0.05;   // 1/rad
constexpr double kRateWeight = 20.0;    // 1/m^2, of the squared step from node to node
constexpr double kBend = 0.082;         // m; how much bends count against motion
constexpr double kHardWeight = 600.0;
constexpr double kFirmTorque = 0.12;  // share of a motor's torque that a path leaves, a little more than it must

// Clearance of a calf's end above level ground: more cannot be had on any.
double calf_end_clearance(const RobotModel& robot, double safe) {
    double out = std::numeric_limits<double>::infinity();
    for (const LegModel& leg : robot.legs)
        for (const Capsule& c : leg.leg.calf.shape) out = std::min(out, leg.leg.wheel.radius - c.radius);
    return std::max(out, safe);
}

template <typename Value>
double root_mean(std::span<const Residuals> rows, double weight, Value value) {
    double total = 0.0;
    for (const Residuals& r : rows) total += value(r);
    return std::sqrt(total / static_cast<double>(rows.size())) / std::max(weight, 1e-12);
}

double square(double x) { return x * x; }

}  // namespace

Objective objective(const RefineProblem& problem, const NodeSpacing& spacing, double share) {
    const double size = problem.robot.scale(), root = std::sqrt(share);
    const PathWeights& w = problem.weights;
    Objective o;
    o.com = {0.02, 100.0 * root};
    o.reserve = {0.02 * size, 50.0 * root};
    o.lagged = {0.06 * size, kComWeight * root * std::sqrt(w.com_margin)};
    const ExtraMargins& more = problem.extra;
    // A larger robot strays farther from its plan.
    const double large = std::max(1.0, size), safe = kClearance * large;
    o.trunk = MarginTerm{safe, 150.0 * root, 0.002 * large}.with(more.trunk);
    o.links = MarginTerm{safe, 150.0 * root, 0.004 * large}.with(more.links);
    o.reach = MarginTerm{0.006 * size, 150.0 * root, 0.0005}.with(more.reach);
    const double room = kRoomWeight * root * std::sqrt(w.clearance);
    o.trunk_room = MarginTerm{kTrunkClearance * size, room}.with(more.trunk);
    o.surprised = {safe, kSurpriseWeight * root};
    o.links_room = {calf_end_clearance(problem.robot, safe), room};
    o.torque_weight = kTorqueWeight * root * std::sqrt(w.torque);
    o.torque_room = {0.2, 8.0 * root, kFirmTorque};
    o.torque_hard = 100.0;
    o.hard = kHardWeight;
    o.legs = MarginTerm{0.011 * large, 150.0 * root, 0.007}.with(more.legs);
    o.joints = MarginTerm{0.05, 30.0 * root, 0.004}.with(more.joints);
    o.pitch_weight = kPitchWeight * root * std::sqrt(w.pitch);
    o.height_weight = 0.3 * root;
    o.height = problem.standing_height;
    const double bend = kBend / kUsualSpacing, even = kRateWeight * w.smoothness;
    o.evenness = {even / share, even * bend * bend * spacing.softness / (share * share * share), 0.25 * size};
    return o;
}

PathCost path_cost(const RefineProblem& problem, std::span<const Node> path) {
    const NodeSpacing spacing;
    const Column u = path_parameter(path, spacing.swing);
    const double step = kUsualSpacing * problem.robot.scale();
    const std::size_t count = std::max<std::size_t>(20, whole_part(u.back() / step));
    const std::vector<Node> nodes = resample(path, u, count);
    const std::vector<double> changes = contact_changes(problem.path, nodes);
    const std::vector<NodeIntervals> intervals =
        intervals_along(problem.path, nodes, changes, problem.friction, problem.reserve, problem.lag);
    const auto [wheels, contacts, slopes, bodies] = geometry_along(problem.path, nodes);
    const double share = u.back() / static_cast<double>(count - 1) / kUsualSpacing;
    const Objective o = objective(problem, spacing, share);
    const std::vector<std::array<Surprise, 2>> met = surprises(problem, nodes, intervals);
    const std::vector<TippingBounds> tipping = tipping_bounds(problem, nodes, intervals);
    const SmoothingProblem at{problem.terrain, problem.robot, wheels, contacts, slopes, intervals, {}, met, tipping, {}, o};
    std::vector<Residuals> rows;
    PathCost out;
    for (std::size_t k = 0; k < count; ++k) {
        const PoseGeometry geometry = pose_geometry(problem.terrain, problem.robot, bodies[k], wheels[k], query_radii(o));
        rows.push_back(residuals(at, k, bodies[k], geometry, surprise_clearances(at, k, bodies[k], geometry.posture)));
        for (const double r : rows.back()) out.total += r * r;
    }
    std::vector<double> gradient(3 * count);
    const double uneven = o.evenness.cost(bodies, gradient);
    out.total += uneven;
    CostTerms& terms = out.terms;
    terms.com_margin = root_mean(rows, o.lagged.weight, [](const Residuals& r) { return square(r[kLaggedLow]) + square(r[kLaggedHigh]); });
    terms.clearance = root_mean(rows, o.trunk_room.weight, [](const Residuals& r) { return square(r[kTrunkRoom]) + square(r[kLinksRoom]); });
    terms.torque = root_mean(rows, 2.0 * o.torque_weight, [](const Residuals& r) {
        return square(r[kFrontThigh]) + square(r[kFrontCalf]) + square(r[kRearThigh]) + square(r[kRearCalf]);
    });
    terms.pitch = root_mean(rows, o.pitch_weight, [](const Residuals& r) { return square(r[kPitch]); });
    terms.smoothness = std::sqrt(uneven / static_cast<double>(count) / (o.evenness.rate * share * share)) / kUsualSpacing;
    return out;
}

}  // namespace stairwright::smoothing
