// Errors, torques and energy of a rollout, added up over its control steps. SI units.
#pragma once

#include "stairwright/control/controller.hpp"

namespace stairwright::rollout {

struct Score {
    double pitch_error_max = 0.0, pitch_error_squares = 0.0, joint_error_squares = 0.0;
    double leg_torque_max = 0.0, wheel_torque_max = 0.0;
    double energy = 0.0;
    double steps = 0.0;
    double pitch_error = 0.0;  // at the last step
    double tilt = 0.0;         // of the lateral axis against the horizontal at the last step: roll, whatever the pitch

    void add(const control::RobotState& truth, const control::Torques& torques, const control::Reference& target, double dt);
};

}  // namespace stairwright::rollout
