#include "stairwright/certificate/postures.hpp"

#include <cmath>
#include <limits>

namespace stairwright::certificate {

namespace {

constexpr double kBelow = -1.0;  // m; what is below the ground is said to be so far from it

// A leg's angle is 0 where it points down, and grows as it swings backward.
Vec2 along(double angle) { return {-std::sin(angle), -std::cos(angle)}; }

// A link in the world, between its joints.
struct Placed {
    const Link& link;
    Vec2 upper, down, ahead;

    Placed(const Link& link, Vec2 upper, Vec2 lower)
        : link(link), upper(upper), down((1.0 / link.length) * (lower - upper)), ahead{-down.z, down.x} {}
    Vec2 place(Vec2 p) const { return upper + p.x * ahead - p.z * down; }
    Segment axis(const Link::Capsule& capsule) const { return {place(capsule.begin), place(capsule.end)}; }
};

std::array<Placed, 2> placed(const Leg& leg, const Posture::Joints& at) {
    return {Placed(leg.calf, at.knee, at.wheel), Placed(leg.thigh, at.hip, at.knee)};
}

struct Round {
    Segment axis;
    double radius;
    Box box;

    Round(const Segment& axis, double radius) : axis(axis), radius(radius), box(box_of(axis)) {}
};

void add_rounds(std::vector<Round>& out, const Leg& leg, const Posture::Joints& at, double wheel_radius) {
    out.clear();
    out.emplace_back(Segment{at.wheel, at.wheel}, wheel_radius);
    for (const Placed& link : placed(leg, at))
        for (const Link::Capsule& capsule : link.link.capsules) out.emplace_back(link.axis(capsule), capsule.radius);
}

}  // namespace

void Postures::add(Vec2 trunk, double pitch, const std::array<double, 4>& joints) {
    Posture posture{trunk, Turn::by(pitch), {}};
    for (std::size_t k = 0; k < 2; ++k) {
        const Leg& leg = robot_.legs[k];
        const double thigh = pitch + joints[2 * k], calf = thigh + joints[2 * k + 1];
        const Vec2 hip = trunk + posture.turn * leg.hip, knee = hip + leg.thigh.length * along(thigh);
        posture.legs[k] = {hip, knee, knee + leg.calf.length * along(calf)};
    }
    postures_.push_back(posture);
}

Vec2 Postures::com(const Posture& posture) const {
    double mass = robot_.trunk_mass;
    Vec2 sum = mass * (posture.trunk + posture.turn * robot_.trunk_com);
    for (std::size_t k = 0; k < 2; ++k) {
        const Leg& leg = robot_.legs[k];
        mass += 2.0 * leg.wheel_mass;
        sum += 2.0 * leg.wheel_mass * posture.legs[k].wheel;
        for (const Placed& link : placed(leg, posture.legs[k])) {
            mass += 2.0 * link.link.mass;
            sum += 2.0 * link.link.mass * link.place(link.link.com);
        }
    }
    return (1.0 / mass) * sum;
}

double Postures::trunk(const Posture& posture, const Ground& ground) const {
    double least = std::numeric_limits<double>::infinity();
    std::vector<Vec2> corners;
    for (const std::vector<Vec2>& piece : robot_.trunk) {
        corners.clear();
        Vec2 middle;
        for (const Vec2 corner : piece) {
            corners.push_back(posture.trunk + posture.turn * corner);
            middle += (1.0 / static_cast<double>(piece.size())) * corners.back();
        }
        least = std::min(least, ground.above(middle) ? ground.distance(corners, std::max(0.0, least)) : kBelow);
    }
    return least;
}

double Postures::links(const Posture& posture, const Ground& ground) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 2; ++k)
        for (const Placed& link : placed(robot_.legs[k], posture.legs[k]))
            for (const Link::Capsule& capsule : link.link.capsules) {
                const Segment axis = link.axis(capsule);
                const double enough = std::max(0.0, least + capsule.radius);
                const double distance = ground.above(axis.begin) ? ground.distance(std::array{axis.begin, axis.end}, enough) : kBelow;
                least = std::min(least, distance - capsule.radius);
            }
    return least;
}

double Postures::rim(const Posture& posture, std::size_t leg, const Ground& ground) const {
    const Vec2 centre = posture.legs[leg].wheel;
    const double distance = ground.distance(std::array{centre});
    return (ground.above(centre) ? distance : -distance) - robot_.wheel_radius;
}

double Postures::between_legs(const Posture& posture) const {
    double least = std::numeric_limits<double>::infinity();
    std::vector<Round> front, rear;
    add_rounds(front, robot_.legs[0], posture.legs[0], robot_.wheel_radius);
    add_rounds(rear, robot_.legs[1], posture.legs[1], robot_.wheel_radius);
    for (const Round& a : front)
        for (const Round& b : rear) {
            const double enough = std::max(0.0, least + a.radius + b.radius);
            if (square_distance(a.box, b.box) < enough * enough)
                least = std::min(least, std::sqrt(square_distance(a.axis, b.axis)) - a.radius - b.radius);
        }
    return least;
}

}  // namespace stairwright::certificate
