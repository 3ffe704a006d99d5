#include "stairwright/estimation/estimator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "faces.hpp"
#include "spatial.hpp"

namespace stairwright::estimation {

namespace {

constexpr double kLight = 5.0;         // of the least push: less force says little of an edge farther on
constexpr double kMostScale = 0.025;   // of the wheels: more is slip
constexpr double kContradicted = 0.05;  // s
constexpr double kWrongVelocity = 0.5;  // m/s
constexpr double kMostMapError = 0.12;  // m

Error initial(const Noise& n) {
    Error d{};
    d[kAttitude] = d[kAttitude + 1] = n.start_tilt, d[kAttitude + 2] = n.start_heading;
    d[kVelocity] = d[kVelocity + 1] = d[kVelocity + 2] = 0.02;
    d[kPlace] = n.start_place, d[kPlace + 1] = n.start_height;
    for (std::size_t i = 0; i < 3; ++i) d[kGyroBias + i] = n.start_gyro_bias, d[kForceBias + i] = n.start_force_bias;
    d[kScale] = n.scale;
    for (const std::size_t at : {kFrontOffset, kRearOffset}) d[at] = d[at + 1] = 0.001;
    return d;
}

}  // namespace

Estimator::Estimator(Robot robot, WheelPath path, const Start& start, const Noise& noise)
    : robot_(std::move(robot)), path_(std::move(path)), noise_(noise), weight_(robot_.mass() * kGravity),
      attitude_{std::cos(0.5 * start.pitch), 0.0, std::sin(0.5 * start.pitch), 0.0}, place_(start.place), covariance_(initial(noise)) {
    scale_ = -noise.deflection / path_.radius();
    for (WheelState& w : wheels_) w.s = std::numeric_limits<double>::quiet_NaN(), w.felt = w.felt_before = {0.0, weight_ / 4};
    note_low_edges();
}

Estimator::Rotation Estimator::rotation() const {
    const auto [w, x, y, z] = attitude_;
    return {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
             {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
             {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
}

const Estimate& Estimator::step(const Readings& readings, double dt) {
    predict(readings, dt);
    see_legs(readings, dt);
    estimate_.hanging = {}, estimate_.found = {};
    for (WheelState& w : wheels_) w.missed = w.contradicts = false;
    for (int i = 0; i < 4; ++i) measure(i, readings, dt);
    for (int i = 2; i < 4; ++i) recall(wheels_[i]);
    come_to_landing();
    // One wheel that has found the face is enough: a robot that comes obliquely does not touch with both.
    for (int pair = 0; pair < 2; ++pair) estimate_.searching[pair] = wheels_[2 * pair].missed && wheels_[2 * pair + 1].missed;
    started_ = true;
    believe_wheels_again(dt);
    find_map_error();
    report(readings);
    return estimate_;
}

void Estimator::predict(const Readings& readings, double dt) {
    Vec3 rate, force;
    for (int i = 0; i < 3; ++i) rate[i] = readings.angular_rate[i] - gyro_bias_[i], force[i] = readings.specific_force[i] - force_bias_[i];
    // The force was felt on the way here: with the attitude half a step back.
    const Rotation R = rotation();
    const Vec3 pull = times(R, force);
    covariance_.propagate(R, pull, dt);
    place_ += Vec2{velocity_[0], velocity_[2]} * dt;
    for (int i = 0; i < 3; ++i) velocity_[i] += dt * (pull[i] - (i == 2 ? kGravity : 0.0));
    attitude_ = product(attitude_, turn({rate[0] * dt, rate[1] * dt, rate[2] * dt}));
    normalise(attitude_);
    rate_ = rate;
    const Noise& n = noise_;
    const auto square = [](double v) { return v * v; };
    for (std::size_t i = 0; i < 3; ++i) {
        covariance_.add_noise(kAttitude + i, square(n.gyro * dt));
        covariance_.add_noise(kVelocity + i, square(n.specific_force * dt));
        covariance_.add_noise(kGyroBias + i, square(n.gyro_bias) * dt);
        covariance_.add_noise(kForceBias + i, square(n.force_bias) * dt);
    }
    // The map is the less sure the farther a pair has rolled over it.
    for (int pair = 0; pair < 2; ++pair) {
        const double rolled = 0.5 * (std::abs(wheels_[2 * pair].rolled) + std::abs(wheels_[2 * pair + 1].rolled));
        covariance_.add_noise(kFrontOffset + 2 * pair, square(n.map_along) * rolled);
        covariance_.add_noise(kFrontOffset + 2 * pair + 1, square(n.map_height) * rolled);
    }
}

void Estimator::measure(int i, const Readings& readings, double dt) {
    WheelState& w = wheels_[i];
    const WheelPlace place = place_of(i);
    const WheelBelief belief = believed(i, place, dt);
    const CurveMatch on = match(path_, belief, w.s, kWindow);
    w.follows = follows(w, on);
    const bool touching = touches(w, on);
    follow(i, on, belief, touching, dt);
    if (touching) enter_face(i, on);
    look_ahead(i, on);
    compare_with_map(i, on, belief.spread, dt);
    if (i / 2 == kFront) feel_face_ahead(w, on, belief, dt);
    estimate_.touching[i] = touching;
    estimate_.used_grip[i] = std::abs(w.traction) / std::max(dot(w.felt, on.point.normal), 0.02 * weight_);
    if (!touching) return;
    Error error{};
    leave_low_edge(i, on, place, error);
    const bool says_little = is_leaping(w) && norm(w.felt) < kLight * w.least_push;
    if (!is_passing(w, on) && !says_little && !estimate_.lost) measure_place(i, on, place, dt, error);
    measure_rolling(i, on, readings, place, dt, error);
    correct(error);
    if (on.corner && on.after.x < -kTread)
        for (const std::size_t pair : {0, 1}) estimate_.found[pair] += error[kPlace] + error[kFrontOffset + 2 * pair];
}

// A filter that is surer of a wrong velocity, as after a slide, than wheels can tell it turns down all that they say, for
// ever. What none of them can be reconciled with it is to doubt.
void Estimator::believe_wheels_again(double dt) {
    bool touching = false, contradicted = true;
    for (int i = 0; i < 4; ++i)
        if (estimate_.touching[i]) touching = true, contradicted = contradicted && wheels_[i].contradicts;
    contradicted_ = touching && contradicted ? contradicted_ + dt : 0.0;
    if (contradicted_ < kContradicted) return;
    contradicted_ = 0.0;
    for (const std::size_t k : {0, 2}) covariance_.add_noise(kVelocity + k, kWrongVelocity * kWrongVelocity);
}

void Estimator::correct(const Error& e) {
    attitude_ = product(turn({e[kAttitude], e[kAttitude + 1], e[kAttitude + 2]}), attitude_);
    normalise(attitude_);
    for (std::size_t i = 0; i < 3; ++i) {
        velocity_[i] += e[kVelocity + i], gyro_bias_[i] += e[kGyroBias + i], force_bias_[i] += e[kForceBias + i];
        rate_[i] -= e[kGyroBias + i];
    }
    place_ += {e[kPlace], e[kPlace + 1]};
    scale_ = std::clamp(scale_ + e[kScale], -kMostScale, kMostScale);
    offset_[0] += {e[kFrontOffset], e[kFrontOffset + 1]};
    offset_[1] += {e[kRearOffset], e[kRearOffset + 1]};
}

void Estimator::report(const Readings& readings) {
    control::RobotState& out = estimate_.state;
    const Vec2 at = place_ + 0.5 * (offset_[0] + offset_[1]);
    out.position = {at.x, 0.0, at.z};
    out.quaternion = attitude_;
    out.joints = readings.joints, out.joint_rates = readings.joint_rates;
    out.velocity = velocity_, out.angular_velocity = rate_;
    for (int i = 0; i < 4; ++i) estimate_.places[i] = wheels_[i].s;
    const Vec2 apart = 0.5 * (offset_[1] - offset_[0]);
    // Treads may each be off by what the plan stands: many of them come to more.
    for (const Vec2 off : offset_) estimate_.lost = estimate_.lost || norm(off - Vec2{0.0, settled_}) > kMostMapError;
    estimate_.ground = {apart, -1.0 * apart};
}

}  // namespace stairwright::estimation
