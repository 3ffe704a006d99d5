#include "stairwright/estimation/curve_match.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "faces.hpp"

namespace stairwright::estimation {

namespace {

constexpr double kCornerCost = 2.0;   // two faces at once are rarer than one
constexpr double kMostForceCost = 16; // legs that swing feel forces that no face explains
constexpr double kMostVelocityCost = 9.0;  // wheels that slip or bounce move along no face
constexpr int kArcSteps = 8;
constexpr double kEnd = 1e-6;         // m
constexpr double kBlocks = 0.7;       // sine of the turn from one face to the next that stops a wheel

double squared(double v) { return v * v; }

// Cost of a force on one face: what its tangential part has that the wheel's torque has not, and pull.
double face_cost(const WheelBelief& w, Vec2 n) {
    const Vec2 t = {n.z, -n.x};
    const double off = dot(w.force, t) - w.traction, pull = std::min(0.0, dot(w.force, n));
    return std::min((squared(off) + squared(pull)) / squared(w.force_deviation), kMostForceCost);
}

// The same on both faces of a corner, for the traction all on one of them, whichever fits better.
double corner_cost(const WheelBelief& w, Vec2 a, Vec2 b) {
    const double det = cross(a, b);
    double best = kMostForceCost;
    for (const Vec2 n : {a, b}) {
        const Vec2 f = w.force - w.traction * Vec2{n.z, -n.x};
        const double on_a = cross(f, b) / det, on_b = cross(a, f) / det;
        best = std::min(best, (squared(std::min(0.0, on_a)) + squared(std::min(0.0, on_b))) / squared(w.force_deviation));
    }
    return best;
}

// Cost of a face that the wheel's centre does not move along.
double velocity_cost(const WheelBelief& w, Vec2 n) {
    const double variance = w.velocity_spread.along(n);
    return variance > 0.0 ? std::min(squared(dot(w.velocity, n)) / variance, kMostVelocityCost) : 0.0;
}

// Cost of being at `at`, on one face.
double cost_at(const WheelBelief& w, const CurvePoint& at) {
    return w.spread.distance(w.centre - at.centre) + face_cost(w, at.normal) + velocity_cost(w, at.normal);
}

// Distance along a straight piece of its most likely point, not limited to its ends.
double most_likely(const Piece& line, const WheelBelief& w) {
    const Vec2 t = {line.a, line.b}, e = w.centre - line.origin;
    const Spread& S = w.spread;
    const Vec2 q = {S.zz * t.x - S.xz * t.z, S.xx * t.z - S.xz * t.x};  // S^-1 t times the determinant
    return dot(q, e) / dot(q, t);
}

// How far before its begin an arc may go on: an edge up that a corner cuts off may be higher than drawn [m].
double below(const Piece& arc, double radius) { return radius * std::max(0.0, std::numbers::pi - std::max(arc.a, 0.5 * std::numbers::pi)); }

// Round an edge the direction of the force tells the place, too.
double most_likely_on_arc(const Piece& arc, const WheelBelief& w, double begin, double radius) {
    double best = std::numeric_limits<double>::infinity(), found = 0.0, step = (arc.length - begin) / kArcSteps;
    const auto look = [&](double d) {
        const double value = cost_at(w, arc.at(d, radius));
        if (value < best) best = value, found = d;
    };
    for (int k = 0; k <= kArcSteps; ++k) look(begin + k * step);
    for (int k = 0; k < 5; ++k) {
        step *= 0.5;
        const double at = found;
        look(std::max(begin, at - step)), look(std::min(arc.length, at + step));
    }
    return found;
}

}  // namespace

double pushed_by(const WheelBelief& wheel, Vec2 on, Vec2 face) { return face_cost(wheel, on) - corner_cost(wheel, on, face); }

CurveMatch match(const WheelPath& path, const WheelBelief& wheel, double last, double window) {
    const auto& pieces = path.pieces();
    const double lower = std::isnan(last) ? -1.0 : last - window, upper = std::isnan(last) ? 1e9 : last + window;
    WheelBelief unsure = wheel;
    unsure.spread.zz += wheel.unsure_height;
    CurveMatch best;
    best.cost = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < pieces.size(); ++k) {
        const Piece& piece = pieces[k];
        const bool first = k == 0, end = k + 1 == pieces.size();
        if ((piece.s + piece.length < lower && !end) || (piece.s > upper && !first) || (piece.arc && k < wheel.past)) continue;
        const WheelBelief& believed = k >= wheel.unsure && k < wheel.unsure + wheel.unsure_count ? unsure : wheel;
        const bool cut = piece.arc && path.begins_in_corner(piece);
        const double begin = first ? -1e9 : cut ? -below(piece, path.radius()) : 0.0;
        double d = piece.arc ? most_likely_on_arc(piece, believed, begin, path.radius()) : most_likely(piece, believed);
        const double free = d;
        d = std::clamp(d, begin, end ? 1e9 : piece.length);
        CurveMatch found;
        found.piece = k, found.s = piece.s + (cut ? std::max(d, 0.0) : d), found.point = piece.at(d, path.radius());
        found.before = found.after = found.point.normal;
        found.beyond = free > d + kEnd ? 1 : free < d - kEnd ? -1 : 0;
        if (found.beyond != 0 && k + found.beyond < pieces.size()) {
            const Piece& next = pieces[k + found.beyond];
            const Vec2 n = found.point.normal, other = next.at(found.beyond > 0 ? 0.0 : next.length, path.radius()).normal;
            found.blocked = found.beyond * cross(n, other) > kBlocks;
        }
        found.cost = cost_at(believed, found.point);
        if (found.cost < best.cost) best = found;
    }
    for (std::size_t k = path.corner_from(lower); k < path.corners().size() && path.corners()[k] <= upper; ++k) {
        CurveMatch found;
        found.corner = true, found.s = path.corners()[k], found.point = path.at(found.s);
        found.before = path.normal(found.s - kBeside), found.after = path.normal(found.s + kBeside);
        // It may come along one of them, or leave along the other.
        const double moving = std::min(velocity_cost(wheel, found.before), velocity_cost(wheel, found.after));
        const double away = wheel.spread.distance(wheel.centre - found.point.centre);
        found.cost = away + moving + corner_cost(wheel, found.before, found.after) + kCornerCost;
        if (found.cost < best.cost) best = found;
    }
    return best;
}

}  // namespace stairwright::estimation
