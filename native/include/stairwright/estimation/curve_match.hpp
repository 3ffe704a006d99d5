// Which part of the map a wheel is on: the most likely of the faces near to where it is believed to be.
//
// A wheel that touches the ground has its centre on the wheel-centre curve, but the nearest point of the curve is the
// wrong one as soon as the error is larger than a wheel's way to the next face. What decides is the distance in
// the metric of the estimate's own covariance (individual compatibility, Neira and Tardos 2001), together with the
// force that the leg feels: on one face it is normal force plus traction, and the traction is the wheel's torque.
// What does not fit is the push of a face ahead.
#pragma once

#include <limits>

#include "stairwright/wheel_path.hpp"

namespace stairwright::estimation {

// Symmetric 2 x 2 matrix.
struct Spread {
    double xx = 0.0, xz = 0.0, zz = 0.0;

    // Variance along a unit vector.
    double along(Vec2 d) const { return d.x * d.x * xx + 2.0 * d.x * d.z * xz + d.z * d.z * zz; }
    // v' S^-1 v
    double distance(Vec2 v) const { return (zz * v.x * v.x - 2.0 * xz * v.x * v.z + xx * v.z * v.z) / (xx * zz - xz * xz); }
};

struct CurveMatch {
    std::size_t piece = 0;
    double s = 0.0;               // arc length [m]
    CurvePoint point;
    bool corner = false;          // on both faces of a concave corner
    Vec2 before, after;           // their normals there
    double cost = 0.0;            // minus twice the logarithm of the likelihood, up to a constant
    int beyond = 0;               // the wheel seems beyond the face's end (+1) or begin (-1)
    bool blocked = false;         // where it cannot be: the next face is steep against this one
};

inline constexpr std::size_t kNoPiece = std::numeric_limits<std::size_t>::max();

struct WheelBelief {
    Vec2 centre;        // on the map [m]
    Spread spread;      // its covariance [m^2]
    Vec2 force;         // of the ground, world x-z [N]
    double traction = 0.0;  // see WheelForce [N]
    double force_deviation = 0.0;  // standard deviation of the force's components [N]
    // Pieces that may be higher or lower than all others, as is what comes below an edge: the first one, how many, and the
    // variance [m^2].
    std::size_t unsure = kNoPiece, unsure_count = 0;
    double unsure_height = 0.0;
    // Where an edge that leads down may come early: the velocity of the wheel's centre, which is along the face that it is
    // on [m/s], and its covariance. Elsewhere zero, and then no evidence.
    Vec2 velocity = {};
    Spread velocity_spread = {};
    std::size_t past = 0;  // edges before this piece it has left behind, and has not come back to
};

// How much better the push of a steep face ahead, against which the wheel stands, explains the force that it feels than
// the face with normal `on` alone: the difference of two costs as in CurveMatch.
double pushed_by(const WheelBelief& wheel, Vec2 on, Vec2 face);

// The most likely place of a wheel within `window` of arc length around `last`, or of anywhere if `last` is NaN.
CurveMatch match(const WheelPath& path, const WheelBelief& wheel, double last, double window);

}  // namespace stairwright::estimation
