#include "stairwright/poses/pose_record.hpp"

#include <algorithm>
#include <cmath>

#include "stairwright/clearance.hpp"
#include "stairwright/resting_forces.hpp"
#include "stairwright/wheel_contacts.hpp"

namespace stairwright::poses {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRounding = 1e-6;  // rad; a joint that far beyond its limit is put onto it

// Of the contacts of each wheel, those that hold the robot with the least friction need, and the forces in weights.
struct Gentlest {
    std::array<Contact, 2> contacts;
    std::array<ContactForce, 2> forces;
    double friction = kInfinity;
};

Gentlest gentlest(const std::array<WheelContacts, 2>& wheels, double com_x) {
    Gentlest best;
    for (const Contact& front : wheels[kFront].span()) {
        for (const Contact& rear : wheels[kRear].span()) {
            std::array<ContactForce, 2> forces;
            const double needed = least_friction({front, rear}, com_x, 0.0, forces);
            if (needed < best.friction) best = {{front, rear}, forces, needed};
        }
    }
    return best;
}

// Limit minus the largest static torque of leg joints and wheels [Nm].
double torque_margin(const Robot& robot, const std::array<LegPoints, 2>& legs, const Gentlest& support) {
    const double half_weight = 0.5 * robot.mass() * kGravity;
    double spare = kInfinity;
    for (const int k : {kFront, kRear}) {
        const Leg& leg = robot.legs[k];
        const ContactForce f = {half_weight * support.forces[k].tangential, half_weight * support.forces[k].normal};
        const LegTorques torques = static_torques(leg, legs[k], support.contacts[k], f);
        spare = std::min({spare, leg.thigh_motor.torque - std::abs(torques.thigh), leg.calf_motor.torque - std::abs(torques.calf),
                          leg.wheel_motor.torque - std::abs(torques.wheel)});
    }
    return spare;
}

}  // namespace

PoseRecord pose_record(const PoseProblem& problem, double friction, const Unknowns& y, const Joints& q) {
    const PoseModel& model = problem.robot;
    const Robot& robot = model.robot.robot;
    PoseState state(model);
    place(model, problem.path, y, state);
    stand_on(model, q, kRounding, state);
    PoseRecord out;
    out.q = state.q;
    out.com = state.com.at;
    std::array<Contact, 2> at;
    std::array<LegPoints, 2> legs;
    for (const int k : {kFront, kRear}) {
        const CurvePoint on = problem.path.at(y[3 + k]);
        out.contacts[k] = on.centre - problem.path.radius() * on.normal;
        at[k] = {out.contacts[k], on.normal, friction};
        legs[k] = {state.points[model.hip[k]].at, state.points[model.knee[k]].at, state.points[model.wheel[k]].at};
        out.wheels[k] = legs[k].wheel;
    }
    const double weight = robot.mass() * kGravity;
    out.forces = resting_forces(at, out.com.x);
    for (ContactForce& f : out.forces) f = {weight * f.tangential, weight * f.normal};
    for (int i = model.first_collision_point; i < model.last_collision_point; ++i)
        out.collision_points.push_back(state.points[i].at);

    const WheelPlaces s = {y[3], y[4]};
    const std::array<WheelContacts, 2> wheels = {wheel_contacts(problem.path, s.front, friction),
                                                 wheel_contacts(problem.path, s.rear, friction)};
    const Interval interval = stated_interval(problem.path, s, friction);
    out.clearance = least_clearance(problem.terrain, robot, {y[0], y[1], y[2]}, legs).distance;
    out.com_margin = interval.empty() ? -kInfinity : std::min(out.com.x - interval.lower, interval.upper - out.com.x);
    std::vector<Contact> all;
    for (const WheelContacts& wheel : wheels) all.insert(all.end(), wheel.span().begin(), wheel.span().end());
    out.friction_margin = friction - friction_needed(all, out.com.x);
    const Gentlest support = gentlest(wheels, out.com.x);
    out.torque_margin = std::isfinite(support.friction) ? torque_margin(robot, legs, support) : -kInfinity;
    return out;
}

}  // namespace stairwright::poses
