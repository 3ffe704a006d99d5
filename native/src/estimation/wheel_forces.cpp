#include "stairwright/estimation/wheel_forces.hpp"

#include <cmath>

namespace stairwright::estimation {

namespace {

constexpr double kSingular = 0.15;  // sine between hip-wheel and knee-wheel, below which a leg says nothing

}  // namespace

WheelForce wheel_force(const Leg& leg, const LegPlaces& at, double thigh_torque, double calf_torque, double wheel_torque) {
    // torque = moment of the force about the joint + wheel torque - weight of the links below.
    const double below_hip = leg.thigh.mass * (at.thigh_com.x - at.hip.x) + leg.calf.mass * (at.calf_com.x - at.hip.x) +
                             leg.wheel.mass * (at.wheel.x - at.hip.x);
    const double below_knee = leg.calf.mass * (at.calf_com.x - at.knee.x) + leg.wheel.mass * (at.wheel.x - at.knee.x);
    const double m1 = thigh_torque - wheel_torque + kGravity * below_hip, m2 = calf_torque - wheel_torque + kGravity * below_knee;
    const Vec2 a = at.wheel - at.hip, b = at.wheel - at.knee;  // a.x F.z - a.z F.x = m1, the same of b
    const double det = a.z * b.x - a.x * b.z;
    WheelForce out;
    out.traction = wheel_torque / leg.wheel.radius;
    const double upper = norm(a), lower = norm(b);
    if (std::abs(det) < kSingular * upper * lower) {
        out.untold = upper > lower ? (1.0 / upper) * a : (1.0 / lower) * b;
        out.force = (upper > lower ? m1 / upper : m2 / lower) * Vec2{-out.untold.z, out.untold.x};
        return out;
    }
    out.force = {(a.x * m2 - b.x * m1) / det, (a.z * m2 - b.z * m1) / det};
    return out;
}

}  // namespace stairwright::estimation
