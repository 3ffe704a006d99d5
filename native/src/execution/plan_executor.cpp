#include "stairwright/execution/plan_executor.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace stairwright::execution {

using control::Motion;

namespace {

constexpr double kCarries = 0.1;  // of the weight, on a pair of wheels that is to be on the ground
constexpr double kStalled = 0.5;  // s without progress, from which on wheels push

}  // namespace

PlanExecutor::PlanExecutor(control::Controller controller, control::PlanFollower follower, double grip_need, bool mends_map)
    : controller_(std::move(controller)), follower_(std::move(follower)), weighing_(controller_.robot()),
      grip_test_(controller_.robot(), grip_need), leg_fit_(controller_.robot()), legs_apart_(controller_.robot()),
      mends_map_(mends_map) {}

bool PlanExecutor::hangs(const control::Ahead& ahead) const {
    const auto& forces = follower_.target().forces;
    const auto loaded = [&](int pair) { return norm(forces[pair]) > kCarries * controller_.robot().mass() * kGravity; };
    return (ahead.hanging[kFront] && loaded(kFront)) || (ahead.hanging[kRear] && loaded(kRear));
}

void PlanExecutor::watch_map(const estimation::MapError& error) {
    const bool ignored = std::abs(error.s - ignored_) <= MapTolerance::kSamePlace;
    if (map_error_ || !(ignored || tolerance_.covers(error)))
        map_error_ = error;  // while the robot comes to rest, what is found last
    else
        tolerance_.pass(error);
}

control::Torques PlanExecutor::without_motion(control::Torques torques) const {
    const control::Torques& moving = controller_.moving();
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 3 * i; j < 3 * i + 2; ++j) torques[j] -= moving[j] - moving[3 * i + 2];
    return torques;
}

const control::Reference& PlanExecutor::prepare(const control::Reference& drawn, const Perceived& seen, double dt) {
    const bool level = seen.ahead.on_tread[0] && seen.ahead.on_tread[1];
    adapted_ = drawn;
    if (waits_) return adapted_;
    if (!weighing_.over()) {
        adapted_ = weighing_.step(drawn, seen.state, controller_.path(), *seen.places, seen.felt, level, dt);
        waits_ = weighing_.load().has_value();
        return adapted_;
    }
    adapted_ = grip_test_.step(drawn, seen.state, seen.used_grip, level, dt);
    waits_ = grip_test_.over() && grip_test_.slipped();
    if (grip_test_.over()) creep_ = grip_test_.creep();
    if (creep_) controller_.believe_creep(*creep_);
    return adapted_;
}

const control::Reference& PlanExecutor::next_target(const Perceived& seen, bool moving, double time, double dt) {
    if (safe_stop_.why() != control::Stop::none) return stand_;
    moving = moving && (!seen.places || prepared()) && !waits_;
    if (mends_map_ && moving && seen.map_error) watch_map(*seen.map_error);
    const bool halts = map_error_ && !waits_;
    if (halts && (map_error_->pairs == 0 || follower_.rate() <= 0.0)) waits_ = true;
    moving = moving && !waits_ && plan_change_.over();
    const bool on_plan = moving && !seen.ahead.any();
    if (seen.places && on_plan) early_face_.watch_edge(follower_.target(), controller_.path(), *seen.places, dt);
    std::array<double, 4> places = controller_.places();
    for (std::size_t i = 0; i < 4; ++i) places[i] -= early_face_.ahead()[i / 2] - (i / 2 == kRear ? legs_apart_.back() : 0.0);
    const bool advances = on_plan && !early_face_.waits() && !controller_.tips();
    const Motion motion = !advances ? Motion::stop : halts ? Motion::halt : Motion::go;
    const control::Reference& drawn = follower_.advance(places, motion, dt, hangs(seen.ahead));
    if (!seen.places) return drawn;
    if (!prepared() && plan_change_.over()) return prepare(drawn, seen, dt);
    adapted_ = plan_change_.step(drawn, dt);
    const control::Reference held = early_face_.step(adapted_, seen.ahead.found, *seen.places, dt);
    const control::Reference apart = legs_apart_.step(held);
    const WheelPath& path = controller_.path();
    const std::array<Vec2, 2> found = early_face_.ground(path, adapted_, seen.ground), ground = legs_apart_.ground(path, held, found);
    leg_fit_.follow({0.5 * (seen.ahead.found[0] + seen.ahead.found[1]), 0.0});
    const control::Reference fitted = leg_fit_.fit(apart, ground, path, controller_.friction(), dt);
    keep_legs_apart(fitted, found, held.value.wheels[kRear], dt);
    const control::Ahead ahead = moving ? seen.ahead : control::Ahead{};
    const bool stalled = safe_stop_.waited() > kStalled && !controller_.tips();
    adapted_ = face_search_.step(fitted, ahead, *seen.places, stalled, dt);
    const control::Reference& next = adapted_;
    const auto [w, x, y, z] = seen.state.quaternion;
    const double pitch = std::atan2(2 * (x * z + w * y), 1 - 2 * (x * x + y * y));
    const double error = std::remainder(pitch - next.value.pitch, 2 * std::numbers::pi);
    const double roll = std::asin(std::clamp(2 * (y * z + w * x), -1.0, 1.0));
    if (safe_stop_.watch(follower_.position(), moving && !follower_.arrived(), error, roll, seen.lost, dt) == control::Stop::none) return next;
    stopped_at_ = time;
    stand_ = controller_.standing(seen.state, *seen.places);
    stand_.progress = next.progress;
    return stand_;
}

// Rear legs go back at once with their wheels, not as they follow the ground.
void PlanExecutor::keep_legs_apart(const control::Reference& fitted, const std::array<Vec2, 2>& ground, double rear, double dt) {
    const WheelPath& path = controller_.path();
    const double before = legs_apart_.back();
    legs_apart_.watch(adapted_, fitted, path, ground, dt);
    if (legs_apart_.back() != before) leg_fit_.follow(kRear, path.centre(rear - legs_apart_.back()) - path.centre(rear - before));
}

control::Command PlanExecutor::step(const Perceived& seen, bool moving, double time, double dt) {
    asked_ = next_target(seen, moving, time, dt);
    return controller_.command(seen.state, asked_, seen.places, seen.feels_ground);
}

void PlanExecutor::begin_from(const Perceived& seen) {
    if (!seen.places) throw std::invalid_argument("the places of the wheels must be known");
    plan_change_.begin(controller_.standing(seen.state, *seen.places), follower_.first());
}

void PlanExecutor::adopt(control::PlanFollower follower, double friction) {
    follower_ = std::move(follower);
    controller_.believe(friction);
    plan_change_.begin(safe_stop_.why() == control::Stop::none ? adapted_ : stand_, follower_.first());
    safe_stop_ = {};
    early_face_.reset();
    waits_ = false;
}

void PlanExecutor::carry(const Robot& robot, double grip_need) {
    controller_.believe(robot);
    grip_test_ = control::GripTest(robot, grip_need);
    leg_fit_ = control::LegFit(robot);
}

void PlanExecutor::correct_map(const WheelPath& path, Vec2 shift) {
    if (!map_error_) throw std::invalid_argument("there is no error of the map to correct");
    adapted_.value.com += shift, adapted_.value.trunk += shift;
    controller_.believe(path);
    leg_fit_.reset();
    tolerance_.forget();
    map_error_.reset();
}

void PlanExecutor::give_up() {
    go_on();
    safe_stop_.block();
}

void PlanExecutor::go_on() {
    if (map_error_) ignored_ = map_error_->s;
    map_error_.reset();
    waits_ = false;
}

}  // namespace stairwright::execution
