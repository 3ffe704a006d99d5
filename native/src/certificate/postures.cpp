#include "stairwright/certificate/postures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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
    const Vec2 knee = at.joints[kKnee][pair];
    return {Placed(robot.legs[pair].calf, knee, at.joints[kWheel][pair]), Placed(robot.legs[pair].thigh, at.joints[kHip][pair], knee)};
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

double links_from(const Robot& robot, const Posture& at, const Ground& ground) {
    double least = kInfinity;
    for (std::size_t pair = 0; pair < 2; ++pair)
        for (const Placed& link : links_of(robot, at, pair))
            for (const Link::Capsule& capsule : link.link.capsules) {
                const Segment axis = link.axis(capsule);
                const double enough = std::max(0.0, least + capsule.radius);
                const double distance = ground.above(axis.begin) ? ground.distance(std::array{axis.begin, axis.end}, enough) : kBelow;
                least = std::min(least, distance - capsule.radius);
            }
    return least;
}

// A capsule in the world, or a wheel: its axis has no length.
struct Round {
    Segment axis;
    double radius;
    Box box;

    Round(const Segment& axis, double radius) : axis(axis), radius(radius), box(box_of(axis)) {}
};

void place_leg(const Robot& robot, const Posture& at, std::size_t pair, std::vector<Round>& out) {
    const Vec2 wheel = at.joints[kWheel][pair];
    out.assign(1, Round({wheel, wheel}, robot.wheel_radius));
    for (const Placed& link : links_of(robot, at, pair))
        for (const Link::Capsule& capsule : link.link.capsules) out.emplace_back(link.axis(capsule), capsule.radius);
}

}  // namespace

Postures::Postures(Robot robot, std::span<const Pose> poses) : robot_(std::move(robot)) {
    postures_.reserve(poses.size());
    for (const Pose& pose : poses) postures_.push_back(posture_of(robot_, pose));
}

std::vector<Vec2> Postures::com() const {
    std::vector<Vec2> out;
    out.reserve(postures_.size());
    for (const Posture& at : postures_) out.push_back(com_of(robot_, at));
    return out;
}

std::vector<double> Postures::trunk(const Ground& ground) const {
    std::vector<double> out(postures_.size(), kInfinity);
    for (const std::vector<Vec2>& piece : robot_.trunk) {
        std::vector<Vec2> corners(piece.size());
        Vec2 middle;
        for (const Vec2 corner : piece) middle += (1.0 / static_cast<double>(piece.size())) * corner;
        for (std::size_t k = 0; k < out.size(); ++k) {
            const auto place = [&at = postures_[k]](Vec2 p) { return at.trunk + at.turn * p; };
            std::transform(piece.begin(), piece.end(), corners.begin(), place);
            const double distance = ground.above(place(middle)) ? ground.distance(corners, std::max(0.0, out[k])) : kBelow;
            out[k] = std::min(out[k], distance);
        }
    }
    return out;
}

std::vector<double> Postures::links(const Ground& ground) const {
    std::vector<double> out;
    out.reserve(postures_.size());
    for (const Posture& at : postures_) out.push_back(links_from(robot_, at, ground));
    return out;
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
    std::vector<double> out(postures_.size(), kInfinity);
    std::vector<Round> front, rear;
    for (std::size_t k = 0; k < out.size(); ++k) {
        place_leg(robot_, postures_[k], 0, front), place_leg(robot_, postures_[k], 1, rear);
        for (const Round& a : front)
            for (const Round& b : rear) {
                const double enough = std::max(0.0, out[k] + a.radius + b.radius);
                if (square_distance(a.box, b.box) < enough * enough)
                    out[k] = std::min(out[k], std::sqrt(square_distance(a.axis, b.axis)) - a.radius - b.radius);
            }
    }
    return out;
}

}  // namespace stairwright::certificate
