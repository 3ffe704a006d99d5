#include "stairwright/certificate/postures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sparing.hpp"

namespace stairwright::certificate {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kBelow = -1.0;  // m; what is below the ground is said to be so far from it

// A leg's angle is 0 where it points down, and grows as it swings backward.
Vec2 along(double angle) { return {-std::sin(angle), -std::cos(angle)}; }

Posture posture_of(const Robot& robot, const Pose& pose) {
    Posture out{pose.trunk, Turn::by(pose.pitch), {}};
    for (std::size_t pair = 0; pair < 2; ++pair) {
        const Leg& leg = robot.legs[pair];
        const double thigh = pose.pitch + pose.joints[2 * pair], calf = thigh + pose.joints[2 * pair + 1];
        const Vec2 hip = out.trunk + out.turn * leg.hip, knee = hip + leg.thigh.length * along(thigh);
        out.joints[kHip][pair] = hip, out.joints[kKnee][pair] = knee;
        out.joints[kWheel][pair] = knee + leg.calf.length * along(calf);
    }
    return out;
}

double trunk_reach(const Robot& robot) {
    double most = 0.0;
    for (const std::vector<Vec2>& piece : robot.trunk)
        for (const Vec2 corner : piece) most = std::max(most, norm(corner));
    return most;
}

// The most that a joint or a point of the trunk moves.
double step(const Posture& from, const Posture& to, double turned, double reach) {
    double most = norm(to.trunk - from.trunk) + reach * std::abs(turned);
    for (std::size_t joint : {kHip, kKnee, kWheel})
        for (std::size_t pair = 0; pair < 2; ++pair)
            most = std::max(most, norm(to.joints[joint][pair] - from.joints[joint][pair]));
    return most;
}

// A link in the world, between its joints.
struct Placed {
    const Link& link;
    Vec2 upper, down, ahead;

    Placed(const Link& link, Vec2 upper, Vec2 lower)
        : link(link), upper(upper), down((1.0 / link.length) * (lower - upper)), ahead{-down.z, down.x} {}
    Vec2 place(Vec2 p) const { return upper + p.x * ahead - p.z * down; }
    Segment axis(const Link::Capsule& capsule) const { return {place(capsule.begin), place(capsule.end)}; }
};

// Calf and thigh of a pair: what is lower is near to the ground more often.
std::array<Placed, 2> links_of(const Robot& robot, const Posture& at, std::size_t pair) {
    const Vec2 hip = at.joints[kHip][pair], knee = at.joints[kKnee][pair], wheel = at.joints[kWheel][pair];
    return {Placed(robot.legs[pair].calf, knee, wheel), Placed(robot.legs[pair].thigh, hip, knee)};
}

// Capsules of all links: how far their ends are from the upper joint, and how many times as far as the joints they may
// move. An end at upper + a d + c (d turned by a right angle), where d leads to the lower joint, moves no more than
// |1 - a| + |a| + 2 |c| times as far as that joint which moves more.
struct Extent {
    double reach = 0.0, stretch = 1.0;

    explicit Extent(const Robot& robot) {
        for (const Leg& leg : robot.legs)
            for (const Link* link : {&leg.thigh, &leg.calf})
                for (const Link::Capsule& capsule : link->capsules)
                    for (const Vec2 end : {capsule.begin, capsule.end}) {
                        const double a = -end.z / link->length, c = end.x / link->length;
                        reach = std::max(reach, norm(end));
                        stretch = std::max(stretch, std::abs(1.0 - a) + std::abs(a) + 2.0 * std::abs(c));
                    }
    }
};

// A capsule in the world, or a wheel: its axis has no length.
struct Round {
    Segment axis;
    double radius;
    Box box;

    Round(const Segment& axis, double radius) : axis(axis), radius(radius), box(box_of(axis)) {}
};

std::vector<Round> rounds_of(const Robot& robot, const Posture& at, std::size_t pair) {
    const Vec2 wheel = at.joints[kWheel][pair];
    std::vector<Round> out(1, Round({wheel, wheel}, robot.wheel_radius));
    for (const Placed& link : links_of(robot, at, pair))
        for (const Link::Capsule& capsule : link.link.capsules) out.emplace_back(link.axis(capsule), capsule.radius);
    return out;
}

Vec2 com_of(const Robot& robot, const Posture& at) {
    double mass = robot.trunk_mass;
    Vec2 sum = mass * (at.trunk + at.turn * robot.trunk_com);
    for (std::size_t pair = 0; pair < 2; ++pair) {
        const double wheels = 2.0 * robot.legs[pair].wheel_mass;
        mass += wheels, sum += wheels * at.joints[kWheel][pair];
        for (const Placed& each : links_of(robot, at, pair)) {
            const double links = 2.0 * each.link.mass;
            mass += links, sum += links * each.place(each.link.com);
        }
    }
    return (1.0 / mass) * sum;
}

}  // namespace

Postures::Postures(Robot robot, std::span<const Pose> poses) : robot_(std::move(robot)) {
    const double reach = trunk_reach(robot_);
    postures_.reserve(poses.size()), way_.reserve(poses.size());
    for (std::size_t k = 0; k < poses.size(); ++k) {
        postures_.push_back(posture_of(robot_, poses[k]));
        if (k == 0)
            way_.push_back(0.0);
        else
            way_.push_back(way_.back() + step(postures_[k - 1], postures_[k], poses[k].pitch - poses[k - 1].pitch, reach));
    }
}

std::vector<Vec2> Postures::com() const {
    std::vector<Vec2> out;
    out.reserve(postures_.size());
    for (const Posture& at : postures_) out.push_back(com_of(robot_, at));
    return out;
}

std::vector<double> Postures::trunk(const Ground& ground, std::span<const double> slack) const {
    std::vector<Vec2> middles, corners;
    for (const std::vector<Vec2>& piece : robot_.trunk) {
        Vec2& middle = middles.emplace_back();
        for (const Vec2 corner : piece) middle += (1.0 / static_cast<double>(piece.size())) * corner;
    }
    const auto exact = [&](std::size_t k) {
        const auto place = [&at = postures_[k]](Vec2 p) { return at.trunk + at.turn * p; };
        double least = kInfinity;
        for (std::size_t i = 0; i < middles.size(); ++i) {
            corners.clear();
            for (const Vec2 corner : robot_.trunk[i]) corners.push_back(place(corner));
            const double enough = std::max(0.0, least);
            least = std::min(least, ground.above(place(middles[i])) ? ground.distance(corners, enough) : kBelow);
        }
        return least;
    };
    const auto inside = [&, reach = trunk_reach(robot_)](std::size_t k) { return ground.spans(postures_[k].trunk, reach); };
    return sparing_distances(slack, exact, [&](std::size_t j, std::size_t k) {
        return inside(j) && inside(k) ? std::abs(way_[k] - way_[j]) : kInfinity;
    });
}

std::vector<double> Postures::links(const Ground& ground, std::span<const double> slack) const {
    const auto exact = [&](std::size_t k) {
        double least = kInfinity;
        for (std::size_t pair = 0; pair < 2; ++pair)
            for (const Placed& link : links_of(robot_, postures_[k], pair))
                for (const Link::Capsule& capsule : link.link.capsules) {
                    const auto [begin, end] = link.axis(capsule);
                    const double enough = std::max(0.0, least + capsule.radius);
                    const double distance = ground.above(begin) ? ground.distance(std::array{begin, end}, enough) : kBelow;
                    least = std::min(least, distance - capsule.radius);
                }
        return least;
    };
    const Extent extent(robot_);
    const auto inside = [&](std::size_t k) {
        const auto& [hips, knees, _] = postures_[k].joints;
        const auto spans = [&](Vec2 joint) { return ground.spans(joint, extent.reach); };
        return spans(hips[0]) && spans(hips[1]) && spans(knees[0]) && spans(knees[1]);
    };
    return sparing_distances(slack, exact, [&](std::size_t j, std::size_t k) {
        return inside(j) && inside(k) ? extent.stretch * std::abs(way_[k] - way_[j]) : kInfinity;
    });
}

std::vector<double> Postures::rims(std::size_t pair, const Ground& ground) const {
    std::vector<double> out;
    out.reserve(postures_.size());
    for (const Posture& at : postures_) {
        const Vec2 centre = at.joints[kWheel][pair];
        const double distance = ground.distance(std::array{centre});
        out.push_back((ground.above(centre) ? distance : -distance) - robot_.wheel_radius);
    }
    return out;
}

std::vector<double> Postures::between_legs() const {
    const auto exact = [&](std::size_t k) {
        double least = kInfinity;
        const std::vector<Round> rear = rounds_of(robot_, postures_[k], 1);
        for (const Round& a : rounds_of(robot_, postures_[k], 0))
            for (const Round& b : rear) {
                const double touch = a.radius + b.radius, enough = std::max(0.0, least + touch);
                if (square_distance(a.box, b.box) < enough * enough)
                    least = std::min(least, std::sqrt(square_distance(a.axis, b.axis)) - touch);
            }
        return least;
    };
    const double stretch = Extent(robot_).stretch;
    return sparing_distances(std::vector<double>(postures_.size()), exact, [&](std::size_t j, std::size_t k) {
        return 2.0 * stretch * std::abs(way_[k] - way_[j]);
    });
}

}  // namespace stairwright::certificate
