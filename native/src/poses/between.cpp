#include "stairwright/poses/between.hpp"

#include <algorithm>
#include <cmath>

#include "stairwright/wheel_contacts.hpp"
#include "stairwright/whole.hpp"

namespace stairwright::poses {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::array<double, 7> kWeights = {100.0, 30.0, 3.0, 0.05, 0.05, 0.05, 0.05};  // 1/m^2, 1/rad^2
constexpr double kStep = 0.01;    // m between places looked at
constexpr int kTries = 6;         // places where the even motion tips that are solved for
constexpr double kSpare = 0.002;  // m that the CoM keeps from where balance ends
constexpr std::array<double, 3> kLifts = {0.0, -0.04, 0.04};  // m; a trunk that cannot be there as high as it is may be so
constexpr int kMoves = 5;         // of the trunk, until the CoM is where it must be
constexpr std::array<double, 3> kRooms = {0.015, 0.006, 0.002};  // m that the CoM keeps from where balance ends, if it must
constexpr std::array<double, 4> kShares = {0.75, 0.5, 0.25, 0.0};  // of the move of the CoM, where no pose is balanced
constexpr double kInside = 5e-4;  // m; so far inside it is aimed for, since legs take a part of each move back

// With the wheels at given places, eq 20 left out, whole links kept clear.
PoseTask task_between(const PoseRules& rules, double front, double rear, Interval com) {
    PoseTask task = rules.task();
    task.lower[7] = task.upper[7] = front;
    task.lower[8] = task.upper[8] = rear;
    task.behind = -kInfinity;
    task.exact_links = true;
    task.com = com;
    return task;
}

// Trunk and wheels at a share of the way.
Unknowns even(const Variables& begin, const Variables& end, double share) {
    Unknowns y;
    for (int j = 0; j < kUnknowns; ++j) {
        const int k = j < 3 ? j : j + 4;
        y[j] = begin[k] + share * (end[k] - begin[k]);
    }
    return y;
}

// Whether a pose is clear once its trunk is moved to where the CoM is within `com`.
bool clear_when_moved(const PoseProblem& problem, const PoseRules& rules, Interval com, const Unknowns& from) {
    const double inner = std::min(kInside, (com.upper - com.lower) / 2);
    PoseTask task = task_between(rules, from[3], from[4], com);
    task.clearance = kClearanceBetween;
    PoseState state(problem.robot);
    Constraints near;
    for (const double lift : kLifts) {
        Unknowns y = from;
        y[1] += lift;
        for (int k = 0; k < kMoves; ++k) {
            if (!place(problem.robot, problem.path, y, state)) break;
            const double at = state.com.at.x;
            if (com.contains(at)) {
                collect(problem.robot, problem.cells, task, state, near);
                if (near.least >= -kSolved) return true;
                break;
            }
            y[0] += std::min(std::max(at, com.lower + inner), com.upper - inner) - at;
        }
    }
    return false;
}

// Moves of the CoM to try [m]: all of it, then with less and less room, then part of it.
std::vector<double> moves_of(const PoseToMove& pose) {
    if (pose.shift == 0.0) return {0.0};
    std::vector<double> out = {pose.shift};
    const bool ahead = pose.shift > 0.0;
    const double need = (ahead ? pose.balance.lower : pose.balance.upper) - pose.com;  // to where the room ends
    for (const double room : kRooms) {
        const double move = need + std::copysign(room, pose.shift);
        if (0.0 < move / pose.shift && move / pose.shift < 1.0) out.push_back(move);
    }
    for (const double share : kShares) out.push_back(share * pose.shift);
    return out;
}

}  // namespace

PoseSolution nearest_pose(const PoseProblem& problem, const PoseRules& rules, const std::array<double, 2>& wheels,
                          const std::array<double, 7>& wanted, Interval com, const Unknowns& start) {
    PoseTask task = task_between(rules, wheels[0], wheels[1], com);
    task.reference = wanted;
    task.weights = kWeights;
    PoseSolution best;
    for (const double clearance : {rules.clearance, kClearanceBetween}) {
        task.clearance = clearance;
        best = {};
        best.x.fill(std::numeric_limits<double>::quiet_NaN());
        for (const Unknowns& from : {start, Unknowns{wanted[0], wanted[1], wanted[2]}}) {
            if (std::isnan(from[0])) continue;
            const PoseSolution found = solve_pose(problem, task, {from[0], from[1], from[2], wheels[0], wheels[1]});
            if (found.violation < best.violation) best = found;
            if (best.violation <= kSolved) return best;
        }
    }
    return best;
}

std::optional<Variables> moved_pose(const PoseProblem& problem, const PoseRules& rules, const PoseToMove& pose, const Unknowns& start) {
    std::array<double, 7> wanted = pose.even;
    for (const double move : moves_of(pose)) {
        const double place = pose.com + move;
        wanted[0] = pose.even[0] + move;
        Interval com = {-kInfinity, kInfinity};
        if (move != 0.0) (pose.shift > 0.0 ? com.lower : com.upper) = place;
        const PoseSolution found = nearest_pose(problem, rules, pose.wheels, wanted, com, start);
        if (found.violation <= kSolved) return found.x;
    }
    return std::nullopt;
}

void move_poses(const PoseProblem& problem, const PoseRules& rules, std::span<const PoseToMove> poses,
                std::span<const std::size_t> which, std::span<std::array<double, 3>> trunks, std::vector<bool>& sound) {
    Unknowns start;
    start.fill(std::numeric_limits<double>::quiet_NaN());
    for (const std::size_t i : which) {
        if (i > 0 && sound[i - 1]) std::copy_n(trunks[i - 1].begin(), 3, start.begin());
        const std::optional<Variables> found = moved_pose(problem, rules, poses[i], start);
        if (!found) continue;
        std::copy_n(found->begin(), 3, trunks[i].begin());
        start = unknowns_of(*found);
        sound[i] = true;
    }
}

PoseSlack pose_slack(const PoseProblem& problem, const PoseRules& rules, const Unknowns& y, Interval com) {
    PoseState state(problem.robot);
    PoseSlack out{-kInfinity, {}};
    out.q.fill(std::numeric_limits<double>::quiet_NaN());
    if (!place(problem.robot, problem.path, y, state)) return out;
    Constraints near;
    collect(problem.robot, problem.cells, task_between(rules, y[3], y[4], com), state, near);
    return {near.least, state.q};
}

double balance_lost(const PoseProblem& problem, const PoseRules& rules, const Variables& begin, const Variables& end) {
    const double longest = std::max(end[7] - begin[7], end[8] - begin[8]);
    const auto n = static_cast<int>(std::max<std::size_t>(1, whole_part(std::ceil(longest / kStep))));
    PoseState state(problem.robot);
    std::vector<int> tipping;
    std::vector<double> missing(static_cast<std::size_t>(n), 0.0);
    int hardest = 0;
    for (int i = 1; i < n; ++i) {
        const Unknowns y = even(begin, end, static_cast<double>(i) / n);
        const Interval interval = stated_interval(problem.path, {y[3], y[4]}, rules.friction);
        if (interval.empty())
            missing[i] = kInfinity;
        else if (place(problem.robot, problem.path, y, state))
            missing[i] = std::max({0.0, interval.lower - state.com.at.x, state.com.at.x - interval.upper});
        if (missing[i] <= 0.0) continue;
        tipping.push_back(i);
        if (missing[i] > missing[hardest]) hardest = i;
    }
    if (tipping.empty()) return 0.0;
    Unknowns none;
    none.fill(std::numeric_limits<double>::quiet_NaN());
    double worst = 0.0;
    int before = -1;
    for (int k = 0; k <= kTries; ++k) {  // the hardest place first, then a few of the others
        const int i = k == 0 ? hardest : tipping[(tipping.size() - 1) * static_cast<std::size_t>(k - 1) / (kTries - 1)];
        if (k > 0 && (i == hardest || i == before)) continue;
        before = i;
        const double share = static_cast<double>(i) / n;
        const Unknowns y = even(begin, end, share);
        const Interval interval = stated_interval(problem.path, {y[3], y[4]}, rules.friction);
        if (!interval.empty()) {
            const double spare = std::min(kSpare, 0.5 * (interval.upper - interval.lower));
            const Interval inner = {interval.lower + spare, interval.upper - spare};
            if (clear_when_moved(problem, rules, inner, y)) continue;
            std::array<double, 7> wanted;
            for (int j = 0; j < 7; ++j) wanted[j] = begin[j] + share * (end[j] - begin[j]);
            if (nearest_pose(problem, rules, {y[3], y[4]}, wanted, inner, none).violation <= kSolved) continue;
        }
        worst = std::max(worst, missing[i]);
        if (k == 0) break;
    }
    return worst;
}

}  // namespace stairwright::poses
