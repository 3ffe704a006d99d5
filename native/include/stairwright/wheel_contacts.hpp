// Which faces a wheel touches at an arc length, and the CoM intervals that follow for two wheel pairs.
#pragma once

#include <array>
#include <span>

#include "stairwright/statics.hpp"
#include "stairwright/wheel_path.hpp"

namespace stairwright {

inline constexpr double kGentleRays = 0.75;  // weights; ray strength that poses with reserve do with: no wheels that pinch
inline constexpr double kStray = 0.005;      // m; how far a wheel may be from its place
inline constexpr double kLeastStray = 0.003; // m; how far any controller's wheels are: what holds no farther falls
inline constexpr double kTouch = 1e-4;       // m; a wheel this near to a concave corner (by arc length) touches both faces
inline constexpr double kBeside = 1.1e-4;    // m; a wheel this far from one touches the nearer face alone

// One or two contacts of a wheel.
struct WheelContacts {
    std::array<Contact, 2> at;
    std::size_t count = 0;

    std::span<const Contact> span() const& { return {at.data(), count}; }
    void span() const&& = delete;  // of a temporary: a loop over it would read what is gone
};

// Arc lengths of the front and the rear wheels.
struct WheelPlaces {
    double front = 0.0, rear = 0.0;

    constexpr double operator[](int pair) const { return pair == kFront ? front : rear; }
};

WheelContacts wheel_contacts(const WheelPath& path, double s, double friction);

// CoM interval with the wheels at `s`. A wheel between two faces pushes on either with friction, or on both without.
// Friction on both could hold more: a motor that drives the wheel against the face ahead lifts the robot's nose. But
// it takes all the grip of both at once, and robots whose plans counted on it tipped. `off`: where the pairs' ground
// is against the drawn one [m].
Interval pair_interval(const WheelPath& path, WheelPlaces s, double friction, double ray_limit = kRayLimit, const std::array<Vec2, 2>& off = {});

// The same with friction on both faces of a corner, as plans state their margins.
Interval stated_interval(const WheelPath& path, WheelPlaces s, double friction);

// CoM interval that also holds where a wheel on an edge strays: round an edge a few millimetres tilt the face by a tenth of a
// radian. Empty where no CoM suits all cases.
Interval strayed_interval(const WheelPath& path, WheelPlaces s, double friction, double stray, double ray_limit = kRayLimit);

// The same without pinching, and kStray.
Interval steady_interval(const WheelPath& path, WheelPlaces s, double friction);

// CoM interval that also holds if either wheel is `lag` behind its plan, or kStray ahead. A wheel that arrives late
// at a corner pushes on the face behind it alone; plans that tolerate this are what a controller can follow. Empty
// where no CoM suits all cases. What also holds on an edge that leads down and comes early is kept where anything does;
// with `surely` it is empty where nothing does.
Interval lagged_interval(const WheelPath& path, WheelPlaces s, double friction, double lag, bool surely = false);

// What the smoothing keeps the CoM within. Where one of the stricter two is empty the one before it stands in;
// before that, less lag.
struct NodeIntervals {
    Interval full, reserve, lagged;
};
NodeIntervals node_intervals(const WheelPath& path, WheelPlaces s, double friction, double reserve, double lag);

}  // namespace stairwright
