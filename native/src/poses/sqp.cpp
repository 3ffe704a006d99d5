#include "stairwright/poses/sqp.hpp"

#include <algorithm>
#include <cmath>

#include "stairwright/poses/lagrangian.hpp"
#include "stairwright/poses/quadratic_program.hpp"

namespace stairwright::poses {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTolerance = 1e-9;  // m and rad; the largest violation of a solution
constexpr double kShortStep = 1e-6;  // m and rad; a smaller step ends the iteration
constexpr double kLastStep = 3e-5;   // m and rad; after such a whole step the next one would be that short
constexpr int kIterations = 60;
constexpr int kPatience = 8;  // iterations in which a violation must fall by kFall, or there is no solution near
constexpr double kFall = 0.8;
constexpr int kHalvings = 8;
constexpr int kMemory = 6;  // iterations; a step must better the worst of so many (Grippo, Lampariello, Lucidi 1986)
constexpr Unknowns kLongest = {0.15, 0.15, 0.5, 0.05, 0.05};  // m, m, rad, m, m; of one step
constexpr double kFarthest = 10.0;  // m and rad; rows that meet only beyond it contradict each other here
constexpr double kLeastCurvature = 1e-3;
constexpr double kRelaxed = 1e4;  // cost of what linearised constraints lack where they contradict each other

struct Step {
    Unknowns by{};
    std::vector<double> multipliers;
    bool relaxed = false;  // the rows contradicted each other and gave way
};

// Step of the quadratic model over the unknowns that are free.
Step quadratic_step(const PoseState& st, const GradientY& g, const HessianY& h, const Constraints& near,
                    const std::vector<int>& free) {
    QuadraticProgram program;
    const int n = program.n = static_cast<int>(free.size());
    for (int i = 0; i < n; ++i) {
        program.gradient[i] = g[free[i]];
        for (int j = 0; j < n; ++j) program.hessian[i][j] = h[free[i]][free[j]];
    }
    make_positive(program.hessian, n, kLeastCurvature);
    for (const Constraint& row : near.rows) {
        const GradientY gy = reduce(st, gradient(st, row));
        QpVector a{};
        for (int j = 0; j < n; ++j) a[j] = gy[free[j]];
        program.rows.push_back(a);
        program.bounds.push_back(-row.value);
    }
    Step out;
    QpVector d;
    out.relaxed = program.solve(d, out.multipliers) != QpStatus::kSolved;
    for (int i = 0; i < n; ++i) out.relaxed = out.relaxed || !(std::abs(d[i]) < kFarthest);
    if (out.relaxed) {
        // One more unknown: how much all rows give way, dear and never negative.
        const std::size_t m = near.rows.size();
        program.n = n + 1;
        program.hessian[n][n] = kRelaxed;
        program.gradient[n] = 1.0;
        for (QpVector& row : program.rows) row[n] = 1.0;
        QpVector alone{};
        alone[n] = 1.0;
        program.rows.push_back(alone);
        program.bounds.push_back(0.0);
        program.solve(d, out.multipliers);
        out.multipliers.resize(m);
    }
    for (int i = 0; i < n; ++i) out.by[free[i]] = d[i];
    return out;
}

ActiveRows active_rows(const Constraints& near, const std::vector<double>& multipliers, std::size_t most) {
    ActiveRows out;
    for (std::size_t k = 0; k < near.rows.size() && out.rows.size() < most; ++k) {
        if (!(multipliers[k] > 0.0)) continue;
        out.rows.push_back(near.rows[k]);
        out.multipliers.push_back(multipliers[k]);
    }
    return out;
}

// Move the trunk of a first guess to where both legs reach their wheels; false if nowhere.
bool within_reach(const PoseProblem& problem, Unknowns& y, PoseState& st) {
    for (int round = 0; round < 20; ++round) {
        bool moved = false;
        const Turn pitch = Turn::by(y[2]);
        for (int k = 0; k < 2; ++k) {
            const LegModel& model = problem.robot.robot.legs[k];
            const Vec2 off = Vec2{y[0], y[1]} + pitch * model.leg.hip - problem.path.centre(y[3 + k]);
            const double d = norm(off), spare = 0.02 * (model.reach.most - model.reach.least);
            const double want = std::min(std::max(d, model.reach.least + spare), model.reach.most - spare);
            if (std::abs(d - want) <= 1e-9) continue;
            moved = true;
            const double share = (want - d) / std::max(d, 1e-6);
            y[0] += share * off.x;
            y[1] += share * off.z;
        }
        if (!moved) break;
    }
    return place(problem.robot, problem.path, y, st);
}

Unknowns moved_by(const Unknowns& y, double share, const Unknowns& step) {
    Unknowns out;
    for (int k = 0; k < kUnknowns; ++k) out[k] = y[k] + share * step[k];
    return out;
}

double largest(const Unknowns& step) {
    double out = 0.0;
    for (const double by : step) out = std::isnan(by) ? by : std::max(out, std::abs(by));
    return out;
}

}  // namespace

double cost(const PoseTask& task, const PoseState& st) {
    double total = 0.0;
    for (int k = 0; k < 7; ++k) {
        const double error = (k < 3 ? st.y[k] : st.q[k - 3]) - task.reference[k];
        total += task.weights[k] * error * error;
    }
    return total;
}

PoseSolution solve_pose(const PoseProblem& problem, const PoseTask& task, const Unknowns& start) {
    PoseState st(problem.robot), trial(problem.robot);
    Unknowns y = start;
    for (int k = 0; k < 2; ++k) y[3 + k] = std::min(std::max(y[3 + k], task.lower[7 + k]), task.upper[7 + k]);
    PoseSolution out;
    out.x.fill(std::numeric_limits<double>::quiet_NaN());
    double sum = 0.0;
    for (const double value : y) sum += value;
    if (!std::isfinite(sum) || !within_reach(problem, y, st)) return out;
    std::vector<int> free = {0, 1, 2};
    for (int k = 0; k < 2; ++k)
        if (task.upper[7 + k] > task.lower[7 + k]) free.push_back(3 + k);

    Constraints near, other;
    collect(problem.robot, problem.cells, task, st, near);
    double value = cost(task, st), penalty = 1.0, closest = kInfinity;
    ActiveRows active;
    int since = 0;
    std::array<double, kMemory> values, worsts{};  // of the last iterations
    values.fill(-kInfinity);
    while (out.iterations < kIterations) {
        ++out.iterations;
        GradientY g;
        HessianY h;
        lagrangian(problem.robot, task, st, active, g, h);
        const Step step = quadratic_step(st, g, h, near, free);
        active = active_rows(near, step.multipliers, free.size() + 1);
        const double size = largest(step.by), worst = std::max(0.0, -near.least);
        if (size < kShortStep && worst <= kTolerance) break;
        ++since;
        if (worst <= kTolerance || worst < kFall * closest) closest = worst, since = 0;
        if (since > kPatience || !std::isfinite(size)) break;
        double multipliers = 0.0;
        for (const double one : step.multipliers) multipliers += one;
        penalty = std::max(penalty, 1.5 * multipliers);
        double shorten = 1.0, slope = 0.0;
        for (int k = 0; k < kUnknowns; ++k) {
            if (std::abs(step.by[k]) > kLongest[k]) shorten = std::min(shorten, kLongest[k] / std::abs(step.by[k]));
            slope += g[k] * step.by[k];
        }
        if (!step.relaxed) slope -= penalty * worst;
        const int now = out.iterations % kMemory;
        values[now] = value, worsts[now] = worst;
        double reference = -kInfinity;
        for (int k = 0; k < kMemory; ++k) reference = std::max(reference, values[k] + penalty * worsts[k]);
        bool accepted = false;
        double cost_there = 0.0;
        for (int k = 0; k < kHalvings && !accepted; ++k) {
            if (place(problem.robot, problem.path, moved_by(y, shorten, step.by), trial)) {
                collect(problem.robot, problem.cells, task, trial, other);
                cost_there = cost(task, trial);
                const double merit = cost_there + penalty * std::max(0.0, -other.least);
                accepted = merit <= reference + 1e-4 * shorten * std::min(slope, 0.0) + 1e-14;
            }
            if (!accepted) shorten *= 0.5;
        }
        if (!accepted) break;
        y = moved_by(y, shorten, step.by);
        std::swap(st, trial);
        std::swap(near, other);
        value = cost_there;
        if (size < kLastStep && shorten == 1.0 && -near.least <= kTolerance) break;
    }
    out.x = st.variables();
    out.cost = value;
    out.violation = std::max(0.0, -near.least);
    return out;
}

}  // namespace stairwright::poses
