// The closed loop in MuJoCo: sense, control, record, step the physics.
#pragma once

#include "stairwright/execution/plan_executor.hpp"
#include "stairwright/rollout/log.hpp"
#include "stairwright/rollout/score.hpp"
#include "stairwright/rollout/perception.hpp"

struct mjModel_;
struct mjData_;

namespace stairwright::rollout {

// What is between the torques that the controller wants and those that act.
struct Motors {
    double bandwidth = 0.0;  // of a first-order lag [Hz]; 0: none
    double scale = 1.0;      // of the torque that acts to the one that is asked for
};

// The estimator's error against the truth at one step, see Estimator::judge.
struct Judged {
    double time = 0.0;
    std::array<double, 8> error{};
    double nees = 0.0, scale = 0.0;
    std::array<Vec2, 2> offset{};
    double nees_in_world = 0.0;
};
inline constexpr std::size_t kJudgedWidth = sizeof(Judged) / sizeof(double);

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
            Perception perception, const Motors& motors, std::size_t log_every, int substeps, double grip_need = 0.0, bool mends_map = false);

    // A map without the error that the robot waits for somebody to decide on. Another plan has to follow.
    void correct_map(const WheelPath& path);

    // The robot with what it was found to carry, see PlanExecutor::carry.
    void carry(const Robot& robot, double grip_need);

    // What carries out the plan; decisions that it waits for go there.
    execution::PlanExecutor& executor() { return executor_; }
    const execution::PlanExecutor& executor() const { return executor_; }

    // Control steps of a chunk; returns where it stopped: before the physics of a step with a contact to look at (one
    // that is not a wheel's, or any while a link is loaded), or at the end; at once when the state has diverged.
    // `noise` holds kNoiseWidth numbers a step, or none.
    int run(const Chunk& chunk, std::span<const double> noise);

    // Whether the state is not one to compute anything from: not finite, or beyond all reason.
    bool diverged() const;

    const Score& score() const { return score_; }
    const Log& log() const { return log_; }
    // Empty unless the robot senses by itself; as often as the log's samples.
    const std::vector<Judged>& judged() const { return judged_; }

  private:
    RobotState truth() const;
    Perceived perceive(std::span<const double> noise);
    void control(const Perceived& seen, bool moving, double time);

    const mjModel_* model_;
    mjData_* data_;
    execution::PlanExecutor executor_;
    Perception perception_;
    double scale_;  // of the motors' torques
    double lag_;  // share of the wanted torque that acts after a control step
    control::Torques torques_{};
    std::vector<Judged> judged_;
    Log log_;
    Score score_;
    int substeps_;
    double dt_;
};

}  // namespace stairwright::rollout
