#include "inertial_loads.hpp"

namespace stairwright::control {

namespace {

// How a link turns: angle's rate and acceleration.
struct Turning {
    Turn turn;
    double rate, acceleration;

    // Of the end of `v`, which is fixed to the link, against its beginning.
    Vec2 accelerated(Vec2 v) const {
        return {acceleration * v.z - rate * rate * v.x, -acceleration * v.x - rate * rate * v.z};
    }
};

struct Point {
    Vec2 place, acceleration;

    Point beyond(const Turning& link, Vec2 v) const {
        const Vec2 at = link.turn * v;
        return {place + at, acceleration + link.accelerated(at)};
    }
};

struct Body {
    double mass, inertia;
    Point centre;
    double acceleration;  // of its angle

    double moment(Vec2 about) const {
        const Vec2 r = centre.place - about, a = centre.acceleration;
        return mass * (r.z * a.x - r.x * a.z) + inertia * acceleration;
    }
};

}  // namespace

InertialLoads inertial_loads(const Robot& robot, const Reference& target) {
    const Planned &at = target.value, &rate = target.rate, &acceleration = target.acceleration;
    const Turning trunk = {Turn::by(at.pitch), rate.pitch, acceleration.pitch};
    const Point middle = {at.trunk, acceleration.trunk};
    InertialLoads out;
    out.moment = Body{robot.trunk.mass, robot.trunk.inertia, middle.beyond(trunk, robot.trunk.com), trunk.acceleration}
                     .moment(at.com);
    for (int pair = 0; pair < 2; ++pair) {
        const Leg& leg = robot.legs[pair];
        const int j = 2 * pair;
        const double thigh_angle = at.pitch + at.joints[j];
        const Turning upper = {Turn::by(thigh_angle), trunk.rate + rate.joints[j], trunk.acceleration + acceleration.joints[j]};
        const Turning lower = {Turn::by(thigh_angle + at.joints[j + 1]), upper.rate + rate.joints[j + 1],
                               upper.acceleration + acceleration.joints[j + 1]};
        const double spin = acceleration.wheels[pair] / leg.wheel.radius;
        const Point hip = middle.beyond(trunk, leg.hip), knee = hip.beyond(upper, leg.thigh.end);
        const Body thigh = {leg.thigh.mass, leg.thigh.inertia, hip.beyond(upper, leg.thigh.com), upper.acceleration};
        const Body calf = {leg.calf.mass, leg.calf.inertia, knee.beyond(lower, leg.calf.com), lower.acceleration};
        const Body wheel = {leg.wheel.mass, leg.wheel.inertia, knee.beyond(lower, leg.calf.end), spin};
        out.moment += 2.0 * (thigh.moment(at.com) + calf.moment(at.com) + wheel.moment(at.com));
        const auto of_knee = [&](Vec2 about) { return calf.moment(about) + wheel.moment(about); };
        out.legs[pair] = {
            thigh.moment(hip.place) + of_knee(hip.place) + leg.thigh_motor.armature * acceleration.joints[j],
            of_knee(knee.place) + leg.calf_motor.armature * acceleration.joints[j + 1],
            leg.wheel.inertia * spin + leg.wheel_motor.armature * (spin - lower.acceleration),
        };
    }
    return out;
}

LegLoads friction_loads(const Leg& leg, int pair, const Planned& rate) {
    const double thigh = rate.joints[2 * pair], calf = rate.joints[2 * pair + 1];
    const double wheel = rate.wheels[pair] / leg.wheel.radius - rate.pitch - thigh - calf;  // against the calf
    return {leg.thigh_motor.damping * thigh, leg.calf_motor.damping * calf, leg.wheel_motor.damping * wheel};
}

}  // namespace stairwright::control
