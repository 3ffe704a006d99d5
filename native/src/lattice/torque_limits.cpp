#include "stairwright/lattice/torque_limits.hpp"

#include <cmath>

namespace stairwright::lattice {

bool TorqueLimits::hold(const Problem& problem, const Cell& cell, std::size_t number, const ComIntervals& com, const Body& body,
                        Turn pitch, double com_x) {
    std::optional<WheelLoads>& loads = loads_[number];
    const double weight = problem.robot.mass * kGravity;
    if (!loads) {
        const WheelPlaces s = {problem.s[cell.front], problem.s[cell.rear]};
        loads.emplace(path_, s, friction_, lag_, stairwright::Interval{com.friction.lower, com.friction.upper}, weight);
    }
    const std::array<Vec2, 2> wheels = {problem.centres[cell.front], problem.centres[cell.rear]};
    for (const int pair : {kFront, kRear}) {
        const Leg& leg = problem.robot.legs[pair].leg;
        const LegPoints points = place_leg(leg, body, pitch, wheels[pair]);
        for (int way = 0; way < loads->ways(); ++way) {
            const auto load = loads->at(way, com_x);
            if (!load) continue;
            const LegTorques torques = static_torques(leg, points, (*load)[pair]);
            if (std::abs(torques.thigh) > share_ * leg.thigh_motor.torque || std::abs(torques.calf) > share_ * leg.calf_motor.torque ||
                std::abs(torques.wheel) > share_ * leg.wheel_motor.torque)
                return false;
        }
    }
    return true;
}

}  // namespace stairwright::lattice
