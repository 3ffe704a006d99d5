#include "stairwright/smoothing/densify.hpp"

#include <algorithm>
#include <cmath>

#include "stairwright/whole.hpp"

namespace stairwright::smoothing {

namespace {

constexpr double kMiss = 0.0006;  // m; largest distance of an interpolated wheel from its curve
constexpr int kPasses = 10;
constexpr double kEitherSide = 1e-6;  // m; along the curve, there a corner's faces are told apart

// The node at a fractional node number.
Node interpolate(std::span<const Node> nodes, double at) {
    const auto k = whole_part(at, nodes.size() - 1);
    const double share = at - static_cast<double>(k);
    return share <= 0.0 || k + 1 >= nodes.size() ? nodes[k] : between(nodes[k], nodes[k + 1], share);
}

JointAngles joints_of(const Leg& leg, const Body& body, Vec2 wheel) {
    const LegPoints p = place_leg(leg, body, Turn::by(body.pitch), wheel);
    return joint_angles(leg, body.pitch, p.knee - p.hip, p.wheel - p.hip);
}

// Largest distance of a wheel from its curve when trunk and joints move linearly from `a` to `b`.
double miss(const WheelPath& path, const RobotModel& robot, int pair, const Node& a, const Node& b) {
    const Leg& leg = robot.legs[pair].leg;
    const double s0 = a.s[pair], s1 = b.s[pair];
    const JointAngles q0 = joints_of(leg, a.body, path.centre(s0));
    const JointAngles q1 = joints_of(leg, b.body, path.centre(s1));
    double worst = 0.0;
    for (const double share : {0.25, 0.5, 0.75}) {
        const JointAngles q = {between(q0.thigh, q1.thigh, share), between(q0.calf, q1.calf, share)};
        const Vec2 wheel = forward(leg, between(a.body, b.body, share), q).wheel;
        const double s = between(s0, s1, share);
        // What counts is the gap to the terrain, in a corner to both faces; along the curve some slack does no harm.
        const Vec2 off = wheel - path.centre(s);
        worst = std::max({worst, std::abs(dot(off, path.normal(s - kEitherSide))), std::abs(dot(off, path.normal(s + kEitherSide))),
                          0.25 * norm(off)});
    }
    return worst;
}

// Arc lengths at which what a wheel touches changes.
std::vector<double> contact_marks(const WheelPath& path) {
    std::vector<double> out;
    for (std::size_t k = 1; k < path.pieces().size(); ++k) out.push_back(path.pieces()[k].s);
    for (const double offset : {-kBeside, 0.0, kBeside})
        for (const double corner : path.corners()) out.push_back(corner + offset);
    return out;
}

}  // namespace

NodeGeometry geometry_along(const WheelPath& path, std::span<const Node> nodes) {
    NodeGeometry out;
    for (const auto& [s, body] : nodes) {
        out.wheels.push_back({path.centre(s.front), path.centre(s.rear)});
        out.contacts.push_back({path.contact(s.front), path.contact(s.rear)});
        out.bodies.push_back(body);
        const Vec2 line = out.wheels.back()[kFront] - out.wheels.back()[kRear];
        out.slopes.push_back(std::atan2(line.z, line.x));
    }
    return out;
}

std::vector<double> contact_changes(const WheelPath& path, std::span<const Node> nodes) {
    std::vector<double> marks = contact_marks(path), out;
    std::sort(marks.begin(), marks.end());
    for (const int pair : {kFront, kRear}) {
        for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
            const double a = nodes[k].s[pair], b = nodes[k + 1].s[pair];
            const double low = std::min(a, b), high = std::max(a, b);
            for (auto mark = std::upper_bound(marks.begin(), marks.end(), low); mark != marks.end() && *mark < high; ++mark)
                out.push_back(static_cast<double>(k) + (*mark - a) / (b - a));
        }
    }
    return out;
}

std::vector<Node> densify(const WheelPath& path, const RobotModel& robot, std::span<const Node> nodes,
                          std::span<const double> changes) {
    std::vector<double> at(changes.begin(), changes.end());
    for (std::size_t k = 0; k < nodes.size(); ++k) at.push_back(static_cast<double>(k));
    std::sort(at.begin(), at.end());
    at.erase(std::unique(at.begin(), at.end()), at.end());
    // Of places that are nearly the same the last counts, as its distance from the one before is what is looked at.
    std::vector<double> kept = {at.front()};
    for (std::size_t k = 1; k < at.size(); ++k)
        if (at[k] - at[k - 1] > 1e-6) kept.push_back(at[k]);
    std::vector<Node> dense;
    for (const double u : kept) dense.push_back(interpolate(nodes, u));
    for (int pass = 0; pass < kPasses; ++pass) {
        std::vector<double> finer_at = {kept.front()};
        std::vector<Node> finer = {dense.front()};
        for (std::size_t k = 1; k < kept.size(); ++k) {
            const double worst = std::max(miss(path, robot, kFront, dense[k - 1], dense[k]),
                                          miss(path, robot, kRear, dense[k - 1], dense[k]));
            if (worst > kMiss) {
                finer_at.push_back(0.5 * (kept[k - 1] + kept[k]));
                finer.push_back(interpolate(nodes, finer_at.back()));
            }
            finer_at.push_back(kept[k]);
            finer.push_back(dense[k]);
        }
        // After the last pass the halves that it would add are left out.
        if (finer.size() == dense.size() || pass + 1 == kPasses) break;
        kept = std::move(finer_at), dense = std::move(finer);
    }
    return dense;
}

std::vector<NodeIntervals> intervals_along(const WheelPath& path, std::span<const Node> nodes,
                                           std::span<const double> changes, double friction, double reserve, double lag) {
    std::vector<NodeIntervals> out;
    for (const Node& node : nodes) out.push_back(node_intervals(path, node.s, friction, reserve, lag));
    const auto keep = [](Interval& mine, const Interval& other) { mine = mine.intersect(other); };
    for (const double at : changes) {
        const NodeIntervals there = node_intervals(path, interpolate(nodes, at).s, friction, reserve, lag);
        for (const double k : {std::floor(at), std::ceil(at)}) {
            NodeIntervals& node = out[whole_part(k, nodes.size() - 1)];
            keep(node.full, there.full);
            keep(node.reserve, there.reserve);
            keep(node.lagged, there.lagged);
        }
    }
    return out;
}

std::vector<std::vector<WheelLoads>> loads_along(const WheelPath& path, std::span<const Node> nodes, std::span<const double> changes,
                                                 double friction, double lag, double weight) {
    std::vector<std::vector<WheelLoads>> out(nodes.size());
    const auto loads = [&](WheelPlaces s) { return WheelLoads(path, s, friction, lag, pair_interval(path, s, friction), weight); };
    for (std::size_t k = 0; k < nodes.size(); ++k) out[k].push_back(loads(nodes[k].s));
    for (const double at : changes) {
        const WheelLoads there = loads(interpolate(nodes, at).s);
        const std::size_t before = whole_part(at, nodes.size() - 1);
        for (const std::size_t k : {before, std::min(before + 1, nodes.size() - 1)}) out[k].push_back(there);
    }
    return out;
}

}  // namespace stairwright::smoothing
