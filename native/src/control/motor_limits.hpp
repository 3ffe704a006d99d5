// Forces that the motors can give. The balance QP (eqs 11-12) knows friction alone: where motors have little to spare it asks
// for forces that they do not have, most often to press wheels on opposite faces against each other for a small horizontal
// force or moment, and what the motors then lack is the weight. Torques beyond limits cost far more than the wrench here.
#pragma once

#include "measurement.hpp"
#include "stairwright/control/balance_qp.hpp"
#include "stairwright/control/wheel_support.hpp"

namespace stairwright::control {

// A motor's torque [Nm] as the force of its wheel makes it.
struct MotorTorque {
    double tangential = 0.0, normal = 0.0;  // per N of the wheel's force [m]
    double rest = 0.0;                      // weight and inertia of the leg

    double at(double t, double n) const { return tangential * t + normal * n + rest; }
};

struct LegMotors {
    MotorTorque thigh, calf, wheel;
};

// J' F of eq 13 and the leg's own weight.
LegMotors leg_torques(const Leg& leg, const MeasuredLeg& at, const WheelSupport& support);

// Solve the QP, then again with the cost of what is beyond the motors' limits at `joint_rates`, where anything is.
// `force_weight` is that of a force in the QP's cost.
void solve_within_motors(const BalanceQp& qp, const std::array<LegMotors, 4>& torques, const Robot& robot,
                         const std::array<double, 12>& joint_rates, double force_weight, Forces& forces);

}  // namespace stairwright::control
