#include "stairwright/control/weighing.hpp"

#include <cmath>
#include <limits>

#include "inertial_loads.hpp"
#include "measurement.hpp"

namespace stairwright::control {

namespace {

constexpr double kSettles = 0.3;  // s until what the robot carries has sunk into its legs
constexpr double kWeighs = 0.2;   // s of which the mean counts where it cannot nod
// Of the robot's mass, that may be an error: 5 % of the motors' torque constants, and 5 % of its own mass, which plans
// stand.
constexpr double kDoubt = 0.1;
// m, of the mass centre along and up, that plans stand; it is found to 2 and 4 mm. Dry friction of 0.3 Nm in the joints of a
// robot of 12 to 20 kg looks like 5 and up to 15.
constexpr double kShifted = 0.005, kShiftedUp = 0.008;

}  // namespace

Reference Weighing::step(const Reference& planned, const RobotState& state, const WheelPath& path, const std::array<double, 4>& places,
                         const std::optional<std::array<Vec2, 4>>& felt, bool level, double dt) {
    if (over_) return planned;
    time_ += dt;
    if (time_ < kSettles) return planned;
    told_ = told_ && felt && level;
    if (!nod_) {
        over_ = !told_;
        if (over_) return planned;
        nod_.emplace(robot_, planned, path);
    }
    const bool nods = nod_->duration() > 0.0;
    const Reference asked = nods ? nod_->at(time_ - kSettles) : planned;
    if (told_) weigh(asked, state, path, places, *felt);
    over_ = time_ > kSettles + (nods ? nod_->duration() : kWeighs);
    if (over_ && told_) conclude();
    return over_ ? planned : asked;
}

void Weighing::weigh(const Reference& asked, const RobotState& state, const WheelPath& path, const std::array<double, 4>& places,
                     const std::array<Vec2, 4>& felt) {
    const Measurement m = measure(robot_.robot, robot_.mass, state);
    // At the mass centre's height, where what moves it along has no moment.
    const Vec2 about = {state.position[0], m.com.z};
    double moment = inertial_loads(robot_.robot, asked).moment;
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec2 force = felt[i];
        const Vec2 contact = m.legs[i].wheel - path.radius() * path.normal(places[i]) - about;
        weight_ += force.z, moment += contact.x * force.z - contact.z * force.x;
    }
    const Terms terms = {std::cos(m.pitch), std::sin(m.pitch), asked.acceleration.pitch};
    for (std::size_t i = 0; i < 3; ++i) {
        moment_[i] += terms[i] * moment, own_[i] += terms[i] * (m.com.x - about.x);
        for (std::size_t j = 0; j < 3; ++j) normal_[i][j] += terms[i] * terms[j];
    }
    steps_ += 1.0;
}

// Elimination in the order of the terms: the matrix is positive definite.
Vec2 Weighing::fitted(Terms summed) const {
    auto a = normal_;
    if (nod_->duration() == 0.0) return {summed[0] / a[0][0], 0.0};
    for (std::size_t k = 0; k < 2; ++k)
        for (std::size_t i = k + 1; i < 3; ++i) {
            const double part = a[i][k] / a[k][k];
            summed[i] -= part * summed[k];
            for (std::size_t j = k; j < 3; ++j) a[i][j] -= part * a[k][j];
        }
    const double turning = summed[2] / a[2][2];
    const double up = (summed[1] - a[1][2] * turning) / a[1][1];
    return {(summed[0] - a[0][1] * up - a[0][2] * turning) / a[0][0], up};
}

void Weighing::conclude() {
    const double believed = robot_.mass, weight = weight_ / steps_, mass = weight / kGravity, added = mass - believed;
    const Vec2 own = fitted(own_), found = (1.0 / weight) * fitted(moment_), shift = found - own;
    if (added >= kDoubt * believed) {
        Vec2 place = (1.0 / added) * (mass * found - believed * own);
        if (nod_->duration() == 0.0) place.z = std::numeric_limits<double>::quiet_NaN();
        load_ = Load{added, place, {}};
    } else if (std::abs(shift.x) >= kShifted || std::abs(shift.z) >= kShiftedUp) {
        load_ = Load{0.0, {}, shift};
    }
}

}  // namespace stairwright::control
