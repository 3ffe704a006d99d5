#include "stairwright/control/weighing.hpp"

#include <cmath>

#include "measurement.hpp"

namespace stairwright::control {

namespace {

constexpr double kSettles = 0.3;  // s until what the robot carries has sunk into its legs
constexpr double kWeighs = 0.2;   // s of which the mean counts
// Of the robot's mass, that may be an error: 5 % of the motors' torque constants, and 5 % of its own mass, which plans
// stand.
constexpr double kDoubt = 0.1;

}  // namespace

void Weighing::step(const RobotState& state, const WheelPath& path, const std::array<double, 4>& places,
                    const std::optional<std::array<Vec2, 4>>& felt, bool level, double dt) {
    if (over_) return;
    time_ += dt;
    if (time_ < kSettles) return;
    if (!felt || !level) {
        over_ = true;
        return;
    }
    const Measurement m = measure(robot_, robot_.mass(), state);
    // On the ground below the trunk point, where forces along the ground have no moment.
    const double ground = 0.5 * (path.centre(places[0]).z + path.centre(places[2]).z) - path.radius();
    const Vec2 below = {state.position[0], ground};
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec2 force = (*felt)[i];
        const Vec2 contact = m.legs[i].wheel - path.radius() * path.normal(places[i]) - below;
        weight_ += force.z, moment_ += contact.x * force.z - contact.z * force.x;
    }
    own_ += m.com.x - below.x, steps_ += 1.0;
    over_ = time_ > kSettles + kWeighs;
    if (over_) conclude();
}

void Weighing::conclude() {
    const double own_mass = robot_.mass(), mass = weight_ / steps_ / kGravity;
    const double added = mass - own_mass;
    if (added < kDoubt * own_mass) return;
    load_ = Load{added, (moment_ / kGravity - own_mass * own_) / steps_ / added};
}

}  // namespace stairwright::control
