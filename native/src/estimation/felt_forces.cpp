// What the legs tell: where their wheels are, how they roll, and what force the ground has on them.
#include "stairwright/estimation/estimator.hpp"

#include <algorithm>

#include "spatial.hpp"

namespace stairwright::estimation {

namespace {

constexpr double kForceTime = 0.015;    // s, smoothing of the forces
constexpr double kCruiseTime = 0.1;    // s, smoothing of the speed that a wheel rolls at
constexpr double kSteadyTime = 0.03;    // s, smoothing of a force against which it changes
constexpr double kSettleTime = 0.05;    // s in which what it has changed by is over

}  // namespace

void Estimator::see_legs(const Readings& readings, double dt) {
    const Rotation R = rotation();
    const auto world = [&](Vec2 p) { return Vec2{R[0][0] * p.x + R[0][2] * p.z, R[2][0] * p.x + R[2][2] * p.z}; };
    const double share = dt / (kForceTime + dt);
    std::array<WheelForce, 4> told;
    for (int i = 0; i < 4; ++i) {
        const Leg& leg = robot_.legs[i / 2];
        WheelState& w = wheels_[i];
        const double thigh = readings.joints[3 * i], calf = thigh + readings.joints[3 * i + 1];
        const double thigh_rate = readings.joint_rates[3 * i], calf_rate = thigh_rate + readings.joint_rates[3 * i + 1];
        const Turn upper = Turn::by(thigh), lower = Turn::by(calf);
        const Vec2 knee = upper * leg.thigh.end, shank = lower * leg.calf.end;
        w.place = leg.hip + knee + shank;
        w.rate = {knee.z * thigh_rate + shank.z * calf_rate, -knee.x * thigh_rate - shank.x * calf_rate};
        const Vec2 at_knee = leg.hip + knee;
        w.leg = {world(leg.hip), world(at_knee), world(w.place), world(leg.hip + upper * leg.thigh.com),
                 world(at_knee + lower * leg.calf.com)};
        // What turns the joint: the motor's torque less what its own friction takes.
        const auto torque = [&](int k, const Motor& motor) { return readings.torques[3 * i + k] - motor.damping * readings.joint_rates[3 * i + k]; };
        told[i] = wheel_force(leg, w.leg, torque(0, leg.thigh_motor), torque(1, leg.calf_motor), torque(2, leg.wheel_motor));
        const double rate = readings.joint_rates[3 * i] + readings.joint_rates[3 * i + 1] + readings.joint_rates[3 * i + 2] + rate_[1];
        w.rolled = leg.wheel.radius * rate * dt;
        // What spins the wheel up does not reach the ground.
        const double spin_up = started_ ? (leg.wheel.inertia + leg.wheel_motor.armature) * (rate - w.rate_now) / dt / leg.wheel.radius : 0.0;
        w.traction_before = w.traction, w.felt_before = w.felt;
        w.traction += share * (told[i].traction - spin_up - w.traction);
        w.cruise += dt / (kCruiseTime + dt) * (leg.wheel.radius * w.rate_now - w.cruise);
        w.rate_now = rate;
    }
    feel_ground(told, readings, dt);
}

// What legs do not tell is what the others lack to the force that the accelerometer feels.
void Estimator::feel_ground(const std::array<WheelForce, 4>& told, const Readings& readings, double dt) {
    const double share = dt / (kForceTime + dt);
    Vec3 force;
    for (int i = 0; i < 3; ++i) force[i] = robot_.mass() * (readings.specific_force[i] - force_bias_[i]);
    const Vec3 carried = times(rotation(), force);
    Vec2 lacking = {carried[0], carried[2]};
    int untold = 0;
    for (int i = 0; i < 4; ++i) lacking = lacking - wheels_[i].felt, untold += norm(told[i].untold) > 0.0;
    std::array<Vec2, 4> all;
    for (int i = 0; i < 4; ++i) {
        WheelState& w = wheels_[i];
        const Vec2 along = told[i].untold;
        w.felt += share * (told[i].force + dot(w.felt + (1.0 / std::max(untold, 1)) * lacking, along) * along - w.felt);
        w.felt_slowly += dt / (kSteadyTime + dt) * (w.felt - w.felt_slowly);
        w.unsteady = std::max(norm(w.felt - w.felt_slowly), (1.0 - dt / kSettleTime) * w.unsteady);
        all[i] = w.felt;
    }
    estimate_.felt = untold ? std::nullopt : std::optional(all);
}

}  // namespace stairwright::estimation
