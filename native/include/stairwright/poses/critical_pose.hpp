// The paper's poses (eqs 17-22): optimal with the wheels near given places, and with room for the centre of mass.
#pragma once

#include "stairwright/poses/sqp.hpp"

namespace stairwright::poses {

inline constexpr double kSolved = 1e-6;          // m and rad; a solution violates no constraint by more
inline constexpr double kWantedMargin = 0.05;    // m of CoM margin beyond which other things decide
inline constexpr double kRearSpacing = 0.05;     // m between the places of the rear wheels that are tried
inline constexpr int kEnough = 3;                // poses with the margin wanted; then the search ends

// What all poses of one plan keep. SI units.
struct PoseRules {
    double friction = 0.0;
    std::array<double, 7> weights{};  // of eq 17
    Variables lower{}, upper{};       // those of the wheels are filled in for each pose
    double clearance = 0.0;           // of trunk and links from the ground
    double legs_distance = 0.0;       // of the front leg from the rear one
    double behind = 0.0;              // of the rear contact behind the rear hip (eq 20)
    bool exact_links = true;          // keep whole links clear, not only the collision points

    PoseTask task() const;
};

// Where a pose is wanted: arc lengths [m].
struct ContactPair {
    double front = 0.0;               // of the front wheels
    Range rear;                       // of the rear ones
    bool ahead = false;               // the front wheels are about to take a face, which alone must carry them next
    double face = 0.0;                // where on the face the front wheels are, or were, while the rear ones are here
    bool climbs = true;               // eq 20 keeps the robot from falling backward; on the way down it does not apply
    std::array<double, 5> posture{};  // pitch and joints of the pose before
};

struct CriticalPose {
    PoseSolution solution;
    double margin = -std::numeric_limits<double>::infinity();  // CoM margin [m], also with the face ahead alone
    double turn = std::numeric_limits<double>::infinity();  // sum of squares of the turns of pitch and joints since the pose before

    bool solved() const { return solution.violation <= kSolved; }
};

// Trunk and joints (7) that eq 17 draws poses to: nominal height over the ground below.
std::array<double, 7> reference_posture(const PoseProblem& problem, double x);

// The optimal pose with the rear wheels near `rear`. The trunk's reference is first the middle between the wheels,
// then, where that leaves the CoM less than kWantedMargin, moved by what is missing. `start` is a first guess, nan
// for none; `patient` tries many where the usual ones find nothing.
CriticalPose critical_pose(const PoseProblem& problem, const PoseRules& rules, const ContactPair& pair, double rear,
                           const Unknowns& start, bool patient);

// Poses with the rear wheels near each of `rears`, until enough have the margin wanted.
std::vector<CriticalPose> critical_poses(const PoseProblem& problem, const PoseRules& rules, const ContactPair& pair,
                                         const std::vector<double>& rears);

}  // namespace stairwright::poses
