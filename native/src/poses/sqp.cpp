#include "stairwright/poses/sqp.hpp"

#include <algorithm>
#include <cmath>

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
constexpr double kLeastCurvature = 1e-3;
constexpr double kRelaxed = 1e4;  // cost of what linearised constraints lack where they contradict each other

using GradientY = std::array<double, kUnknowns>;
using HessianY = std::array<GradientY, kUnknowns>;

// Gradient by y from the gradient by u.
GradientY reduce(const PoseState& st, const GradientU& gu) {
    GradientY out;
    for (int k = 0; k < kUnknowns; ++k) {
        out[k] = gu[k < 3 ? k : 4 + k];
        for (int a = 0; a < 4; ++a) out[k] += gu[3 + a] * st.link_turns[a][k];
    }
    return out;
}

// Rows that held the last step back, and their multipliers.
struct ActiveRows {
    std::vector<Constraint> rows;
    std::vector<double> multipliers;
};

// Curvature of "the wheel is on the curve" with the multiplier that its leg's angles imply.
void add_wheel_curvature(const PoseModel& model, const PoseState& st, int leg, const GradientU& gu, HessianU& hessian) {
    const PosePoint& wheel = st.points[model.wheel[leg]];
    const int upper = 1 + 2 * leg;
    const Vec2 a = {wheel.arms[upper].z, -wheel.arms[upper].x}, b = {wheel.arms[upper + 1].z, -wheel.arms[upper + 1].x};
    const double det = cross(a, b), g1 = gu[2 + upper], g2 = gu[3 + upper];
    const Vec2 multiplier = {(g1 * b.z - g2 * a.z) / det, (a.x * g2 - b.x * g1) / det};
    for (const int angle : {0, upper, upper + 1}) hessian[2 + angle][2 + angle] += dot(multiplier, wheel.arms[angle]);
    hessian[7 + leg][7 + leg] -= st.curvature[leg] * (multiplier.z * st.tangent[leg].x - multiplier.x * st.tangent[leg].z);
}

// Gradient of the cost and Hessian of the Lagrangian by y.
void lagrangian(const PoseModel& model, const PoseTask& task, const PoseState& st, const ActiveRows& active, GradientY& g,
                HessianY& h) {
    GradientU gu{};
    HessianU hu{};
    for (int k = 0; k < 7; ++k) {
        const double w = 2.0 * task.weights[k];
        const double error = (k < 3 ? st.y[k] : st.q[k - 3]) - task.reference[k];
        gu[k] += w * error;
        hu[k][k] += w;
        if (k < 3) continue;
        // Joint = angle of its link minus angle of the link that it turns against.
        const int j = k == 3 || k == 5 ? 2 : k - 1;
        gu[j] -= w * error;
        hu[j][j] += w;
        hu[k][j] -= w;
        hu[j][k] -= w;
    }
    g = reduce(st, gu);
    for (std::size_t k = 0; k < active.rows.size(); ++k) {
        const GradientU row = gradient(st, active.rows[k]);
        for (int i = 0; i < kU; ++i) gu[i] -= active.multipliers[k] * row[i];
        add_curvature(st, active.rows[k], -active.multipliers[k], hu);
    }
    for (int leg = 0; leg < 2; ++leg) add_wheel_curvature(model, st, leg, gu, hu);
    // H = Z' Hu Z, where Z holds the turns of the link angles and ones elsewhere.
    std::array<GradientY, kU> half;
    for (int i = 0; i < kU; ++i) half[i] = reduce(st, hu[i]);
    for (int k = 0; k < kUnknowns; ++k) {
        for (int j = 0; j < kUnknowns; ++j) {
            h[k][j] = half[k < 3 ? k : 4 + k][j];
            for (int a = 0; a < 4; ++a) h[k][j] += st.link_turns[a][k] * half[3 + a][j];
        }
    }
}

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
bool within_reach(const PoseWorld& world, Unknowns& y, PoseState& st) {
    for (int round = 0; round < 20; ++round) {
        bool moved = false;
        const Turn pitch = Turn::by(y[2]);
        for (int k = 0; k < 2; ++k) {
            const LegModel& model = world.robot.robot.legs[k];
            const Vec2 off = Vec2{y[0], y[1]} + pitch * model.leg.hip - world.path.centre(y[3 + k]);
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
    return place(world.robot, world.path, y, st);
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

PoseSolution solve_pose(const PoseWorld& world, const PoseTask& task, const Unknowns& start) {
    PoseState st(world.robot), trial(world.robot);
    Unknowns y = start;
    for (int k = 0; k < 2; ++k) y[3 + k] = std::min(std::max(y[3 + k], task.lower[7 + k]), task.upper[7 + k]);
    PoseSolution out;
    out.x.fill(std::numeric_limits<double>::quiet_NaN());
    double sum = 0.0;
    for (const double value : y) sum += value;
    if (!std::isfinite(sum) || !within_reach(world, y, st)) return out;
    std::vector<int> free = {0, 1, 2};
    for (int k = 0; k < 2; ++k)
        if (task.upper[7 + k] > task.lower[7 + k]) free.push_back(3 + k);

    Constraints near, other;
    collect(world.robot, world.cells, task, st, near);
    double value = cost(task, st), penalty = 1.0, closest = kInfinity;
    ActiveRows active;
    int since = 0;
    std::array<double, kMemory> values, worsts{};  // of the last iterations
    values.fill(-kInfinity);
    while (out.iterations < kIterations) {
        ++out.iterations;
        GradientY g;
        HessianY h;
        lagrangian(world.robot, task, st, active, g, h);
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
            if (place(world.robot, world.path, moved_by(y, shorten, step.by), trial)) {
                collect(world.robot, world.cells, task, trial, other);
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
