#include "stairwright/control/nod.hpp"

#include <bit>
#include <cmath>
#include <numbers>

namespace stairwright::control {

namespace {

constexpr double kPeriodOfNod = 2.0;  // s
constexpr double kSwing = 0.2, kLeastSwing = 0.1, kSwingStep = 0.02;  // rad
constexpr double kReach = 0.01;    // m of a leg's reach that are left
constexpr double kJoint = 0.05;    // rad to the ends of the joints' ranges
constexpr double kClear = 0.015;   // m that trunk and links keep to the ground, and legs to each other
constexpr double kPeak = 0.75 * std::numbers::sqrt3 / 2.0;  // of sin(a) (1 - cos(a)) / 2
constexpr double kDifference = 1e-3;  // s, for rates

using Numbers = std::array<double, kPlannedWidth>;

}  // namespace

Nod::Nod(const RobotModel& robot, const Reference& planned, const WheelPath& path) : robot_(robot), planned_(planned) {
    for (const int pair : {kFront, kRear}) wheels_[pair] = path.centre(planned.value.wheels[pair]);
    for (double turn = kSwing; turn >= kLeastSwing && swing_ == 0.0; turn -= kSwingStep)
        if (possible(turn, path) && possible(-turn, path)) swing_ = turn;
}

Body Nod::body(double turn) const {
    const Planned& from = planned_.value;
    const Vec2 trunk = from.com + Turn::by(turn) * (from.trunk - from.com);
    return {trunk.x, trunk.z, from.pitch + turn};
}

bool Nod::possible(double turn, const WheelPath& path) const {
    const PoseGeometry pose = pose_geometry(path.terrain(), robot_, body(turn), wheels_, {2 * kClear, 2 * kClear, 2 * kClear});
    return pose.posture.reach_slack > kReach && pose.joints.slack > kJoint && pose.trunk > kClear && pose.links > kClear && pose.legs > kClear;
}

double Nod::duration() const { return swing_ > 0.0 ? kPeriodOfNod : 0.0; }

// Begins and ends at rest.
Planned Nod::posed(double time) const {
    const double phase = 2.0 * std::numbers::pi * time / kPeriodOfNod;
    const Body at = body(swing_ / kPeak * 0.5 * std::sin(phase) * (1.0 - std::cos(phase)));
    const Posture posture = make_posture(robot_, at, wheels_);
    const PoseJoints joints = pose_joints(robot_, at.pitch, posture);
    Planned out = planned_.value;
    out.joints = {joints.q[kFront].thigh, joints.q[kFront].calf, joints.q[kRear].thigh, joints.q[kRear].calf};
    out.pitch = at.pitch, out.com = posture.com, out.trunk = {at.x, at.z};
    return out;
}

Reference Nod::at(double time) const {
    Reference out = planned_;
    out.value = posed(time);
    const auto before = std::bit_cast<Numbers>(posed(time - kDifference)), after = std::bit_cast<Numbers>(posed(time + kDifference));
    const auto now = std::bit_cast<Numbers>(out.value);
    Numbers rate{}, acceleration{};
    for (std::size_t i = 0; i < kPlannedWidth; ++i) {
        rate[i] = (after[i] - before[i]) / (2.0 * kDifference);
        acceleration[i] = (after[i] - 2.0 * now[i] + before[i]) / (kDifference * kDifference);
    }
    out.rate = std::bit_cast<Planned>(rate), out.acceleration = std::bit_cast<Planned>(acceleration);
    return out;
}

}  // namespace stairwright::control
