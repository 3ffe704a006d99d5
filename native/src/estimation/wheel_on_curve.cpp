// Where a wheel may be on the wheel-centre curve by what the filter believes and the wheel feels, and where it is from now on.
#include "stairwright/estimation/estimator.hpp"

#include <algorithm>
#include <cmath>

#include "faces.hpp"
#include "spatial.hpp"

namespace stairwright::estimation {

namespace {

constexpr double kTouching = 0.15;        // of the share of the weight: a wheel that carries less says nothing
constexpr double kVelocityTime = 0.05;    // s, smoothing of the velocity of a wheel's centre
constexpr double kVelocityNoise = 0.006;  // m/s of that, besides what the trunk's velocity is uncertain by
constexpr double kTurningLag = 0.02;      // m/s that it lags behind round an edge
constexpr double kForceAtRest = 0.15;     // of a force's uncertainty in motion
constexpr double kForceSpeed = 0.15;      // m/s of the wheel's centre from which on it is that in motion
constexpr double kRoom = 0.10;            // m to the next face that a pair needs to roll on freely
constexpr double kFarAlong = 0.1;         // m up or down a face: so far the place along it does not drift
constexpr double kHop = 0.1;              // s in the air that are no more than a hop, as after a riser is met fast
constexpr double kHopSpeed = 0.2;         // m/s of the trunk from which on a riser is met so
constexpr double kSure = 0.02;            // s that both faces of a corner, or an edge farther on, must be felt before that counts
constexpr double kLeap = 1e-3;            // m from where the wheel has rolled

}  // namespace

Estimator::Vec3 Estimator::arm_of(int i) const {
    return {wheels_[i].place.x, i % 2 == 0 ? robot_.half_track : -robot_.half_track, wheels_[i].place.z};
}

Estimator::Vec3 Estimator::velocity_of(int i) const {
    const WheelState& w = wheels_[i];
    const Vec3 spin = cross3(rate_, arm_of(i)), own = times(rotation(), {spin[0] + w.rate.x, spin[1], spin[2] + w.rate.z});
    return {velocity_[0] + own[0], velocity_[1] + own[1], velocity_[2] + own[2]};
}

// The rows are those of d(R f) = e x R f.
Estimator::WheelPlace Estimator::place_of(int i) const {
    const Vec3 arm = times(rotation(), arm_of(i));
    const std::size_t own = i / 2 == 0 ? kFrontOffset : kRearOffset;
    WheelPlace place;
    place.centre = place_ + offset_[i / 2] + Vec2{arm[0], arm[2]};
    place.along_x[kAttitude + 1] = arm[2], place.along_x[kAttitude + 2] = -arm[1], place.along_x[kPlace] = place.along_x[own] = 1.0;
    place.along_z[kAttitude] = arm[1], place.along_z[kAttitude + 1] = -arm[0], place.along_z[kPlace + 1] = place.along_z[own + 1] = 1.0;
    return place;
}

WheelBelief Estimator::believed(int i, const WheelPlace& place, double dt) {
    WheelState& w = wheels_[i];
    WheelBelief belief;
    belief.centre = place.centre;
    const Error px = covariance_.times(place.along_x), pz = covariance_.times(place.along_z);
    for (std::size_t k = 0; k < kErrors; ++k)
        belief.spread.xx += place.along_x[k] * px[k], belief.spread.xz += place.along_x[k] * pz[k], belief.spread.zz += place.along_z[k] * pz[k];
    const double least = noise_.place * noise_.place;
    belief.spread.xx += least, belief.spread.zz += least;

    const Vec3 speed = velocity_of(i);
    const Vec2 moves = {speed[0], speed[2]};
    w.velocity += dt / (kVelocityTime + dt) * (moves - w.velocity);
    w.velocity_lag += dt / (kVelocityTime + dt) * (moves - w.velocity - w.velocity_lag);

    belief.force = w.felt, belief.traction = w.traction;
    // At rest no acceleration mixes with the ground's force.
    const double most = noise_.force * weight_ + 0.15 * norm(w.felt);
    w.force_deviation = belief.force_deviation = most * std::lerp(kForceAtRest, 1.0, std::min(1.0, norm(moves) / kForceSpeed));
    // Whether there is one at all is sure at any speed, but where the wheel is hit or its leg thrown about.
    w.least_push = std::min(most, kForceAtRest * most + w.unsteady);

    doubt_low_edges(w, belief);
    if (path_.next_drop(w.s) && norm(w.felt) > kTouching * weight_ / 4) look_at_velocity(w, belief);
    w.since_clear += moves.x * dt;
    if (w.since_clear > -kClearOfEdge) belief.past = w.clear;
    return belief;
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

// A leg that swings feels a little, too: of a wall it has to be more than that, but where the wheel follows it.
bool Estimator::touches(const WheelState& w, const CurveMatch& on) const {
    const auto feels = [&](Vec2 n) { return dot(w.felt, n) > std::max(kTouching * weight_ / 4, n.z < kTread && !w.follows ? w.least_push : 0.0); };
    if (feels(on.point.normal) || feels(on.before) || feels(on.after)) return true;
    const double corner = nearest_corner(on.s);
    return std::abs(corner - on.s) < kNearCorner && (feels(path_.normal(corner - kBeside)) || feels(path_.normal(corner + kBeside)));
}

void Estimator::follow(int i, const CurveMatch& on, const WheelBelief& belief, bool touching, double dt) {
    WheelState& w = wheels_[i];
    const double before = w.s;
    w.at_corner = on.corner ? w.at_corner + dt : 0.0;
    const bool leaps = !on.corner && path_.pieces()[on.piece].arc && std::abs(on.s - (before + w.rolled)) > kLeap;
    w.leaps = leaps ? w.leaps + dt : 0.0;
    // The other wheel of the pair is where it was: one alone must not be called back.
    const bool stays = is_leaping(w) || (is_passing(w, on) && std::abs(on.s - before) > kNearCorner);
    w.s = stays ? before + w.rolled : on.s;
    w.aloft = touching ? 0.0 : w.aloft + dt;
    w.landed = touching ? w.landed + dt : 0.0;
    if (touching || on.s <= before) return;
    // In the air no wheel gets past a corner, unless that is sure. What counts is how far it seems to be along the face after it.
    const auto& corners = path_.corners();
    const std::size_t passed = path_.corner_from(before - kNearCorner);
    const double sure = kBeyondDoubt * std::sqrt(belief.spread.along({on.point.normal.z, -on.point.normal.x}));
    if (passed == corners.size() || corners[passed] >= on.s || on.s >= corners[passed] + sure) return;
    w.s = std::max(before, corners[passed]);
    const bool hop = std::hypot(velocity_[0], velocity_[2]) > kHopSpeed && w.aloft < kHop;
    estimate_.hanging[i / 2] = estimate_.hanging[i / 2] || !hop;
}

// Whether the wheel seems to be in a corner, but has not for long.
bool Estimator::is_passing(const WheelState& w, const CurveMatch& on) { return on.corner && w.at_corner <= kSure; }

// A force that passes may seem to be that of an edge some centimetres on; a controller that believed it would brake the
// wheel, and feel what confirms it.
bool Estimator::is_leaping(const WheelState& w) { return w.leaps > 0.0 && w.leaps <= kSure; }

void Estimator::look_ahead(int i, const CurveMatch& on) {
    const std::size_t next = path_.corner_from(on.s);
    const double room = next < path_.corners().size() ? path_.corners()[next] - on.s : kRoom;
    const bool tread = !on.corner && on.point.normal.z > kTread;
    const bool up_edge = path_.pieces()[on.piece].arc && on.point.normal.x < 0.0;
    estimate_.on_tread[i / 2] = tread && room >= kRoom;
    estimate_.nearing[i / 2] = (tread && room < kRoom) || up_edge || is_passing(wheels_[i], on);
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

}  // namespace stairwright::estimation
