#include "stairwright/control/plan_follower.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "stairwright/whole.hpp"

namespace stairwright::control {

namespace {

constexpr double kHurry = 1.5;            // how much faster than planned it may follow a robot that is ahead
constexpr double kHangingLead = 0.005;    // m
constexpr double kRateAcceleration = 1.0; // m/s^2 of the plan's rate, where the plan itself asks for no more

constexpr double kHalting = 0.5;          // m/s^2 of the centre of mass; stopped at once, a trunk that swings would tip the robot
constexpr double kBraking = 2.0;          // of what the plan brakes by: a rate that is above the plan's must come down to it

using Row = std::array<double, kReferenceWidth>;

double mix(double a, double b, double share) { return a + share * (b - a); }

}  // namespace

PlanFollower::PlanFollower(double start, double step, std::vector<Reference> rows, std::vector<double> speeds, double maximum_lead)
    : start_(start), step_(step), maximum_lead_(maximum_lead), rows_(std::move(rows)), speeds_(std::move(speeds)), position_(start) {
    if (rows_.size() < 2 || speeds_.size() != rows_.size()) throw std::invalid_argument("a plan needs two rows, and a speed for each");
    if (!(step > 0.0) || !(maximum_lead > 0.0)) throw std::invalid_argument("step and maximum_lead must be positive");
}

PlanFollower::Spot PlanFollower::spot(double position) const {
    const std::size_t last = rows_.size() - 1;
    const double at = std::min(std::max((position - start_) / step_, 0.0), static_cast<double>(last));
    const std::size_t k = whole_part(at, last - 1);
    return {k, at - static_cast<double>(k)};
}

// Of the rate, by the plan's own times [m/s^2].
double PlanFollower::planned_acceleration(Spot at) const {
    const double slow = speeds_[at.row], fast = speeds_[at.row + 1];
    return mix(slow, fast, at.share) * (fast - slow) / step_;
}

// Of the rate, by which the centre of mass is halted [m/s^2].
double PlanFollower::gentle_braking(Spot at) const {
    return kHalting / std::max(norm(rows_[at.row].rate.com), 1e-6);
}

double PlanFollower::wheel_lag(Spot at, const std::array<double, 4>& places) const {
    if (std::isnan(places[0])) return 0.0;
    const Reference &a = rows_[at.row], &b = rows_[at.row + 1];
    const double df = mix(a.rate.wheels[0], b.rate.wheels[0], at.share), dr = mix(a.rate.wheels[1], b.rate.wheels[1], at.share);
    const double front = mix(a.value.wheels[0], b.value.wheels[0], at.share) - 0.5 * (places[0] + places[1]);
    const double rear = mix(a.value.wheels[1], b.value.wheels[1], at.share) - 0.5 * (places[2] + places[3]);
    // Along the plan's own direction, so that it also holds where a wheel rolls back.
    const double lag = (front * df + rear * dr) / std::max(df * df + dr * dr, 1e-6);
    return lag * (0.5 * (std::abs(df) + std::abs(dr)));  // of wheels, not of a trunk that swings
}

const Reference& PlanFollower::advance(const std::array<double, 4>& places, Motion motion, double dt, bool hanging) {
    const Spot now = spot(position_);
    lag_ = wheel_lag(now, places);
    const double most = hanging ? std::min(kHangingLead, maximum_lead_) : maximum_lead_;
    double rate = 0.0;
    if (motion == Motion::go) {
        const double allowed = mix(speeds_[now.row], speeds_[now.row + 1], now.share);
        if (lag_ >= 0.0)
            rate = allowed * std::min(1.0, std::max(-0.5, 2.0 * (most - lag_) / most));
        else
            rate = allowed * std::min(kHurry, 1.0 - lag_ / maximum_lead_ * (kHurry - 1.0));
    }
    const double planned = planned_acceleration(now);
    const double faster = std::max(kRateAcceleration, planned), abrupt = std::max(4 * faster, kBraking * -planned);
    const double slower = motion == Motion::halt ? std::min(abrupt, std::max(gentle_braking(now), kBraking * -planned)) : abrupt;
    rate = std::min(std::max(rate, rate_ - slower * dt), rate_ + faster * dt);
    const double end = start_ + step_ * static_cast<double>(rows_.size() - 1);
    const double position = std::min(std::max(position_ + rate * dt, start_), end);
    rate_ = (position - position_) / dt;
    position_ = position;
    set_target(spot(position_));
    return target_;
}

void PlanFollower::set_target(Spot at) {
    const Row a = std::bit_cast<Row>(rows_[at.row]), b = std::bit_cast<Row>(rows_[at.row + 1]);
    Row mixed;
    for (std::size_t j = 0; j < mixed.size(); ++j) mixed[j] = mix(a[j], b[j], at.share);
    target_ = std::bit_cast<Reference>(mixed);
    target_.lean = rows_[at.share < 0.5 ? at.row : at.row + 1].lean;
    // Speeding up or slowing down as the plan wants it, not as the lead does: that is noise.
    const double rate = rate_, share = rate > 0.0 ? rate / mix(speeds_[at.row], speeds_[at.row + 1], at.share) : 0.0;
    const double gain = share * share * planned_acceleration(at);
    auto rates = std::bit_cast<std::array<double, kPlannedWidth>>(target_.rate);
    auto accelerations = std::bit_cast<std::array<double, kPlannedWidth>>(target_.acceleration);
    for (std::size_t j = 0; j < kPlannedWidth; ++j) {
        accelerations[j] = accelerations[j] * rate * rate + rates[j] * gain;
        rates[j] *= rate;
    }
    target_.rate = std::bit_cast<Planned>(rates);
    target_.acceleration = std::bit_cast<Planned>(accelerations);
}

}  // namespace stairwright::control
