#include "stairwright/kinematics.hpp"

namespace stairwright {

JointAngles joint_angles(const Leg& leg, double pitch, Vec2 knee, Vec2 reach) {
    const double upper_angle = std::atan2(-knee.x, -knee.z);
    const double thigh = leg.thigh.length, calf = leg.calf.length;
    const double cosine = (dot(reach, reach) - thigh * thigh - calf * calf) / (2.0 * thigh * calf);
    const double between = leg.knee * std::acos(std::clamp(cosine, -1.0, 1.0));
    JointAngles q;
    q.thigh = nearest_turn(upper_angle - leg.thigh.bend - pitch, leg.thigh_range.middle());
    q.calf = between + leg.thigh.bend - leg.calf.bend;
    return q;
}

LegPoints forward(const Leg& leg, const Body& body, JointAngles q) {
    LegPoints out;
    out.hip = hip(leg, body, Turn::by(body.pitch));
    out.knee = out.hip + Turn::by(body.pitch + q.thigh) * leg.thigh.end;
    out.wheel = out.knee + Turn::by(body.pitch + q.thigh + q.calf) * leg.calf.end;
    return out;
}

LegPoints place_leg(const Leg& leg, Vec2 trunk, Turn pitch, Vec2 wheel) {
    const Vec2 at = hip(leg, trunk, pitch);
    return {at, at + knee_offset(leg, wheel - at), wheel};
}

ReachRange reach_range(const Leg& leg) {
    const double l1 = leg.thigh.length, l2 = leg.calf.length;
    const double offset = leg.calf.bend - leg.thigh.bend;
    const double a = std::abs(leg.calf_range.lower + offset), b = std::abs(leg.calf_range.upper + offset);
    const auto reach = [&](double bend) {
        return std::sqrt(std::max(0.0, l1 * l1 + l2 * l2 + 2.0 * l1 * l2 * std::cos(std::min(bend, std::numbers::pi))));
    };
    return {reach(std::max(a, b)), reach(std::min(a, b))};
}

Vec2 pair_moment(const Leg& leg, Vec2 knee, Vec2 wheel) {
    const Vec2 thigh = link_turn(leg.thigh, knee) * leg.thigh.com;
    const Vec2 calf = knee + link_turn(leg.calf, wheel - knee) * leg.calf.com;
    return 2.0 * (leg.thigh.mass * thigh + leg.calf.mass * calf + leg.wheel.mass * wheel);
}

Vec2 centre_of_mass(const Robot& robot, const Body& body, Turn pitch, const std::array<LegPoints, 2>& legs) {
    Vec2 moment = robot.trunk.mass * (Vec2{body.x, body.z} + pitch * robot.trunk.com);
    for (int k = 0; k < 2; ++k) {
        const LegPoints& p = legs[k];
        moment += robot.legs[k].pair_mass() * p.hip + pair_moment(robot.legs[k], p.knee - p.hip, p.wheel - p.hip);
    }
    return (1.0 / robot.mass()) * moment;
}

}  // namespace stairwright
