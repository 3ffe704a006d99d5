// One control step of a plan, from what is perceived to what the drives are told: weighing, test of the grip, the plan's progress,
// legs that fit the ground, search for faces, safe stop, balance controller. The rollout and the player on a robot run
// the same one.
#pragma once

#include <optional>
#include <utility>

#include "stairwright/control/early_face.hpp"
#include "stairwright/control/grip_test.hpp"
#include "stairwright/control/leg_fit.hpp"
#include "stairwright/control/legs_apart.hpp"
#include "stairwright/control/plan_change.hpp"
#include "stairwright/control/plan_follower.hpp"
#include "stairwright/control/safe_stop.hpp"
#include "stairwright/control/weighing.hpp"
#include "stairwright/execution/map_tolerance.hpp"
#include "stairwright/execution/perceived.hpp"

namespace stairwright::execution {

class PlanExecutor {
  public:
    // `grip_need` is the friction that the ground is tested for before the start, 0 for no test [1]. `mends_map`: whether
    // the robot stands and waits where it finds an error of the map. A plan that moves fast must not stop just anywhere.
    PlanExecutor(control::Controller controller, control::PlanFollower follower, double grip_need, bool mends_map);

    // What to do now. `moving`: whether the plan may advance; `time` and the time step `dt` [s]. What only a robot
    // that senses by itself does, it does where `seen.places` are known.
    control::Command step(const Perceived& seen, bool moving, double time, double dt);

    // Of torques that the motors give [Nm] what the ground's forces ask for: less what moves the legs as planned. What spins
    // wheels up the estimator sees itself.
    control::Torques without_motion(control::Torques torques) const;

    // A robot that stands otherwise than the plan begins gets there within some tenths of a second, and waits for that.
    void begin_from(const Perceived& seen);

    // The plan goes on, or another one from now on with the friction that it was made for [1]. The robot stands and
    // waits for this after a weighing that found a load, and after a test of the grip in which wheels slipped.
    void go_on();
    void adopt(control::PlanFollower follower, double friction);
    // Errors of the map at which the robot does not wait: each tread by so much up, each face along [m].
    void tolerate(double height, double place) { tolerance_.set(height, place); }
    // Stop where it waits: there is no way on.
    void give_up();
    bool waits() const { return waits_; }
    // What the weighing before the start found that nobody has told of.
    const std::optional<control::Load>& load() const { return weighing_.load(); }
    // The robot with that from now on, which tests the ground for another friction [1]; another plan has to follow.
    void carry(const Robot& robot, double grip_need);
    // What the test of the grip before the start found, if wheels slipped.
    const std::optional<control::Grip>& slipped() const { return grip_test_.slipped(); }
    // The map's error that the robot waits for somebody to decide on.
    const std::optional<estimation::MapError>& map_error() const { return map_error_; }
    // A map without that error from now on, on which the robot's place is shifted [m]; another plan has to follow.
    void correct_map(const WheelPath& path, Vec2 shift);
    // How wheels creep under traction [m/s], once after the test of the grip has found it: the estimator is to know.
    std::optional<double> take_creep() { return std::exchange(creep_, std::nullopt); }

    // Why the robot has given up, and since when [s]; only one that senses by itself does.
    control::Stop stop() const { return safe_stop_.why(); }
    double stopped_at() const { return stopped_at_; }

    const control::Controller& controller() const { return controller_; }
    const control::PlanFollower& follower() const { return follower_; }
    // The plan's set point, or where the robot gave up that to stand there.
    const control::Reference& target() const {
        return safe_stop_.why() == control::Stop::none ? follower_.target() : stand_;
    }
    // What was asked for at the last step.
    const control::Reference& asked() const { return asked_; }

  private:
    // Whether wheels hang in the air that are to carry weight: not where the plan itself hardly loads them.
    bool hangs(const control::Ahead& ahead) const;
    void watch_map(const estimation::MapError& error);
    void keep_legs_apart(const control::Reference& fitted, const std::array<Vec2, 2>& ground, double rear, double dt);
    // The plan's set point while the robot finds out what it has to know before it starts.
    const control::Reference& prepare(const control::Reference& drawn, const Perceived& seen, double dt);
    bool prepared() const { return weighing_.over() && grip_test_.over(); }
    const control::Reference& next_target(const Perceived& seen, bool moving, double time, double dt);

    control::Controller controller_;
    control::PlanFollower follower_;
    control::Weighing weighing_;
    control::GripTest grip_test_;
    control::PlanChange plan_change_;
    control::SafeStop safe_stop_;
    control::LegFit leg_fit_;
    control::FaceSearch face_search_;
    control::EarlyFace early_face_;
    control::LegsApart legs_apart_;
    std::optional<estimation::MapError> map_error_;
    MapTolerance tolerance_;
    std::optional<double> creep_;   // found and not taken yet
    double ignored_ = -1e9;         // where an error of the map was let pass [m]
    bool mends_map_;
    bool waits_ = false;            // for somebody to decide
    control::Reference adapted_{};  // what is asked for, with legs that fit the ground as it is
    control::Reference stand_{};    // what is asked for after the stop
    control::Reference asked_{};
    double stopped_at_ = 0.0;
};

}  // namespace stairwright::execution
