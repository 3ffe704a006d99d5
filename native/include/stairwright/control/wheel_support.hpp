// Which place and which face of the terrain a wheel is on, and which forces it can take there.
//
// A wheel's place is the arc length of the nearest point of the wheel-centre curve. At a concave corner the
// curve has a kink and the wheel touches two faces. While the plan is already past a corner that the wheel has
// not passed (or the other way round), the planned face counts: else the robot would push on the old face for
// ever. While plan and wheel are both in the corner, it leans on the face before, on the face after, or on both,
// as the static forces of the plan do. On both, the friction cones span one wider cone round the bisector of the
// normals, whose apex is the wheel's centre. A wheel farther off that is on the very face that the plan leans on stays
// with it.
#pragma once

#include <algorithm>
#include <array>

#include "stairwright/wheel_path.hpp"

namespace stairwright::control {

// A plan this near to a corner counts on both faces [m]; less for wheels smaller than the paper's, which would
// else be well up a riser that they are still meant to lean beside.
inline double corner_planned(const WheelPath& path) { return std::min(0.008, 0.16 * path.radius()); }

enum class Lean { before = 0, after = 1, both = 2 };

struct WheelSupport {
    Vec2 normal;            // axis of the cone of forces
    double friction = 0.0;  // of that cone
    double reach = 0.0;     // of the force's point from the wheel's centre [m]: the radius, 0 on both faces
    Vec2 before, after;     // normals of the faces before and after a corner, elsewhere both the face's

    Vec2 tangent() const { return {normal.z, -normal.x}; }
    // Tangential force that the wheel must drive when the ground's force on it is `force` [N]. In a corner, normal
    // forces of both faces carry what lies between the normals; only what lies beyond one needs traction.
    double traction(Vec2 force) const;
};

// Arc length of a wheel centre near where it was, anywhere if `last` is NaN.
double locate(const WheelPath& path, Vec2 centre, double last);

// Unit normal of the face that the wheel at `measured` shall push on.
Vec2 face_normal(const WheelPath& path, double measured, double planned);

// How the wheel at `measured` is carried; in a corner as `lean` says.
WheelSupport wheel_support(const WheelPath& path, double measured, double planned, double friction, Lean lean);

}  // namespace stairwright::control
