// The curve of wheel centres: the profile offset by the wheel radius, exact, by arc length s.
//
// The ground is everything below an x-monotone profile, so the places that a rolling wheel's centre can take
// are the upper boundary of that set dilated by a disc: offset segments, arcs round convex corners, and kinks
// (two contacts) at concave ones. The curve is x-monotone again.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "stairwright/terrain.hpp"

namespace stairwright {

// A place on the curve: the wheel's centre and the unit normal from the terrain to it.
struct CurvePoint {
    Vec2 centre, normal;
};

// A line from `origin` along the unit tangent (a, b), or an arc round the corner `origin` that starts at
// angle a, clockwise.
struct Piece {
    bool arc = false;
    double s = 0.0, length = 0.0;  // arc length at its begin, and of it [m]
    Vec2 origin;
    double a = 0.0, b = 0.0;

    // At distance `d` along the piece.
    CurvePoint at(double d, double radius) const {
        if (!arc) return {{origin.x + d * a, origin.z + d * b}, {-b, a}};
        const double angle = a - d / radius, c = std::cos(angle), n = std::sin(angle);
        return {{origin.x + radius * c, origin.z + radius * n}, {c, n}};
    }
    // Distance along the piece of the point of its line or circle nearest to `p`.
    double parameter(Vec2 p, double radius) const;
};

inline constexpr double kEarlyDrop = 0.06;  // m before its place that an edge which leads down a face may come

class WheelPath {
  public:
    // Throws std::invalid_argument if the profile is too short to hold a wheel.
    WheelPath(const std::vector<Vec2>& vertices, double radius);

    const Terrain& terrain() const { return terrain_; }
    double radius() const { return radius_; }
    const std::vector<Piece>& pieces() const { return pieces_; }
    // Arc lengths of concave corners, where the wheel touches two faces [m].
    const std::vector<double>& corners() const { return corners_; }
    double length() const { return pieces_.back().s + pieces_.back().length; }

    // At arc length `s`; the end pieces are continued.
    CurvePoint at(double s) const {
        const std::size_t k = piece(s);
        return pieces_[k].at(s - pieces_[k].s, radius_);
    }
    Vec2 centre(double s) const { return at(s).centre; }
    // Whether the curve is round there: the wheel turns about an edge.
    bool on_arc(double s) const { return pieces_[piece(s)].arc; }
    Vec2 normal(double s) const { return at(s).normal; }
    // By how much the normal turns about edges from arc length `a` to `b` [rad].
    double turn(double a, double b) const;
    // Where the wheel touches the terrain.
    Vec2 contact(double s) const {
        const CurvePoint p = at(s);
        return p.centre - radius_ * p.normal;
    }
    // Arc length in [lower, upper] whose centre is nearest to `p`.
    double project(Vec2 p, double lower = 0.0, double upper = std::numeric_limits<double>::infinity()) const;
    // Where the next edge that leads down a face begins, not behind the piece that `s` is on, if there is one less than
    // kEarlyDrop ahead.
    std::optional<double> next_drop(double s) const;
    // Index of the first corner at or after `s`.
    std::size_t corner_from(double s) const;
    // Whether one of the pieces begins in a concave corner.
    bool begins_in_corner(const Piece& piece) const;

  private:
    std::size_t piece(double s) const;

    Terrain terrain_;
    std::vector<Piece> pieces_;
    std::vector<double> starts_;  // of the pieces, for the search
    std::vector<double> corners_;
    double radius_;
};

}  // namespace stairwright
