#include "stairwright/estimation/estimator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "faces.hpp"
#include "spatial.hpp"

namespace stairwright::estimation {

namespace {

constexpr double kTouching = 0.15;      // of the share of the weight: a wheel that carries less says nothing
constexpr double kVelocityTime = 0.05;  // s, smoothing of the velocity of a wheel's centre
constexpr double kVelocityNoise = 0.006;  // m/s of that, besides what the trunk's velocity is uncertain by
constexpr double kTurningLag = 0.02;   // m/s that it lags behind round an edge
constexpr double kForceAtRest = 0.15;   // of a force's uncertainty in motion
constexpr double kForceSpeed = 0.15;    // m/s of the wheel's centre from which on it is that in motion
constexpr double kRoom = 0.10;          // m to the next face that a pair needs to roll on freely
constexpr double kFarAlong = 0.1;       // m up or down a face: so far the place along it does not drift
constexpr double kHop = 0.1;            // s in the air that are no more than a hop, as after a riser is met fast
constexpr double kHopSpeed = 0.2;       // m/s of the trunk from which on a riser is met so
constexpr double kSure = 0.02;         // s that both faces of a corner, or an edge farther on, must be felt before that counts
constexpr double kLight = 5.0;         // of the least push: less force says little of an edge farther on
constexpr double kLeap = 1e-3;         // m from where the wheel has rolled
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
    const Rotation R = rotation();
    const double side = i % 2 == 0 ? robot_.half_track : -robot_.half_track;
    const Vec3 arm = times(R, {w.place.x, side, w.place.z});
    const std::size_t own = i / 2 == 0 ? kFrontOffset : kRearOffset;
    const Vec2 centre = place_ + offset_[i / 2] + Vec2{arm[0], arm[2]};

    // Rows of the wheel's place: d(R f) = e x R f.
    Error along_x{}, along_z{};
    along_x[kAttitude + 1] = arm[2], along_x[kAttitude + 2] = -arm[1], along_x[kPlace] = along_x[own] = 1.0;
    along_z[kAttitude] = arm[1], along_z[kAttitude + 1] = -arm[0], along_z[kPlace + 1] = along_z[own + 1] = 1.0;
    const Error px = covariance_.times(along_x), pz = covariance_.times(along_z);
    WheelBelief belief;
    belief.centre = centre;
    for (std::size_t k = 0; k < kErrors; ++k) {
        belief.spread.xx += along_x[k] * px[k], belief.spread.xz += along_x[k] * pz[k], belief.spread.zz += along_z[k] * pz[k];
    }
    const double least = noise_.place * noise_.place;
    belief.spread.xx += least, belief.spread.zz += least;
    belief.force = w.felt, belief.traction = w.traction;
    const Vec3 spin = cross3(rate_, {w.place.x, side, w.place.z});
    const Vec3 own_speed = times(R, {spin[0] + w.rate.x, spin[1], spin[2] + w.rate.z});
    const Vec2 moves = {velocity_[0] + own_speed[0], velocity_[2] + own_speed[2]};
    w.velocity += dt / (kVelocityTime + dt) * (moves - w.velocity);
    w.velocity_lag += dt / (kVelocityTime + dt) * (moves - w.velocity - w.velocity_lag);
    // At rest no acceleration mixes with the ground's force.
    const double most = noise_.force * weight_ + 0.15 * norm(w.felt);
    w.force_deviation = belief.force_deviation = most * std::lerp(kForceAtRest, 1.0, std::min(1.0, norm(moves) / kForceSpeed));
    // Whether there is one at all is sure at any speed, but where the wheel is hit or its leg thrown about.
    w.least_push = std::min(most, kForceAtRest * most + w.unsteady);
    const auto low = std::ranges::find_if(low_edges_, [&](const LowEdge& edge) { return is_near(w, edge.first, edge.last); });
    w.low_edge = low == low_edges_.end() ? std::nullopt : std::optional(*low);
    if (w.low_edge) {
        belief.unsure = low->first, belief.unsure_count = low->last + 2 - low->first;  // it may be none
    } else if (const auto drop = std::ranges::find_if(low_drops_, [&](std::size_t k) { return is_near(w, k, k); }); drop != low_drops_.end()) {
        belief.unsure = *drop + 1, belief.unsure_count = 1;
    }
    if (path_.next_drop(w.s) && norm(w.felt) > kTouching * weight_ / 4) look_at_velocity(w, belief);
    belief.unsure_height = noise_.tread_height * noise_.tread_height;
    w.since_clear += moves.x * dt;
    if (w.since_clear > -kClearOfEdge) belief.past = w.clear;
    const CurveMatch on = match(path_, belief, w.s, kWindow);
    // A leg that swings feels a little, too: of a wall it has to be more than that, but where the wheel follows it.
    w.follows = follows(w, on);
    const auto feels = [&](Vec2 n) { return dot(w.felt, n) > std::max(kTouching * weight_ / 4, n.z < kTread && !w.follows ? w.least_push : 0.0); };
    bool touching = feels(on.point.normal) || feels(on.before) || feels(on.after);
    const double corner = nearest_corner(on.s);
    if (std::abs(corner - on.s) < kNearCorner) touching = touching || feels(path_.normal(corner - kBeside)) || feels(path_.normal(corner + kBeside));
    const double before = w.s;
    w.at_corner = on.corner ? w.at_corner + dt : 0.0;
    const bool unsure = on.corner && w.at_corner <= kSure;
    // A force that passes may seem to be that of an edge some centimetres on; a controller that believed it would brake the
    // wheel, and feel what confirms it.
    const bool leaps = !on.corner && path_.pieces()[on.piece].arc && std::abs(on.s - (before + w.rolled)) > kLeap;
    w.leaps = leaps ? w.leaps + dt : 0.0;
    const bool leaping = leaps && w.leaps <= kSure;
    // The other wheel of the pair is where it was: one alone must not be called back.
    const bool stays = leaping || (unsure && std::abs(on.s - before) > kNearCorner);
    w.s = stays ? before + w.rolled : on.s;
    w.aloft = touching ? 0.0 : w.aloft + dt;
    w.landed = touching ? w.landed + dt : 0.0;
    if (!touching && on.s > before) {  // in the air no wheel gets past a corner, unless that is sure
        const std::size_t passed = path_.corner_from(before - kNearCorner);
        // What counts is how far it seems to be along the face after the corner.
        const double sure = kBeyondDoubt * std::sqrt(belief.spread.along({on.point.normal.z, -on.point.normal.x}));
        if (passed < path_.corners().size() && path_.corners()[passed] < on.s && on.s < path_.corners()[passed] + sure) {
            w.s = std::max(before, path_.corners()[passed]);
            const bool hop = std::hypot(velocity_[0], velocity_[2]) > kHopSpeed && w.aloft < kHop;
            estimate_.hanging[i / 2] = estimate_.hanging[i / 2] || !hop;
        }
    }
    if (touching) enter_face(i, on);
    const std::size_t next = path_.corner_from(on.s);
    const double room = next < path_.corners().size() ? path_.corners()[next] - on.s : kRoom;
    const bool tread = !on.corner && on.point.normal.z > kTread;
    const bool round_it = path_.pieces()[on.piece].arc && on.point.normal.x < 0.0;  // an edge that leads up
    estimate_.on_tread[i / 2] = tread && room >= kRoom, estimate_.nearing[i / 2] = (tread && room < kRoom) || round_it || unsure;

    compare_with_map(i, on, belief.spread, dt);
    if (i / 2 == kFront) feel_face_ahead(w, on, belief, dt);
    estimate_.touching[i] = touching;
    estimate_.used_grip[i] = std::abs(w.traction) / std::max(dot(w.felt, on.point.normal), 0.02 * weight_);
    if (!estimate_.touching[i]) return;
    Error error{};
    leave_low_edge(i, on, along_z, centre, error);
    if (!unsure && !(leaping && norm(w.felt) < kLight * w.least_push) && !estimate_.lost) measure_place(i, on, along_x, along_z, centre, dt, error);
    measure_rolling(i, on, readings, along_x, along_z, dt, error);
    correct(error);
    if (on.corner && on.after.x < -kTread)
        for (const std::size_t pair : {0, 1}) estimate_.found[pair] += error[kPlace] + error[kFrontOffset + 2 * pair];
}

// Where an edge may come early the way that its wheel takes says whether it is round it already: its force does not, while
// the wheel hardly leans on its motor, and its height is nothing that the map knows.
void Estimator::look_at_velocity(const WheelState& w, WheelBelief& belief) const {
    belief.velocity = w.velocity;
    const double least = kVelocityNoise * kVelocityNoise;
    // Smoothed, it still falls when the wheel has landed: on a tread that would be less likely than round the next edge.
    const double lags = norm(w.velocity_lag);
    const Vec2 lag = (std::max(lags - kTurningLag, 0.0) / std::max(lags, kTurningLag)) * w.velocity_lag;
    belief.velocity_spread = {covariance_(kVelocity, kVelocity) + least + lag.x * lag.x, covariance_(kVelocity, kVelocity + 2) + lag.x * lag.z,
                              covariance_(kVelocity + 2, kVelocity + 2) + least + lag.z * lag.z};
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

// Whether a wheel is far up a face whose foot it has felt, or down one that it has rolled to round its edge: it is no news
// that it stays there.
bool Estimator::follows(const WheelState& w, const CurveMatch& on) const {
    const std::size_t next = path_.corner_from(on.s);
    if (on.corner) return false;
    if (on.point.normal.x > 0.0) return w.rounded + 1 == on.piece && on.s > path_.pieces()[on.piece].s + kFarAlong;
    if (next == 0) return false;
    const double foot = path_.corners()[next - 1];
    return on.s > foot + kFarAlong && std::abs(w.met - foot) < kBeside;
}

double Estimator::nearest_corner(double s) const {
    const auto& corners = path_.corners();
    const std::size_t k = path_.corner_from(s);
    if (corners.empty()) return s;
    if (k == corners.size() || (k > 0 && s - corners[k - 1] < corners[k] - s)) return corners[k - 1];
    return corners[k];
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
    for (const Vec2 off : offset_) estimate_.lost = estimate_.lost || norm(off) > kMostMapError;
    estimate_.ground = {apart, -1.0 * apart};
}

}  // namespace stairwright::estimation
