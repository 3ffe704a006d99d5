#include "stairwright/posture.hpp"

#include <limits>

namespace stairwright {

namespace {

using std::numbers::pi;

// A link's capsules in the world: its own frame is turned so that `end` comes to lie along `line`.
template <typename Visit>
void visit_capsules(const Link& link, Vec2 joint, Vec2 line, Visit visit) {
    const Turn turn = link_turn(link, line);
    for (const Capsule& c : link.shape) visit(Capsule{joint + turn * c.a, joint + turn * c.b, c.radius});
}

template <typename Visit>
void visit_capsules(const Leg& leg, const LegPoints& p, Visit visit) {
    visit_capsules(leg.thigh, p.hip, p.knee - p.hip, visit);
    visit_capsules(leg.calf, p.knee, p.wheel - p.knee, visit);
}

double thickest(const Link& link) {
    double radius = 0.0;
    for (const Capsule& c : link.shape) radius = std::max(radius, c.radius);
    return radius;
}

double girth(const Leg& leg) {
    double out = 0.0;
    for (const Link* link : {&leg.thigh, &leg.calf})
        for (const Capsule& c : link->shape)
            for (const Vec2 end : {c.a, c.b})
                out = std::max(out, std::sqrt(point_segment_squared(end, {0.0, 0.0}, link->end)) + c.radius);
    return out;
}

// The part of a thigh's range, with the leg straight down, that the other leg's hip leaves it. A thigh that is longer
// than the hips are apart cannot swing past the other hip, which lies at `other` from its own. A lattice would step
// over that.
Range past_hip(const Leg& leg, const Leg& other) {
    Range range = leg.thigh_range;
    const Vec2 d = other.hip - leg.hip;
    const double distance = norm(d), width = thickest(leg.thigh) + thickest(other.thigh) + kLegsGap;
    if (distance <= width || distance >= leg.thigh.length + width) return range;
    const double towards = std::atan2(-d.x, -d.z) - leg.thigh.bend, half = std::asin(width / distance);
    for (const double turn : {-2.0 * pi, 0.0, 2.0 * pi}) {
        const double a = towards + turn - half, b = towards + turn + half;
        if (a > 0.0 && range.lower <= 0.0)
            range.upper = std::min(range.upper, a);
        else if (b < 0.0 && range.upper >= 0.0)
            range.lower = std::max(range.lower, b);
    }
    return range;
}

}  // namespace

RobotModel::RobotModel(const Robot& given) : robot(given), mass(given.mass()) {
    for (int k = 0; k < 2; ++k) {
        const Leg &leg = robot.legs[k], &other = robot.legs[1 - k];
        legs[k] = {leg, reach_range(leg), girth(leg)};
        legs[k].leg.thigh_range = past_hip(leg, other);
    }
}

double RobotModel::scale() const {
    double length = 0.0;
    for (const Leg& leg : robot.legs) length = std::max(length, leg.thigh.length + leg.calf.length);
    return length / 0.4;
}

double RobotModel::most_wheel_distance() const {
    return legs[kFront].reach.most + legs[kRear].reach.most + norm(robot.legs[kFront].hip - robot.legs[kRear].hip);
}

Posture make_posture(const RobotModel& robot, const Body& body, const WheelCentres& wheels) {
    const Turn pitch = Turn::by(body.pitch);
    Posture out;
    out.reach_slack = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 2; ++k) {
        const LegModel& model = robot.legs[k];
        out.legs[k] = place_leg(model.leg, body, pitch, wheels[k]);
        const double d = norm(wheels[k] - out.legs[k].hip);
        out.reach_slack = std::min(out.reach_slack, std::min(d - model.reach.least, model.reach.most - d));
    }
    out.com = centre_of_mass(robot.robot, body, pitch, out.legs);
    return out;
}

PoseJoints pose_joints(const RobotModel& robot, double pitch, const Posture& posture) {
    PoseJoints out;
    out.slack = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 2; ++k) {
        const LegModel& model = robot.legs[k];
        const LegPoints& p = posture.legs[k];
        out.q[k] = joint_angles(model.leg, pitch, p.knee - p.hip, p.wheel - p.hip);
        const double thigh = model.leg.thigh_range.slack(out.q[k].thigh);
        const double calf = model.leg.calf_range.slack(out.q[k].calf);
        out.slack = std::min(out.slack, std::min(thigh, calf));
    }
    return out;
}

double trunk_clearance(const Terrain& terrain, const RobotModel& robot, const Body& body, double query_radius) {
    const Turn pitch = Turn::by(body.pitch);
    double least = query_radius;
    for (const Polygon& polygon : robot.robot.trunk.outline)
        least = std::min(least, terrain.polygon_clearance(polygon, {body.x, body.z}, pitch, query_radius));
    return least;
}

double link_clearance(const Terrain& terrain, const Leg& leg, const LegPoints& p, int link, double query_radius) {
    double least = query_radius;
    const auto visit = [&](const Capsule& c) { least = std::min(least, terrain.link_clearance(c.a, c.b, c.radius, query_radius)); };
    if (link == 0)
        visit_capsules(leg.thigh, p.hip, p.knee - p.hip, visit);
    else
        visit_capsules(leg.calf, p.knee, p.wheel - p.knee, visit);
    return least;
}

namespace {

double least_of(const LinkClearances& links) {
    return std::min(std::min(links[0][0], links[0][1]), std::min(links[1][0], links[1][1]));
}

}  // namespace

LinkClearances link_clearances(const Terrain& terrain, const RobotModel& robot, const Posture& posture, double query_radius) {
    LinkClearances out;
    double least = query_radius;
    for (const int link : {1, 0})  // calves are near to the ground
        for (const int pair : {kFront, kRear}) {
            const double within = std::min(query_radius, std::max(least, 0.0) + kNearlyNearest);
            out[pair][link] = link_clearance(terrain, robot.legs[pair].leg, posture.legs[pair], link, within);
            least = std::min(least, out[pair][link]);
        }
    return out;
}

double leg_clearance(const Terrain& terrain, const Leg& leg, const LegPoints& at, double query_radius) {
    return std::min(link_clearance(terrain, leg, at, 0, query_radius), link_clearance(terrain, leg, at, 1, query_radius));
}

double links_clearance(const Terrain& terrain, const RobotModel& robot, const Posture& posture, double query_radius,
                       const LinkClearances& before) {
    const double near = least_of(before) + kNearlyNearest;
    double least = query_radius;
    for (const int pair : {kFront, kRear})
        for (const int link : {0, 1})
            if (before[pair][link] <= near) least = std::min(least, link_clearance(terrain, robot.legs[pair].leg, posture.legs[pair], link, query_radius));
    return least;
}

namespace {

// How far a leg reaches along x.
Range extent(const LegModel& model, const LegPoints& p) {
    const double tyre = std::max(model.leg.wheel.radius, model.girth);
    return {std::min(std::min(p.hip.x, p.knee.x) - model.girth, p.wheel.x - tyre),
            std::max(std::max(p.hip.x, p.knee.x) + model.girth, p.wheel.x + tyre)};
}

}  // namespace

double legs_distance(const RobotModel& robot, const std::array<LegPoints, 2>& legs, double query_radius) {
    const Range ahead = extent(robot.legs[kFront], legs[kFront]), behind = extent(robot.legs[kRear], legs[kRear]);
    if (std::max(ahead.lower - behind.upper, behind.lower - ahead.upper) > query_radius) return query_radius;
    const Leg &front = robot.legs[kFront].leg, &rear = robot.legs[kRear].leg;
    const Vec2 front_wheel = legs[kFront].wheel, rear_wheel = legs[kRear].wheel;
    double best = norm(front_wheel - rear_wheel) - front.wheel.radius - rear.wheel.radius;
    visit_capsules(front, legs[kFront], [&](const Capsule& a) {
        best = std::min(best, std::sqrt(point_segment_squared(rear_wheel, a.a, a.b)) - a.radius - rear.wheel.radius);
        visit_capsules(rear, legs[kRear], [&](const Capsule& b) {
            best = std::min(best, segment_distance(a.a, a.b, b.a, b.b) - a.radius - b.radius);
        });
    });
    visit_capsules(rear, legs[kRear], [&](const Capsule& b) {
        best = std::min(best, std::sqrt(point_segment_squared(front_wheel, b.a, b.b)) - b.radius - front.wheel.radius);
    });
    return best;
}

PoseGeometry pose_geometry(const Terrain& terrain, const RobotModel& robot, const Body& body,
                           const WheelCentres& wheels, QueryRadii radii) {
    PoseGeometry out;
    out.posture = make_posture(robot, body, wheels);
    out.joints = pose_joints(robot, body.pitch, out.posture);
    out.trunk = trunk_clearance(terrain, robot, body, radii.trunk);
    out.by_link = link_clearances(terrain, robot, out.posture, radii.links);
    out.links = std::min(radii.links, least_of(out.by_link));
    out.legs = legs_distance(robot, out.posture.legs, radii.legs);
    return out;
}

namespace {

bool alike(const Link& a, const Link& b) {
    const auto same = [](Vec2 u, Vec2 v) { return u.x == v.x && u.z == v.z; };
    bool out = same(a.end, b.end) && same(a.com, b.com) && a.mass == b.mass && a.shape.size() == b.shape.size();
    for (std::size_t k = 0; out && k < a.shape.size(); ++k)
        out = same(a.shape[k].a, b.shape[k].a) && same(a.shape[k].b, b.shape[k].b) && a.shape[k].radius == b.shape[k].radius;
    return out;
}

}  // namespace

bool RobotModel::legs_alike() const {
    const LegModel &front = legs[kFront], &rear = legs[kRear];
    const Leg &a = front.leg, &b = rear.leg;
    return alike(a.thigh, b.thigh) && alike(a.calf, b.calf) && a.knee == b.knee && a.wheel.mass == b.wheel.mass &&
           a.thigh_motor.torque == b.thigh_motor.torque && a.calf_motor.torque == b.calf_motor.torque &&
           front.reach.least == rear.reach.least && front.reach.most == rear.reach.most;
}

}  // namespace stairwright
