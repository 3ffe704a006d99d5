#include "stairwright/control/static_forces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "stairwright/control/balance_qp.hpp"

namespace stairwright::control {

namespace {

// Shares of the friction and largest normal force of a wheel in weights, tried in turn until the forces hold the
// robot: little friction first, but not at the price of pinching. Near the edge of what a share allows, wheels on
// opposite faces may press far harder than they must, even push the robot down: more friction is worth that.
// Forces that hold it wherever the next edge is, to within what a robot knows of it, come before all others.
struct Attempt {
    bool any_edge;
    double friction_share, load_limit;
};
constexpr Attempt kAttempts[] = {{true, 0.6, 0.6},  {true, 0.75, 0.6}, {true, 0.85, 0.6}, {false, 0.6, 0.6},
                                 {false, 0.75, 0.6}, {false, 0.9, 0.6}, {false, 1.0, 0.6}, {false, 1.0, 10.0}};
constexpr double kUnsure = 0.06;  // rad that a robot takes a wheel to be farther round an edge, or less, than it is
constexpr double kReached = 0.0002;  // m before a corner; plans change what wheels lean on this near to it
constexpr double kPassed = 0.003;    // m past it, where a wheel is to climb and no longer stands on what it comes from
constexpr double kHeld = 0.01;    // of the weight; forces that miss less than this hold it
constexpr double kWorthMore = 0.85;  // more friction is taken where the forces' squares fall below this share
constexpr double kMoment = 20.0;  // 1/m^2, weight of the moment against the forces
constexpr double kSmall = 1e-4;   // weight of the forces' size

struct Trial {
    std::array<Vec2, 2> normal;  // of the faces that the pairs rest on
    Forces forces{};
    double missed = 0.0;  // weighted square of the wrench by which they miss holding the robot [N^2]
};

struct Pose {
    std::array<double, 2> places;
    Vec2 com;
    double weight;
};

// Fills `trial` with the smallest forces that come nearest to holding the robot; its forces are the guess.
void rest(const WheelPath& path, const Pose& pose, const std::array<Lean, 2>& lean, const std::array<double, 2>& friction,
          double load_limit, Trial& trial) {
    constexpr double S[3] = {1.0, 1.0, kMoment};
    double A[3][8];
    BalanceQp qp;
    for (int wheel = 0; wheel < 4; ++wheel) {
        const int pair = wheel / 2, t = 2 * wheel, n = t + 1;
        const double s = pose.places[pair];
        const WheelSupport support = wheel_support(path, s, s, friction[pair], lean[pair]);
        const Vec2 normal = support.normal, centre = path.centre(s);
        trial.normal[pair] = normal;
        qp.friction[wheel] = support.friction;
        const Vec2 lever = {centre.x - support.reach * normal.x - pose.com.x, centre.z - support.reach * normal.z - pose.com.z};
        A[0][t] = normal.z, A[1][t] = -normal.x, A[2][t] = lever.z * normal.z + lever.x * normal.x;
        A[0][n] = normal.x, A[1][n] = normal.z, A[2][n] = lever.z * normal.x - lever.x * normal.z;
    }
    for (int i = 0; i < 8; ++i) {
        for (int j = 0; j < 8; ++j) {
            qp.H[i][j] = i == j ? kSmall : 0.0;
            for (int r = 0; r < 3; ++r) qp.H[i][j] += S[r] * A[r][i] * A[r][j];
        }
        qp.g[i] = -A[1][i] * pose.weight;
    }
    qp.load_limit = load_limit * pose.weight;
    solve(qp, trial.forces);
    trial.missed = 0.0;
    for (int r = 0; r < 3; ++r) {
        double total = r == 1 ? -pose.weight : 0.0;
        for (int i = 0; i < 8; ++i) total += A[r][i] * trial.forces[i];
        trial.missed += S[r] * total * total;
    }
}

// The ways in which a wheel there may lean on the ground: before a corner on the face that it comes along, in it on either
// face or both, past it on the face that it goes along, and elsewhere they are all the same.
std::span<const Lean> ways(const WheelPath& path, double s) {
    static constexpr std::array<Lean, 3> kAll = {Lean::both, Lean::after, Lean::before};
    const std::span<const Lean> all(kAll), before = all.last(1), after = all.subspan(1, 1);
    const auto& corners = path.corners();
    const double near = corner_planned(path);
    for (std::size_t k = path.corner_from(s - near); k < corners.size() && corners[k] <= s + near; ++k)
        if (std::abs(s - corners[k]) < near) return s < corners[k] - kReached ? before : s > corners[k] + kPassed ? after : all;
    return all.first(1);
}

// Friction of the cone of forces that the ground can give wherever within kUnsure of `s` the wheel is.
double sure_friction(const WheelPath& path, double s, double friction) {
    const double way = kUnsure * path.radius(), turn = std::max(path.turn(s - way, s), path.turn(s, s + way));
    return std::tan(std::max(0.0, std::atan(friction) - turn));
}

// The smallest forces of one attempt over all ways of touching the ground.
struct Resting {
    bool held = false;
    double value = std::numeric_limits<double>::infinity();  // their squares [N^2]; where none hold, of what they miss
    StaticForces forces;
};

Resting resting(const WheelPath& path, const Pose& pose, double friction, const Attempt& attempt) {
    const auto front = ways(path, pose.places[0]), rear = ways(path, pose.places[1]);
    Resting out;
    Trial trial;
    std::array<double, 2> usable;
    for (int pair = 0; pair < 2; ++pair) {
        const double sure = attempt.any_edge ? sure_friction(path, pose.places[pair], friction) : friction;
        usable[pair] = attempt.friction_share * sure;
    }
    for (std::size_t way = 0; way < front.size() * rear.size(); ++way) {
        const std::array<Lean, 2> lean = {front[way % front.size()], rear[way / front.size()]};
        // What leans on both faces takes no friction: else one of them would do.
        const bool wedged[] = {lean[0] == Lean::both && front.size() > 1, lean[1] == Lean::both && rear.size() > 1};
        rest(path, pose, lean, {wedged[0] ? 0.0 : usable[0], wedged[1] ? 0.0 : usable[1]}, attempt.load_limit, trial);
        const bool holds = trial.missed < (kHeld * pose.weight) * (kHeld * pose.weight);
        double size = 0.0;
        for (const double f : trial.forces) size += f * f;
        const double value = holds ? size : trial.missed;
        if (holds < out.held || (holds == out.held && value >= out.value)) continue;
        out.held = holds, out.value = value;
        out.forces.friction_share = attempt.friction_share, out.forces.lean = lean;
        for (int pair = 0; pair < 2; ++pair) {
            const Vec2 normal = trial.normal[pair];
            const double t = trial.forces[4 * pair] + trial.forces[4 * pair + 2];
            const double n = trial.forces[4 * pair + 1] + trial.forces[4 * pair + 3];
            out.forces.force[pair] = {t * normal.z + n * normal.x, n * normal.z - t * normal.x};
        }
    }
    return out;
}

}  // namespace

StaticForces static_forces(const WheelPath& path, double weight, double friction, std::array<double, 2> places, Vec2 com) {
    const Pose pose = {places, com, weight};
    Resting best;
    bool any_edge = true;  // of the best
    for (const Attempt& attempt : kAttempts) {
        if (best.held && any_edge && !attempt.any_edge) break;
        const Resting next = resting(path, pose, friction, attempt);
        if (best.held && !(next.held && next.value < kWorthMore * best.value)) break;
        best = next, any_edge = attempt.any_edge;
    }
    return best.forces;
}

}  // namespace stairwright::control
