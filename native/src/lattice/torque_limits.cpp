#include "stairwright/lattice/torque_limits.hpp"

#include <algorithm>
#include <cmath>

namespace stairwright::lattice {

namespace {

// Shares of a motor's torque: a path may take no more than the first (smoothing keeps a little below), below the second
// less is no better.
constexpr double kFirm = 0.88, kLight = 0.7;
constexpr double kKept = 101.0;  // quality from here on: as much as a path may take

}  // namespace

std::uint8_t TorqueLimits::quality(const Problem& problem, const Cell& cell, std::size_t number, const ComIntervals& com, Vec2 trunk,
                        Turn pitch, double com_x) {
    std::optional<WheelLoads>& loads = loads_[number];
    const double weight = problem.robot.mass * kGravity;
    if (!loads) {
        const WheelPlaces s = {problem.s[cell.front], problem.s[cell.rear]};
        loads.emplace(path_, s, friction_, lag_, stairwright::Interval{com.friction.lower, com.friction.upper}, weight);
    }
    std::array<LegLevers, 2> levers;
    for (const int pair : {kFront, kRear}) {
        const Leg& leg = problem.robot.legs[pair].leg;
        levers[pair] = leg_levers(leg, place_leg(leg, trunk, pitch, problem.centres[pair == kFront ? cell.front : cell.rear]));
    }
    double taken = 0.0;  // the largest share
    for (int way = 0; way < loads->ways(); ++way) {
        const auto load = loads->at(way, com_x);
        if (!load) continue;
        for (const int pair : {kFront, kRear}) {
            const Leg& leg = problem.robot.legs[pair].leg;
            const LegTorques torques = static_torques(levers[pair], (*load)[pair]);
            taken = std::max({taken, std::abs(torques.thigh) / leg.thigh_motor.torque, std::abs(torques.calf) / leg.calf_motor.torque,
                              std::abs(torques.wheel) / leg.wheel_motor.torque});
            if (taken > share_) return 0;
        }
    }
    const double kept = kKept + (255.0 - kKept) * std::min(1.0, (kFirm - taken) / (kFirm - kLight));
    const double beyond = 1.0 + (kKept - 2.0) * (share_ - taken) / std::max(share_ - kFirm, 1e-9);
    return static_cast<std::uint8_t>(taken <= kFirm ? kept : beyond);
}

}  // namespace stairwright::lattice
