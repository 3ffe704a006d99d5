// What a wheel that touches the ground measures: its place on the map, and how it rolls.
#include "stairwright/estimation/estimator.hpp"

#include <algorithm>
#include <cmath>

#include "faces.hpp"
#include "spatial.hpp"

namespace stairwright::estimation {

namespace {

constexpr double kGripUsed = 0.25;     // share of the normal force from which on traction makes slip likely
constexpr double kAtRest = 0.015;      // m/s of rolling
constexpr double kRound = 3.0;          // of the noise off a face: errors last longer round an edge
constexpr double kMayEnd = 25.0;       // of the variance of a place on a tread that may end
constexpr double kNearEdge = 0.015;    // m along the curve
constexpr double kEdgeStray = 0.012;   // m that the map's edge may be off
constexpr double kLevel = 0.95;        // cosine of the slope of a face on which the wheels' scale is estimated
constexpr double kMissed = 0.004;       // m put back: the face is not where the map has it
constexpr double kSearchNoise = 0.01;   // m^2 of variance for a metre that a face is farther on
constexpr double kTurnSearchNoise = 0.04;  // the same for an edge that a wheel does not turn about yet
constexpr double kSame = 1e-6;          // m
// Of a force's uncertainty: the direction of a smaller one says little, and that always the same way.
constexpr double kLeans = 5.0;
constexpr double kBounce = 0.1;          // s after a wheel has met a face in which its tyre gives way and comes back
constexpr double kGivesWay = 4.0;       // of the variance of a place meanwhile: some millimetres
constexpr double kGate = 9.0;           // of a normalised innovation squared

double dot_of(const Error& a, const Error& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < kErrors; ++i) sum += a[i] * b[i];
    return sum;
}

}  // namespace

// Whether a wheel is on a tread that may end under it, in an edge that leads down and comes early.
bool Estimator::before_drop(const CurveMatch& on) const {
    return !on.corner && !path_.pieces()[on.piece].arc && on.point.normal.z > kTread && path_.next_drop(on.s).has_value();
}

void Estimator::measure_place(int i, const CurveMatch& on, const WheelPlace& place, double dt, Error& error) {
    if (over_low_edge(wheels_[i], on)) return;
    const double doubt = before_drop(on) ? kMayEnd : wheels_[i].landed < kBounce ? kGivesWay : 1.0;
    const double variance = doubt * noise_.place * noise_.place * std::max(1.0, noise_.place_lasts / dt);
    const Vec2 off = on.point.centre - place.centre;
    const auto row = [&](Vec2 d) {
        Error h;
        for (std::size_t k = 0; k < kErrors; ++k) h[k] = d.x * place.along_x[k] + d.z * place.along_z[k];
        return h;
    };
    if (on.corner) {
        wheels_[i].met = nearest_corner(on.s);
        covariance_.update(row(on.before), dot(on.before, off), variance, error);
        covariance_.update(row(on.after), dot(on.after, off), variance, error);
        return;
    }
    const Vec2 n = on.point.normal;
    if (path_.pieces()[on.piece].arc && dot(wheels_[i].felt, n) > wheels_[i].least_push) wheels_[i].rounded = on.piece;
    if (n.z < kTread) {
        if (!wheels_[i].follows && dot(wheels_[i].felt, n) < wheels_[i].least_push) return;  // it only seems to be there
        if (n.x < 0.0) wheels_[i].met = nearest_corner(on.s);  // down a face it is the tread below that is to be felt
    }
    const bool passed = on.beyond != 0 && on.blocked;
    if (passed && wheels_[i].low_edge && on.piece + 1 == wheels_[i].low_edge->first) return;  // it may be on that edge, which is lower than drawn
    covariance_.update(row(n), dot(n, off), variance, error);
    if (path_.pieces()[on.piece].arc) measure_turn(i, n, row({n.z, -n.x}), dt, error);
    if (!passed) return;
    const Vec2 t = {n.z, -n.x};
    if (std::abs(wheels_[i].met - nearest_corner(on.s)) < kSame) {  // no news of a face that it has felt
        covariance_.update(row(t), dot(t, off), variance, error);
        return;
    }
    // The mean alone is projected: that the face is not felt yet is the same news at every step.
    put_back(i, row(t), dot(t, off) - dot_of(row(t), error), error);
}

// How far round an edge a wheel is the direction of its force says: what of it is along the wheel's way is the traction,
// and that way turns by ds / r. An edge that is higher than drawn, or comes earlier, looks from its place like another one.
void Estimator::measure_turn(int i, Vec2 normal, Error along, double dt, Error& error) {
    const WheelState& w = wheels_[i];
    const double pressed = dot(w.felt, normal);
    if (pressed < kLeans * w.force_deviation) return;
    const std::size_t own = i / 2 == 0 ? kFrontOffset : kRearOffset;
    const double turning = -pressed / path_.radius();
    for (double& v : along) v *= turning;
    const double variance = w.force_deviation * w.force_deviation * std::max(1.0, noise_.place_lasts / dt);
    const double off = w.traction - dot(w.felt, {normal.z, -normal.x}), before = error[own];
    covariance_.update(along, off, variance, error);
    // A wheel that an edge down should have turned about by now is still before it: that is farther on.
    if (normal.x > 0.0 && off > w.force_deviation) covariance_.add_noise(own, kTurnSearchNoise * std::abs(error[own] - before));
}

// A wheel that the map has beyond a face which it does not feel: the face is farther on than drawn, or the robot less far,
// as either is unsure.
void Estimator::put_back(int i, const Error& along, double excess, Error& error) {
    WheelState& w = wheels_[i];
    w.put_back += std::abs(excess);
    w.missed = w.put_back > kMissed;
    const Error spread = covariance_.times(along);
    const double variance = dot_of(along, spread);
    for (std::size_t k = kPlace; k < kErrors; ++k)
        if (k < kPlace + 2 || k >= kFrontOffset) error[k] += spread[k] / variance * excess;
    const std::size_t own = i / 2 == 0 ? kFrontOffset : kRearOffset;
    covariance_.add_noise(spread[own] > spread[kPlace] ? own : kPlace, kSearchNoise * std::abs(excess));
}

void Estimator::measure_rolling(int i, const CurveMatch& on, const Readings& readings, const WheelPlace& place, double dt, Error& error) {
    const WheelState& w = wheels_[i];
    const Rotation R = rotation();
    const Vec3 arm = arm_of(i), speed = velocity_of(i);
    const Vec3 axis = {R[0][1], R[1][1], R[2][1]};
    const Vec2 n = on.point.normal;
    Vec3 t = {n.z, 0.0, -n.x};
    // Rows stand at what is expected of the wheel, for noise of a reading in its row and in its residual would not average
    // out: it shrinks the scale and tips the attitude, by 30 mrad over twenty stairs.
    const Vec3 rolling = {w.cruise * t[0], 0.0, w.cruise * t[2]};
    const Vec3 lever = {rolling[0] - velocity_[0], rolling[1] - velocity_[1], rolling[2] - velocity_[2]};
    // How the measured part `d` of the wheel's velocity changes with the state; the lever turns with the trunk.
    const auto row = [&](const Vec3& d) {
        Error h{};
        const Vec3 turned = cross3(lever, d);
        const Vec3 body = {R[0][0] * d[0] + R[1][0] * d[1] + R[2][0] * d[2], R[0][1] * d[0] + R[1][1] * d[1] + R[2][1] * d[2],
                           R[0][2] * d[0] + R[1][2] * d[1] + R[2][2] * d[2]};
        const Vec3 bias = cross3(body, arm);
        for (std::size_t k = 0; k < 3; ++k) h[kAttitude + k] = turned[k], h[kVelocity + k] = d[k], h[kGyroBias + k] = bias[k];
        return h;
    };
    const double lasts = std::max(1.0, noise_.rolling_lasts / dt);
    // Noise of joint rates grows with the leg, and lasts for one reading.
    const Vec2 hip = w.leg.wheel - w.leg.hip, knee = w.leg.wheel - w.leg.knee;
    const auto update = [&](const Error& h, const Vec3& d, double residual, double deviation) {
        const double reading = noise_.joint_rate * std::hypot(d[0] * hip.z - d[2] * hip.x, d[0] * knee.z - d[2] * knee.x);
        const Error ph = covariance_.times(h);
        double spread = deviation * deviation + reading * reading;
        for (std::size_t k = 0; k < kErrors; ++k) spread += h[k] * ph[k];
        if (residual * residual > kGate * spread) return false;
        covariance_.update(h, ph, residual, deviation * deviation * lasts + reading * reading, error);
        return true;
    };
    // Sideways; the axis turns with the trunk.
    Error h = row(axis);
    const Vec3 swing = cross3(axis, rolling);
    for (std::size_t k = 0; k < 3; ++k) h[kAttitude + k] += swing[k];
    update(h, axis, -dot3(axis, speed), noise_.aside);
    const double radius = robot_.legs[i / 2].wheel.radius;
    const std::size_t next = path_.corner_from(on.s - kNearCorner);
    const bool near = next < path_.corners().size() && path_.corners()[next] < on.s + kNearCorner;
    const Vec3 off = {n.x, 0.0, n.z};
    if (near || on.corner) {
        // Either face: only a wheel that does not turn says something, that it is at rest.
        if (std::abs(w.cruise) > kAtRest) return;
        update(row(off), off, -dot3(off, speed), noise_.rolling);
        update(row(t), t, -dot3(t, speed), noise_.rolling);
        return;
    }
    // Round an edge a face is only as well known as the place on it.
    const bool edge = before_drop(on) || path_.on_arc(on.s) || path_.on_arc(on.s - kNearEdge) || path_.on_arc(on.s + kNearEdge);
    const double askew = edge ? std::abs(w.cruise) * std::min(1.0, kEdgeStray / radius) : 0.0;
    const double aside = dot3(t, axis);
    for (int k = 0; k < 3; ++k) t[k] -= aside * axis[k];
    const double length = std::sqrt(dot3(t, t));
    for (double& v : t) v /= length;
    const double angular = readings.joint_rates[3 * i] + readings.joint_rates[3 * i + 1] + readings.joint_rates[3 * i + 2] + rate_[1];
    const double rolled = radius * angular;
    h = row(t);
    h[kScale] = n.z > kLevel ? -w.cruise : 0.0;
    h[kGyroBias + 1] += radius;
    // The nearer to its grip, the less a wheel's turning says. By the readings before: the noise of a rate is in what spins
    // the wheel up, and so in its traction; weighed by that, noise does not average out, but adds 3 mm/s on a slope of 36 degrees.
    const double used = std::abs(w.traction_before) / std::max(dot(w.felt_before, n), 0.02 * weight_) / kGripUsed;
    const double crept = noise_.creep * w.traction / (0.25 * weight_);
    const double slips = noise_.rolling * std::max(1.0, used * used);
    wheels_[i].contradicts = !update(h, t, (1.0 + scale_) * rolled - crept - dot3(t, speed), std::hypot(slips, askew));
    if (w.landed < kBounce || over_low_edge(w, on)) return;  // always the same way: what was given way before it was felt comes back
    h = row(off);
    const bool round = path_.on_arc(on.s);
    if (round) {  // where it goes says how far round the edge it is: dn/ds = t / radius
        const double turning = w.cruise / radius;
        for (std::size_t k = 0; k < kErrors; ++k) h[k] += turning * (n.z * place.along_x[k] - n.x * place.along_z[k]);
    }
    update(h, off, -dot3(off, speed), round ? kRound * noise_.off_face : std::hypot(noise_.off_face, askew));
}

}  // namespace stairwright::estimation
