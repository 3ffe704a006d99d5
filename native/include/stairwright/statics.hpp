// Statics of wheels on terrain: where the centre of mass may be, in closed form.
//
// The robot at rest needs contact forces inside their friction cones whose sum is the weight and whose moment
// balances it. In the plane a cone is spanned by two rays; force is counted in robot weights and moment in
// weights times metres, so the moment that the weight asks for is the CoM's x.
#pragma once

#include <array>
#include <limits>
#include <span>

#include "stairwright/kinematics.hpp"

namespace stairwright {

inline constexpr double kRayLimit = 1.0;        // largest ray strength, in weights: joints hold no larger force of wedged wheels
inline constexpr double kNothingHolds = -1.0;   // m; the margin where no CoM is in equilibrium, and the least that is stated
inline constexpr std::size_t kMostContacts = 6;

struct Contact {
    Vec2 point, normal;     // the normal points out of the terrain
    double friction = 0.0;  // Coulomb coefficient
};

// Values of the CoM's x; lower > upper where there are none.
struct Interval {
    double lower = std::numeric_limits<double>::infinity(), upper = -std::numeric_limits<double>::infinity();

    constexpr bool empty() const { return lower > upper; }
    constexpr bool contains(double x) const { return lower <= x && x <= upper; }
    constexpr Interval intersect(Interval o) const { return {std::max(lower, o.lower), std::min(upper, o.upper)}; }
    // The smallest interval that holds both.
    constexpr Interval join(Interval o) const {
        return o.empty() ? *this : empty() ? o : Interval{std::min(lower, o.lower), std::max(upper, o.upper)};
    }
};

// Least and largest x of the CoM that `contacts` can hold at rest, with ray strengths of at most `limit` weights.
Interval com_interval(std::span<const Contact> contacts, double limit = kRayLimit);

// How far a CoM may shift in x, the smaller way, within `interval` [m]: negative outside, never below kNothingHolds.
double com_margin(Interval interval, double com_x);

// Least friction with which any number of contacts hold a CoM; infinite if none does. Their own friction is not used.
double friction_needed(std::span<const Contact> contacts, double com_x);

// A contact force in the contact's frame: tangential is positive along (n_z, -n_x), forward on the level.
struct ContactForce {
    double tangential = 0.0, normal = 0.0;

    double size() const { return std::hypot(tangential, normal); }
};

// In world axes.
inline Vec2 world_force(const Contact& contact, const ContactForce& f) {
    const Vec2 n = contact.normal;
    return {f.tangential * n.z + f.normal * n.x, -f.tangential * n.x + f.normal * n.z};
}

// Least friction with which two contacts hold a CoM at `com_x`, and the forces that do, in weights; infinite where
// no push on both holds the robot. Up to `ample` friction the forces squeeze the terrain least, beyond it they need
// the least friction.
double least_friction(const std::array<Contact, 2>& contacts, double com_x, double ample, std::array<ContactForce, 2>& forces);

// Whether two contacts hold a CoM at `com_x` with no more than `ample` friction, and the forces of `least_friction` where
// they do: told without looking for the friction needed.
bool held_within(const std::array<Contact, 2>& contacts, double com_x, double ample, std::array<ContactForce, 2>& forces);

struct LegTorques {
    double thigh = 0.0, calf = 0.0, wheel = 0.0;  // Nm
};

// What the ground does to one wheel: force in world axes [N], and its moment about the wheel's centre, about +y [Nm].
struct WheelLoad {
    Vec2 force;
    double moment = 0.0;
};

// A leg in one pose as far as its torques go: from each joint to the wheel's centre [m], and what its own weight asks of
// the joint [Nm].
struct LegLevers {
    Vec2 thigh, calf;
    double thigh_weight = 0.0, calf_weight = 0.0;
};
LegLevers leg_levers(const Leg& leg, const LegPoints& points);

// Static torques of one leg under the load on its wheel: a joint must balance everything below it.
inline LegTorques static_torques(const LegLevers& levers, const WheelLoad& load) {
    const auto joint = [&](Vec2 r, double weight) { return r.z * load.force.x - r.x * load.force.z + load.moment + weight; };
    return {joint(levers.thigh, levers.thigh_weight), joint(levers.calf, levers.calf_weight), load.moment};
}
// Static torques of one leg whose wheel carries `force` [N] at `contact`. The wheel's motor sits in the calf, so for
// the leg's joints the wheel is one body with it.
LegTorques static_torques(const Leg& leg, const LegPoints& points, const Contact& contact, const ContactForce& force);

}  // namespace stairwright
