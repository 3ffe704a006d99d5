#include "stairwright/poses/critical_pose.hpp"

#include <algorithm>
#include <cmath>

#include "stairwright/poses/footing.hpp"
#include "stairwright/wheel_contacts.hpp"

namespace stairwright::poses {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPastCorner = 2e-3;  // m past a corner, where the face ahead alone carries the wheel
constexpr int kShifts = 3;            // times that the reference is moved until the CoM has room
constexpr double kNoShift = 1e-3;     // m; such a shift is none
constexpr double kSameReference = 3e-3;  // m; so small a change of the reference changes nothing
constexpr double kSlopeShare = 0.8;      // of the line between the wheels that the trunk's first guess takes
// First guesses: the one given; along the wheels; pitched as before; higher and turned towards what comes.
enum Guess { kGiven, kAlong, kAsBefore, kHigh, kUsual };
constexpr double kHigher = 0.3, kRaised = 0.6;                             // nominal heights, rad
constexpr std::array<double, 5> kPitches = {-1.2, -0.6, 0.0, 0.6, 1.2};  // rad; of the patient search
constexpr std::array<double, 3> kHeights = {0.5, 0.8, 1.1};  // of the nominal height, above the wheels' middle; likewise

struct WheelLine {
    Vec2 front, rear;

    Vec2 middle() const { return 0.5 * (front + rear); }
    // Pitch of a trunk along most of it.
    double pitch() const { return -kSlopeShare * std::atan2(front.z - rear.z, std::max(front.x - rear.x, 0.1)); }
};

Unknowns first_guess(const PoseProblem& problem, const PoseTask& task, const ContactPair& pair, double rear,
                     const WheelLine& line, int k) {
    const double height = problem.robot.robot.robot.nominal_height;
    const double z = std::max(task.reference[1], line.middle().z + 0.5 * height);
    Unknowns y = {task.reference[0], z, line.pitch(), pair.front, rear};
    if (k == kAsBefore) y[2] = pair.posture[0];
    if (k == kHigh) {
        y[1] += kHigher * height;
        y[2] = pair.climbs ? -kRaised : kRaised;
    }
    if (k >= kUsual) {
        const std::size_t n = static_cast<std::size_t>(k - kUsual);
        y[2] = kPitches[n % kPitches.size()];
        y[1] = line.middle().z + kHeights[n / kPitches.size()] * height;
    }
    return y;
}

// From the first guess that succeeds, else of the least violated.
PoseSolution first_solution(const PoseProblem& problem, const PoseTask& task, const ContactPair& pair, double rear,
                            const Unknowns& start, bool patient) {
    const WheelLine line = {problem.path.centre(pair.front), problem.path.centre(rear)};
    PoseSolution best;
    best.x.fill(std::numeric_limits<double>::quiet_NaN());
    const int guesses = kUsual + (patient ? static_cast<int>(kPitches.size() * kHeights.size()) : 0);
    for (int k = std::isnan(start[0]) ? kAlong : kGiven; k < guesses; ++k) {
        const Unknowns guess = k == kGiven ? start : first_guess(problem, task, pair, rear, line, k);
        const PoseSolution found = solve_pose(problem, task, guess);
        if (found.violation < best.violation) best = found;
        if (best.violation <= kSolved) break;
    }
    return best;
}

struct ComRoom {
    double shift = 0.0;          // least shift of the CoM that gives it the margin wanted [m]
    double margin = -kInfinity;  // that it has [m]
};

ComRoom com_room(const PoseProblem& problem, double friction, const ContactPair& pair, const Variables& x) {
    PoseState state(problem.robot);
    place(problem.robot, problem.path, unknowns_of(x), state);
    const double at = state.com.at.x;
    Interval interval = stated_interval(problem.path, {x[7], x[8]}, friction);
    // Just after the first pose the face alone carries the front wheel; on the way down it still does just before the
    // second one, and there the CoM has the least time to move on.
    if (pair.ahead || !pair.climbs) {
        const double on_face = pair.ahead ? x[7] + kPastCorner : pair.face;
        const Interval both = interval.intersect(stated_interval(problem.path, {on_face, x[8]}, friction));
        if (!both.empty()) interval = both;
    }
    if (interval.empty()) return {};
    const double spare = std::min(kWantedMargin, (interval.upper - interval.lower) / 2);
    const double wanted = std::min(std::max(at, interval.lower + spare), interval.upper - spare);
    return {wanted - at, std::min(at - interval.lower, interval.upper - at)};
}

}  // namespace

PoseTask PoseRules::task() const {
    PoseTask out;
    out.weights = weights;
    out.lower = lower, out.upper = upper;
    out.clearance = clearance, out.legs_distance = legs_distance, out.behind = behind;
    out.exact_links = exact_links;
    return out;
}

std::array<double, 7> reference_posture(const PoseProblem& problem, double x) {
    const PoseModel& model = problem.robot;
    const Robot& robot = model.robot.robot;
    const double ground = mean_height(problem.terrain, x + robot.legs[kRear].hip.x, x + robot.legs[kFront].hip.x);
    const Joints& q = model.standing;
    return {x, ground + robot.nominal_height, 0.0, q[0], q[1], q[2], q[3]};
}

CriticalPose critical_pose(const PoseProblem& problem, const PoseRules& rules, const ContactPair& pair, double rear,
                           const Unknowns& start, bool patient) {
    PoseTask task = rules.task();
    task.lower[7] = task.upper[7] = pair.front;
    task.lower[8] = std::max(pair.rear.lower, rear - kRearSpacing / 2);
    task.upper[8] = std::max(task.lower[8], std::min(pair.rear.upper, rear + kRearSpacing / 2));
    if (!pair.climbs) task.behind = -kInfinity;
    double middle = (problem.path.centre(pair.front).x + problem.path.centre(rear).x) / 2;
    Unknowns first = start;
    CriticalPose best;
    for (int k = 0; k < kShifts; ++k) {
        task.reference = reference_posture(problem, middle);
        const PoseSolution found = first_solution(problem, task, pair, rear, first, patient && k == 0);
        const bool solved = found.violation <= kSolved;
        const ComRoom room = solved ? com_room(problem, rules.friction, pair, found.x) : ComRoom{};
        if (k == 0 || (solved && room.margin > best.margin)) {
            best = {found, room.margin, 0.0};
            for (int i = 0; i < 5; ++i) best.turn += (found.x[2 + i] - pair.posture[i]) * (found.x[2 + i] - pair.posture[i]);
        }
        if (!solved || std::abs(room.shift) < kNoShift) break;
        first = unknowns_of(found.x);
        const double moved = found.x[0] + room.shift - middle;
        if (std::abs(moved) < kSameReference) break;
        middle += moved;
    }
    return best;
}

std::vector<CriticalPose> critical_poses(const PoseProblem& problem, const PoseRules& rules, const ContactPair& pair,
                                         const std::vector<double>& rears) {
    std::vector<CriticalPose> out;
    Unknowns start;
    start.fill(std::numeric_limits<double>::quiet_NaN());
    int good = 0;
    for (const double rear : rears) {
        const CriticalPose found = critical_pose(problem, rules, pair, rear, start, false);
        if (!found.solved()) continue;
        start = unknowns_of(found.solution.x);
        good += found.margin >= 0.99 * kWantedMargin;
        out.push_back(found);
        if (good >= kEnough) break;
    }
    return out;
}

}  // namespace stairwright::poses
