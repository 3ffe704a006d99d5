// Poses between critical ones: the sound pose nearest to one that is wanted, and whether balance holds on the way.
#pragma once

#include <optional>
#include <span>

#include "stairwright/poses/critical_pose.hpp"

namespace stairwright::poses {

inline constexpr double kClearanceBetween = 0.004;  // m; between critical poses, where room is scarce

// The pose with the wheels at `wheels` nearest to `wanted` (x, z, pitch, joints, which count little), its CoM within
// `com`; eq 20 does not apply. With the full clearance if that is possible, else with kClearanceBetween. `start` is
// another first guess, nan for none.
PoseSolution nearest_pose(const PoseProblem& problem, const PoseRules& rules, const std::array<double, 2>& wheels,
                          const std::array<double, 7>& wanted, Interval com, const Unknowns& start);

// A pose between critical ones whose CoM has to move: wheels, the even pose (x, z, pitch, joints), its CoM, the move of
// the CoM that is wanted, and where balance ends [m, rad].
struct PoseToMove {
    std::array<double, 2> wheels{};
    std::array<double, 7> even{};
    double com = 0.0, shift = 0.0;
    Interval balance;
};

// The clear pose nearest to the even one with its CoM moved as wanted; where the legs do not allow that, by as much of
// it as they do. `start` is a first guess, nan for none.
std::optional<Variables> moved_pose(const PoseProblem& problem, const PoseRules& rules, const PoseToMove& pose, const Unknowns& start);

// Moves the trunks (x, z, pitch) of samples `which`, in order, to `moved_pose`s that are found, which are then `sound`.
// The first guess is the sample before if that is sound, else the last pose found.
void move_poses(const PoseProblem& problem, const PoseRules& rules, std::span<const PoseToMove> poses,
                std::span<const std::size_t> which, std::span<std::array<double, 3>> trunks, std::vector<bool>& sound);

// Least slack of limits, clearances and balance [m or rad], with the joints; -inf and nan out of reach. Eq 20 is left out.
struct PoseSlack {
    double least = 0.0;
    Joints q{};
};
PoseSlack pose_slack(const PoseProblem& problem, const PoseRules& rules, const Unknowns& y, Interval com);

// How far the CoM of the even motion from one pose to the next lies, at worst, where no clear pose near it keeps
// balance [m]; 0 if nowhere.
double balance_lost(const PoseProblem& problem, const PoseRules& rules, const Variables& begin, const Variables& end);

}  // namespace stairwright::poses
