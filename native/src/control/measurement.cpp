#include "measurement.hpp"

#include <cmath>

namespace stairwright::control {

namespace {

struct Moving {
    Vec2 place, velocity;
};

// A vector fixed to a link at absolute angle, and its rate, in the trunk frame.
Moving turned(Turn turn, double rate, Vec2 v) {
    const Vec2 at = turn * v;
    return {at, {at.z * rate, -at.x * rate}};
}

}  // namespace

Measurement measure(const Robot& robot, double mass, const RobotState& state) {
    const auto [w, x, y, z] = state.quaternion;
    const double r00 = 1 - 2 * (y * y + z * z), r01 = 2 * (x * y - w * z), r02 = 2 * (x * z + w * y);
    const double r20 = 2 * (x * z - w * y), r21 = 2 * (y * z + w * x), r22 = 1 - 2 * (x * x + y * y);
    const double r11 = 1 - 2 * (x * x + z * z);
    const auto [sx, sy, sz] = state.angular_velocity;
    Measurement out;
    out.pitch = std::atan2(r02, r22), out.pitch_rate = sy;
    out.heading = std::atan2(-r01, r11), out.yaw_rate = r20 * sx + r21 * sy + r22 * sz;
    out.roll = r21, out.roll_rate = r22 * sx - r20 * sz;

    Vec2 moment = robot.trunk.mass * robot.trunk.com, momentum;
    double second = robot.trunk.mass * dot(robot.trunk.com, robot.trunk.com) + robot.trunk.inertia;
    for (int i = 0; i < 4; ++i) {
        const Leg& leg = robot.legs[i / 2];
        const double thigh = state.joints[3 * i], calf = thigh + state.joints[3 * i + 1];
        const double thigh_rate = state.joint_rates[3 * i], calf_rate = thigh_rate + state.joint_rates[3 * i + 1];
        const Turn upper = Turn::by(thigh), lower = Turn::by(calf);
        const Moving knee = turned(upper, thigh_rate, leg.thigh.end), wheel = turned(lower, calf_rate, leg.calf.end);
        const Moving thigh_com = turned(upper, thigh_rate, leg.thigh.com);
        const Moving calf_com = turned(lower, calf_rate, leg.calf.com);
        const Vec2 at_knee = leg.hip + knee.place, at_wheel = at_knee + wheel.place;
        const Vec2 at_thigh = leg.hip + thigh_com.place, at_calf = at_knee + calf_com.place;
        moment += leg.thigh.mass * at_thigh + leg.calf.mass * at_calf + leg.wheel.mass * at_wheel;
        momentum += leg.thigh.mass * thigh_com.velocity + leg.calf.mass * (knee.velocity + calf_com.velocity) +
                    leg.wheel.mass * (knee.velocity + wheel.velocity);
        second += leg.thigh.mass * dot(at_thigh, at_thigh) + leg.calf.mass * dot(at_calf, at_calf);
        second += leg.wheel.mass * dot(at_wheel, at_wheel);
        second += leg.thigh.inertia + leg.calf.inertia + leg.wheel.inertia;
        const double side = i % 2 == 0 ? robot.half_track : -robot.half_track;
        const auto world = [&](Vec2 p) {
            return Vec2{state.position[0] + r00 * p.x + r01 * side + r02 * p.z,
                        state.position[2] + r20 * p.x + r21 * side + r22 * p.z};
        };
        out.legs[i] = {world(leg.hip), world(at_knee), world(at_wheel), world(at_thigh), world(at_calf)};
    }
    const Vec2 c = {moment.x / mass, moment.z / mass}, v = {momentum.x / mass, momentum.z / mass};
    out.inertia = second - mass * dot(c, c);
    out.com = {state.position[0] + r00 * c.x + r02 * c.z, state.position[2] + r20 * c.x + r22 * c.z};
    // Velocity of the mass centre in the trunk frame: spin x place + its own rate.
    const double bx = sy * c.z + v.x, by = sz * c.x - sx * c.z, bz = -sy * c.x + v.z;
    out.com_velocity = {state.velocity[0] + r00 * bx + r01 * by + r02 * bz, state.velocity[2] + r20 * bx + r21 * by + r22 * bz};
    return out;
}

}  // namespace stairwright::control
