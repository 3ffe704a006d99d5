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
constexpr double kCarries = 0.1;  // of the weight, on a pair of wheels that is to be on the ground
constexpr double kSamePlace = 0.15;  // m; an error of the map that was let pass is not told again so near
constexpr int kAllContacts = 16;  // the sensor that counts every contact; before it 4 numbers a wheel

}  // namespace

Rollout::Rollout(const mjModel* model, mjData* data, control::Controller controller, control::PlanFollower follower,
                 Perception perception, const Motors& motors, std::size_t log_every, int substeps, double grip_need)
    : model_(model), data_(data), controller_(std::move(controller)), follower_(std::move(follower)),
      perception_(std::move(perception)), scale_(motors.scale),
      grip_test_(controller_.robot(), grip_need), leg_fit_(controller_.robot()), log_(log_every), substeps_(substeps), dt_(substeps * model->opt.timestep) {
    if (model->nq != control::kPositions || model->nv != control::kVelocities || model->nu != 12 ||
        model->nsensordata <= kAllContacts)
        throw std::invalid_argument("the model is not one of a robot with four wheeled legs");
    if (substeps < 1) throw std::invalid_argument("substeps must be at least 1");
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
        const RobotState& state = ideal->perceive(truth(), noise);
        return {state, {}, {}, {}, {}, {}, state.joints, state.joint_rates};
    }
    return std::get<RobotSense>(perception_).perceive(truth(), torques_, dt_);
}

const control::Reference& Rollout::target(const Perceived& seen, bool moving, double time) {
    if (safe_stop_.why() != control::Stop::none) return stand_;
    moving = moving && grip_test_.over() && !waits_;
    if (moving && seen.map_error && !map_error_ && std::abs(seen.map_error->s - ignored_) > kSamePlace) map_error_ = seen.map_error, waits_ = true;
    moving = moving && !waits_ && plan_change_.over();
    const bool searching = moving && seen.ahead.any();
    bool hanging = false;
    for (int pair = 0; pair < 2; ++pair)  // not where the plan itself hardly loads the wheels
        hanging = hanging || (seen.ahead.hanging[pair] && norm(follower_.target().forces[pair]) > kCarries * controller_.robot().mass() * kGravity);
    const control::Reference& drawn = follower_.advance(controller_.places(), moving && !searching, dt_, hanging);
    if (!seen.places) return drawn;
    if (!grip_test_.over()) {
        adapted_ = grip_test_.step(drawn, seen.state, seen.used_grip, seen.ahead.on_tread[0] && seen.ahead.on_tread[1], dt_);
        waits_ = grip_test_.over() && grip_test_.slipped();
        if (grip_test_.over() && grip_test_.creep()) std::get<RobotSense>(perception_).estimator().believe_creep(*grip_test_.creep());
        return adapted_;
    }
    adapted_ = plan_change_.step(drawn, dt_);
    adapted_ = face_search_.step(leg_fit_.fit(adapted_, seen.ground, dt_), searching ? seen.ahead : control::Ahead{}, *seen.places, dt_);
    const control::Reference& next = adapted_;
    const auto [w, x, y, z] = seen.state.quaternion;
    const double pitch = std::atan2(2 * (x * z + w * y), 1 - 2 * (x * x + y * y));
    const double error = std::remainder(pitch - next.value.pitch, 2 * std::numbers::pi);
    if (safe_stop_.watch(follower_.way(), moving && !follower_.arrived(), error, std::asin(std::clamp(2 * (y * z + w * x), -1.0, 1.0)), dt_) ==
        control::Stop::none)
        return next;
    stopped_at_ = time;
    stand_ = controller_.standing(seen.state, *seen.places);
    stand_.progress = next.progress;
    return stand_;
}

void Rollout::adopt(control::PlanFollower follower, double friction) {
    follower_ = std::move(follower);
    controller_.believe(friction);
    plan_change_.begin(adapted_, follower_.first());
    safe_stop_ = {};
    waits_ = false;
}

void Rollout::correct_map(const WheelPath& path) {
    auto* sense = std::get_if<RobotSense>(&perception_);
    if (sense == nullptr || !map_error_) throw std::invalid_argument("there is no error of the map to correct");
    const Vec2 shift = sense->estimator().correct_map(path, *map_error_);
    adapted_.value.com += shift, adapted_.value.trunk += shift;
    controller_.believe(path);
    leg_fit_.reset();
    map_error_.reset();
}

void Rollout::go_on() {
    if (map_error_) ignored_ = map_error_->s;
    map_error_.reset();
    waits_ = false;
}

void Rollout::control(const Perceived& seen, bool moving, double time) {
    const RobotState state = truth();
    const control::Reference& target = this->target(seen, moving, time);
    const control::Command command = controller_.command(seen.state, target, 0.0, seen.places);
    const control::Torques wanted = control::drive(command, seen.joints, seen.joint_rates);
    for (std::size_t i = 0; i < torques_.size(); ++i) torques_[i] += lag_ * (scale_ * wanted[i] - torques_[i]);
    const control::Torques torques = control::limit_torques(controller_.robot(), std::span<const double, 12>(state.joint_rates), torques_);
    torques_ = torques;
    std::copy(torques.begin(), torques.end(), data_->ctrl);
    score_.add(state, torques, target, dt_);
    if (!log_.due()) return;
    if (const auto* sense = std::get_if<RobotSense>(&perception_)) {
        const auto judged = sense->judge();
        judged_.push_back({time, judged.error, judged.nees, judged.scale, judged.offset});
    }
    Sample sample;
    sample.time = time, sample.state = state, sample.torques = torques;
    std::copy_n(data_->sensordata, sample.contacts.size(), sample.contacts.begin());
    sample.progress = target.progress;
    const auto& [front, rear] = target.value.wheels;
    const auto& q = target.value.joints;
    sample.target = {front, rear, q[0], q[1], q[2], q[3], target.value.pitch};
    sample.places = controller_.places();
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
