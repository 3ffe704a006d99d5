// The closed loop in MuJoCo: sense, control, record, step the physics.
#pragma once

#include "stairwright/control/plan_follower.hpp"
#include "stairwright/rollout/log.hpp"
#include "stairwright/rollout/score.hpp"
#include "stairwright/rollout/sensor_model.hpp"

struct mjModel_;
struct mjData_;

namespace stairwright::rollout {

// Part of a rollout between two looks from outside.
struct Chunk {
    int first = 0, last = 0;  // control steps
    bool looked = false;      // go on behind the look at the contacts of step `first`
    bool loaded = false;      // a link carried load lately: look at each step
    bool moving = true;       // whether the plan may advance
    double begun = 0.0;       // time of control step 0 [s]
};

class Rollout {
  public:
    // Throws std::invalid_argument if the model is not one of the robot. Model and data are borrowed.
    Rollout(const mjModel_* model, mjData_* data, control::Controller controller, control::PlanFollower follower,
            SensorModel sensors, std::size_t log_every, int substeps);

    // Control steps of a chunk; returns where it stopped: before the physics of a step with a contact to look at (one
    // that is not a wheel's, or any while a link is loaded), or at the end; at once when the state has diverged.
    // `noise` holds kNoiseWidth numbers a step, or none.
    int run(const Chunk& chunk, std::span<const double> noise);

    // Whether the state is not one to compute anything from: not finite, or beyond all reason.
    bool diverged() const;

    const control::PlanFollower& follower() const { return follower_; }
    const Score& score() const { return score_; }
    const Log& log() const { return log_; }

  private:
    RobotState truth() const;
    void control(const RobotState& seen, bool moving, double time);

    const mjModel_* model_;
    mjData_* data_;
    control::Controller controller_;
    control::PlanFollower follower_;
    SensorModel sensors_;
    Log log_;
    Score score_;
    int substeps_;
    double dt_;
};

}  // namespace stairwright::rollout
