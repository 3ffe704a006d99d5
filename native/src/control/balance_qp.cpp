#include "stairwright/control/balance_qp.hpp"

#include <algorithm>
#include <cmath>

namespace stairwright::control {

namespace {

constexpr int kGuesses = 6;      // active sets that are tried before the interior point
constexpr double kNear = 1e-9;   // of the load limit: this near a constraint counts as on it

// Active constraints of a wheel's force: an edge of the friction cone, and none, no or full load.
enum class Edge { none, forward, backward };
enum class Load { free, zero, full };
struct Active {
    Load load = Load::free;
    Edge edge = Edge::none;
    bool operator==(const Active&) const = default;
};
using ActiveSet = std::array<Active, 4>;

ActiveSet active_set(const BalanceQp& qp, const Forces& x, double near) {
    ActiveSet out;
    for (int w = 0; w < 4; ++w) {
        const double t = x[2 * w], n = x[2 * w + 1], mu = qp.friction[w];
        Active& active = out[w];
        if (n <= near) {
            active.load = Load::zero;
            continue;
        }
        if (t >= mu * n - near)
            active.edge = Edge::forward;
        else if (t <= near - mu * n)
            active.edge = Edge::backward;
        if (n >= qp.load_limit - near) active.load = Load::full;
    }
    return out;
}

// The exact minimiser with these constraints active; false if the numbers break down.
bool minimise_on(const BalanceQp& qp, const ActiveSet& set, Forces& x) {
    Matrix8 Z{};  // columns span the forces that the active constraints leave
    int m = 0;
    for (int w = 0; w < 4; ++w) {
        const int t = 2 * w, n = 2 * w + 1;
        const double mu = set[w].edge == Edge::forward ? qp.friction[w] : -qp.friction[w];
        x[t] = x[n] = 0.0;
        if (set[w].load == Load::zero) continue;
        if (set[w].load == Load::full) {
            x[n] = qp.load_limit;
            if (set[w].edge == Edge::none)
                Z[t][m++] = 1.0;
            else
                x[t] = mu * qp.load_limit;
        } else if (set[w].edge == Edge::none) {
            Z[t][m] = Z[n][m + 1] = 1.0;
            m += 2;
        } else {
            Z[t][m] = mu;
            Z[n][m++] = 1.0;
        }
    }
    if (m == 0) return true;
    std::array<double, 8> gradient, step;
    Matrix8 HZ, K;
    for (int i = 0; i < 8; ++i) {
        double r = qp.g[i];
        for (int j = 0; j < 8; ++j) r += qp.H[i][j] * x[j];
        gradient[i] = r;
        for (int a = 0; a < m; ++a) {
            double v = 0.0;
            for (int j = 0; j < 8; ++j) v += qp.H[i][j] * Z[j][a];
            HZ[i][a] = v;
        }
    }
    for (int a = 0; a < m; ++a) {
        double r = 0.0;
        for (int i = 0; i < 8; ++i) r -= Z[i][a] * gradient[i];
        step[a] = r;
        for (int b = 0; b <= a; ++b) {
            double v = 0.0;
            for (int i = 0; i < 8; ++i) v += Z[i][a] * HZ[i][b];
            K[a][b] = v;
        }
    }
    factor(K, m);
    solve_factored(K, step, m);
    for (int i = 0; i < 8; ++i) {
        for (int a = 0; a < m; ++a) x[i] += Z[i][a] * step[a];
        if (!std::isfinite(x[i])) return false;
    }
    return true;
}

// True if `x` is the optimum; else changes the set: a force beyond a constraint goes onto it, and a constraint
// whose multiplier has the wrong sign is left.
bool update(const BalanceQp& qp, ActiveSet& set, const Forces& x) {
    bool optimal = true;
    double scale = 1.0;
    for (const double g : qp.g) scale = std::max(scale, std::abs(g));
    const double slack = kNear * qp.load_limit, wrong = 1e-10 * scale;
    for (int w = 0; w < 4; ++w) {
        const double t = x[2 * w], n = x[2 * w + 1], mu = qp.friction[w];
        double gt = qp.g[2 * w], gn = qp.g[2 * w + 1];
        for (int j = 0; j < 8; ++j) {
            gt += qp.H[2 * w][j] * x[j];
            gn += qp.H[2 * w + 1][j] * x[j];
        }
        const Active old = set[w];
        Active next = old;
        if (old.load == Load::zero) {
            if (gn < mu * std::abs(gt) - wrong) {
                const bool inside = std::abs(gt) < std::abs(gn) * mu;
                next = {Load::free, inside ? Edge::none : gt > 0.0 ? Edge::backward : Edge::forward};
            }
        } else if (n < -slack) {
            next = {Load::zero, Edge::none};
        } else {
            const double multiplier = old.edge == Edge::forward ? -gt : gt;  // of the friction edge, if on one
            const bool on_edge = old.edge != Edge::none;
            if (on_edge && multiplier < -wrong)
                next.edge = Edge::none;
            else if (old.load == Load::full && (on_edge ? mu * multiplier - gn < -wrong : gn > wrong))
                next.load = Load::free;
            if (next.edge == Edge::none) {
                if (t > mu * n + slack)
                    next.edge = Edge::forward;
                else if (-t > mu * n + slack)
                    next.edge = Edge::backward;
            }
            if (n > qp.load_limit + slack) next.load = Load::full;
        }
        if (next != old) set[w] = next, optimal = false;
    }
    return optimal;
}

// Whether an optimum was found from this set on, then in `forces`.
bool active_set_method(const BalanceQp& qp, ActiveSet set, bool stop_at_breakdown, Forces& forces) {
    Forces found;
    for (int k = 0; k < kGuesses; ++k) {
        if (minimise_on(qp, set, found)) {
            if (!update(qp, set, found)) continue;
            forces = found;
            return true;
        }
        if (stop_at_breakdown) return false;
    }
    return false;
}

}  // namespace

int solve(const BalanceQp& qp, Forces& forces) {
    if (active_set_method(qp, active_set(qp, forces, kNear * qp.load_limit), false, forces)) return 0;
    const int iterations = interior_point(qp, forces);
    // Sharpen: solve exactly with the constraints active that the interior point has come close to.
    for (const double near : {1e-7, 1e-5})
        if (active_set_method(qp, active_set(qp, forces, near * qp.load_limit), true, forces)) break;
    return iterations;
}

}  // namespace stairwright::control
