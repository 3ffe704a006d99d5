#include "motor_limits.hpp"

#include <algorithm>
#include <cmath>

namespace stairwright::control {

namespace {

constexpr double kFirm = 20.0;  // times the weight of a force: of a force beyond what a motor can give
constexpr int kRounds = 4;       // in which motors are found that the forces before overload

// Torque that a force at `point` asks of `joint`, per N along `axis` [m].
double lever(Vec2 joint, Vec2 point, Vec2 axis) { return (point.x - joint.x) * axis.z - (point.z - joint.z) * axis.x; }

// Adds the cost of what `motor` lacks to wheel `i`.
void cost(BalanceQp& qp, int i, const MotorTorque& motor, double torque, double weight) {
    const double squares = motor.tangential * motor.tangential + motor.normal * motor.normal;
    const double w = weight / squares;
    const int t = 2 * i, n = t + 1;
    qp.H[t][t] += w * motor.tangential * motor.tangential, qp.H[n][n] += w * motor.normal * motor.normal;
    qp.H[t][n] += w * motor.tangential * motor.normal, qp.H[n][t] = qp.H[t][n];
    qp.g[t] += w * motor.tangential * (motor.rest - torque), qp.g[n] += w * motor.normal * (motor.rest - torque);
}

}  // namespace

LegMotors leg_torques(const Leg& leg, const MeasuredLeg& at, const WheelSupport& s) {
    const Vec2 t = s.tangent(), n = s.normal, point = at.wheel - s.reach * n;
    const double below_hip = leg.thigh.mass * (at.thigh_com.x - at.hip.x) + leg.calf.mass * (at.calf_com.x - at.hip.x) +
                             leg.wheel.mass * (at.wheel.x - at.hip.x);
    const double below_knee = leg.calf.mass * (at.calf_com.x - at.knee.x) + leg.wheel.mass * (at.wheel.x - at.knee.x);
    LegMotors out;
    out.thigh = {lever(at.hip, point, t), lever(at.hip, point, n), -kGravity * below_hip};
    out.calf = {lever(at.knee, point, t), lever(at.knee, point, n), -kGravity * below_knee};
    if (s.reach > 0.0) out.wheel.tangential = leg.wheel.radius;  // in a corner both faces carry
    return out;
}

void solve_within_motors(const BalanceQp& qp, const std::array<LegMotors, 4>& torques, const Robot& robot,
                         const std::array<double, 12>& joint_rates, double force_weight, Forces& forces) {
    solve(qp, forces);
    BalanceQp within = qp;
    std::array<bool, 12> limited{};
    for (int round = 0; round < kRounds; ++round) {
        bool more = false;
        for (int j = 0; j < 12; ++j) {
            const int i = j / 3;
            const Leg& leg = robot.legs[i / 2];
            const Motor& motor = *std::array{&leg.thigh_motor, &leg.calf_motor, &leg.wheel_motor}[j % 3];
            const MotorTorque& of = *std::array{&torques[i].thigh, &torques[i].calf, &torques[i].wheel}[j % 3];
            const double asked = of.at(forces[2 * i], forces[2 * i + 1]);
            const double given = available_torque(motor, asked, joint_rates[j]);
            if (limited[j] || given == asked || (of.tangential == 0.0 && of.normal == 0.0)) continue;
            cost(within, i, of, given, kFirm * force_weight);
            more = limited[j] = true;
        }
        if (!more) return;
        solve(within, forces);
    }
}

}  // namespace stairwright::control
