// A plan on a robot: from the state of its motors and its IMU to what its motors are told, step by step, with limits.
// It knows no socket and no clock: a link to the robot calls `step` for each state that comes in, and `damped` for as
// long as the robot is to be brought to rest without a state.
#pragma once

#include <optional>

#include "stairwright/execution/plan_executor.hpp"
#include "stairwright/player/plan_file.hpp"

namespace stairwright::player {

// Beyond these the motors only damp.
struct Limits {
    double tilt = 0.6;         // rad of roll, or of pitch off the plan
    double joint = 0.05;       // rad that a joint may be outside its range
    double speed = 1.3;        // of a motor's no-load speed
    double start = 0.35;       // rad that a joint may be off the plan's first pose at the start
    double start_rate = 0.5;   // rad/s of joints and trunk at the start
    double start_force = 1.5;  // m/s^2 that the accelerometer may be off g at the start
    double gap = 0.02;         // s between two states
};

enum class Phase {
    waiting,   // for the first state
    settling,  // into the plan's first pose, and a test of the grip
    driving,
    arrived,   // stands where the plan ends
    gave_up,   // stands where it could not go on
    refused,   // the robot does not stand as the plan begins: nothing is done
    damped,    // beyond a limit, or told to stop: motors only damp
};

// As a word or two.
const char* name(Phase phase);

class Player {
  public:
    explicit Player(PlanFile file, const Limits& limits = {});

    // What the motors are to do after `state`. The last command stays where the state before is less than 1.2 ms old:
    // control steps are 2 ms apart, whatever the rate of states.
    const LowCommand& step(const LowState& state);

    // The plan goes no further for now; the robot stands and balances.
    void pause() { paused_ = true; }
    // From now on motors only damp; a reason that was given before stays.
    void damp(const std::string& why);
    // What lets all joints sink slowly.
    const LowCommand& damped() const { return damped_; }

    Phase phase() const { return phase_; }
    // One sentence about how it ended or why it stopped; empty before.
    const std::string& reason() const { return reason_; }
    // What it was found to carry before the start that the plan is not for.
    const std::optional<control::Load>& load() const { return executor_.load(); }
    // Share of the plan that is done, 0..1.
    double done() const;
    // Largest torque of a leg's motor and of a wheel's that the last command amounts to [Nm].
    std::array<double, 2> largest_torques() const;
    const PlanFile& file() const { return file_; }
    double pitch() const { return pitch_; }  // as estimated [rad]

  private:
    estimation::Readings readings(const LowState& state) const;
    std::string not_at_start(const estimation::Readings& now) const;
    estimation::Start start_of(const estimation::Readings& now) const;
    std::string beyond_limits(const estimation::Readings& now) const;
    void decide();
    void tell(const control::Command& command, const estimation::Readings& now);

    PlanFile file_;
    Limits limits_;
    WheelPath path_;
    execution::PlanExecutor executor_;
    std::optional<estimation::Estimator> estimator_;
    Phase phase_ = Phase::waiting;
    std::string reason_;
    bool paused_ = false;
    double begun_ = 0.0, last_ = 0.0;  // times of states [s]
    double pitch_ = 0.0, roll_ = 0.0;  // estimated [rad]
    double rested_ = 0.0;              // s at the plan's end
    control::Torques torques_{};
    LowCommand command_, damped_;
};

}  // namespace stairwright::player
