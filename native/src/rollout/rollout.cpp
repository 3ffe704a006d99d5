#include "stairwright/rollout/rollout.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace stairwright::rollout {

namespace {

constexpr double kBeyond = 1e6;  // m, m/s, rad or rad/s, summed up: no robot gets there
constexpr int kAllContacts = 16;  // the sensor that counts every contact; before it 4 numbers a wheel

}  // namespace

Rollout::Rollout(const mjModel* model, mjData* data, control::Controller controller, control::PlanFollower follower,
                 Perception perception, const Motors& motors, std::size_t log_every, int substeps, double grip_need, bool mends_map)
    : model_(model), data_(data), executor_(std::move(controller), std::move(follower), grip_need, mends_map),
      perception_(std::move(perception)), scale_(motors.scale), log_(log_every), substeps_(substeps),
      dt_(substeps * model->opt.timestep) {
    if (model->nq != control::kPositions || model->nv != control::kVelocities || model->nu != 12 ||
        model->nsensordata <= kAllContacts)
        throw std::invalid_argument("the model is not one of a robot with four wheeled legs");
    if (substeps < 1) throw std::invalid_argument("substeps must be at least 1");
    mjcb_time = nullptr;  // MuJoCo for Python has every stage of every step timed, which is a twentieth of a rollout
    lag_ = motors.bandwidth > 0.0 ? 1.0 - std::exp(-2.0 * std::numbers::pi * motors.bandwidth * dt_) : 1.0;
}

RobotState Rollout::truth() const {
    std::array<double, control::kPositions + control::kVelocities> numbers;
    std::copy_n(data_->qpos, control::kPositions, numbers.begin());
    std::copy_n(data_->qvel, control::kVelocities, numbers.begin() + control::kPositions);
    return std::bit_cast<RobotState>(numbers);
}

bool Rollout::diverged() const {
    double total = 0.0;
    for (std::size_t i = 0; i < control::kPositions; ++i) total += std::abs(data_->qpos[i]);
    for (std::size_t i = 0; i < control::kVelocities; ++i) total += std::abs(data_->qvel[i]);
    return !(total < kBeyond);
}

Perceived Rollout::perceive(std::span<const double> noise) {
    if (auto* ideal = std::get_if<SensorModel>(&perception_)) {
        Perceived seen;
        seen.state = ideal->perceive(truth(), noise);
        seen.joints = seen.state.joints, seen.joint_rates = seen.state.joint_rates;
        return seen;
    }
    control::Torques told = torques_;  // by the motors' currents, as if their torques were those that are asked for
    for (double& torque : told) torque /= scale_;
    return std::get<RobotSense>(perception_).perceive(truth(), executor_.without_motion(told), dt_);
}

void Rollout::correct_map(const WheelPath& path) {
    auto* sense = std::get_if<RobotSense>(&perception_);
    if (sense == nullptr || !executor_.map_error()) throw std::invalid_argument("there is no error of the map to correct");
    executor_.correct_map(path, sense->estimator().correct_map(path, *executor_.map_error()));
}

void Rollout::carry(const Robot& robot, double grip_need) {
    auto* sense = std::get_if<RobotSense>(&perception_);
    if (sense == nullptr || !executor_.load()) throw std::invalid_argument("nothing was found that the robot carries");
    executor_.carry(robot, grip_need);
    sense->estimator().believe(robot);
}

void Rollout::control(const Perceived& seen, bool moving, double time) {
    const RobotState state = truth();
    const control::Command command = executor_.step(seen, moving, time, dt_);
    if (const auto creep = executor_.take_creep()) std::get<RobotSense>(perception_).estimator().believe_creep(*creep);
    const control::Reference& target = executor_.asked();
    const control::Torques wanted = control::drive(command, seen.joints, seen.joint_rates);
    for (std::size_t i = 0; i < torques_.size(); ++i) torques_[i] += lag_ * (scale_ * wanted[i] - torques_[i]);
    const Robot& robot = executor_.controller().robot();
    const control::Torques torques = control::limit_torques(robot, std::span<const double, 12>(state.joint_rates), torques_);
    torques_ = torques;
    std::copy(torques.begin(), torques.end(), data_->ctrl);
    score_.add(state, torques, target, dt_);
    if (!log_.due()) return;
    if (const auto* sense = std::get_if<RobotSense>(&perception_)) {
        const auto judged = sense->judge();
        judged_.push_back({time, judged.error, judged.nees, judged.scale, judged.offset, judged.nees_in_world});
    }
    Sample sample;
    sample.time = time, sample.state = state, sample.torques = torques;
    std::copy_n(data_->sensordata, sample.contacts.size(), sample.contacts.begin());
    sample.progress = target.progress;
    const auto& [front, rear] = target.value.wheels;
    const auto& q = target.value.joints;
    sample.target = {front, rear, q[0], q[1], q[2], q[3], target.value.pitch};
    sample.places = executor_.controller().places();
    log_.add(sample);
}

int Rollout::run(const Chunk& chunk, std::span<const double> noise) {
    for (int k = chunk.first; k < chunk.last; ++k) {
        if (diverged()) return chunk.last;
        if (!(chunk.looked && k == chunk.first)) {
            const std::size_t row = static_cast<std::size_t>(k) * kNoiseWidth;
            const auto drawn = row + kNoiseWidth <= noise.size() ? noise.subspan(row, kNoiseWidth) : std::span<const double>();
            control(perceive(drawn), chunk.moving, chunk.begun + k * dt_);
            const double* found = data_->sensordata;
            const int wheels = static_cast<int>(found[0] + found[4] + found[8] + found[12]);
            if (chunk.loaded || static_cast<int>(found[kAllContacts]) != wheels) return k;
        }
        for (int i = 0; i < substeps_; ++i) mj_step(model_, data_);
    }
    return chunk.last;
}

}  // namespace stairwright::rollout
