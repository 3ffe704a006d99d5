#include "stairwright/poses/quadratic_program.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stairwright::poses {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kFeasible = 1e-11;  // violation that is none, relative to a row's size
constexpr int kIterations = 200;
constexpr int kSweeps = 30;

// J J' = H^-1 and the triangular R of the active rows.
struct Factors {
    int n = 0;
    int active = 0;  // rows
    QpMatrix j{}, r{};

    // J: the inverse of H's Cholesky factor, transposed; false if H has none.
    bool start(const QpMatrix& h) {
        QpMatrix l;
        if (!cholesky(h, n, 0.0, l)) return false;
        for (int c = 0; c < n; ++c) {  // column c of L^-1 is row c of J
            for (int i = 0; i < c; ++i) j[c][i] = 0.0;
            for (int i = c; i < n; ++i) {
                double total = i == c ? 1.0 : 0.0;
                for (int k = c; k < i; ++k) total -= l[i][k] * j[c][k];
                j[c][i] = total / l[i][i];
            }
        }
        return true;
    }

    // `d` = J' row; step `z` in x and `-u` in the multipliers as the constraint `row` is pushed.
    void directions(const QpVector& row, QpVector& d, QpVector& z, QpVector& u) const {
        for (int k = 0; k < n; ++k) {
            d[k] = 0.0;
            for (int i = 0; i < n; ++i) d[k] += j[i][k] * row[i];
        }
        for (int i = 0; i < n; ++i) {
            z[i] = 0.0;
            for (int k = active; k < n; ++k) z[i] += j[i][k] * d[k];
        }
        for (int k = active - 1; k >= 0; --k) {
            double total = d[k];
            for (int m = k + 1; m < active; ++m) total -= r[k][m] * u[m];
            u[k] = total / r[k][k];
        }
    }

    // Take a constraint in; `d` is J' times its row.
    void add(QpVector d) {
        for (int i = n - 1; i > active; --i) {
            const double h = std::hypot(d[i - 1], d[i]);
            if (h == 0.0) continue;
            const double c = d[i - 1] / h, s = d[i] / h;
            d[i - 1] = h, d[i] = 0.0;
            for (int k = 0; k < n; ++k) {
                const double a = j[k][i - 1], b = j[k][i];
                j[k][i - 1] = c * a + s * b, j[k][i] = c * b - s * a;
            }
        }
        for (int i = 0; i <= active; ++i) r[i][active] = d[i];
        ++active;
    }

    void drop(int which) {
        for (int k = which; k < active - 1; ++k)
            for (int i = 0; i < k + 2; ++i) r[i][k] = r[i][k + 1];
        for (int k = which; k < active - 1; ++k) {
            const double h = std::hypot(r[k][k], r[k + 1][k]);
            if (h == 0.0) continue;
            const double c = r[k][k] / h, s = r[k + 1][k] / h;
            for (int m = k; m < active - 1; ++m) {
                const double a = r[k][m], b = r[k + 1][m];
                r[k][m] = c * a + s * b, r[k + 1][m] = c * b - s * a;
            }
            for (int m = 0; m < n; ++m) {
                const double a = j[m][k], b = j[m][k + 1];
                j[m][k] = c * a + s * b, j[m][k + 1] = c * b - s * a;
            }
        }
        --active;
    }
};

}  // namespace

QpStatus QuadraticProgram::solve(QpVector& x, std::vector<double>& multipliers) const {
    const int m = static_cast<int>(rows.size());
    multipliers.assign(rows.size(), 0.0);
    Factors factors{n};
    if (!factors.start(hessian)) return QpStatus::kStalled;
    x = {};
    for (int k = 0; k < n; ++k) {
        double along = 0.0;
        for (int i = 0; i < n; ++i) along += factors.j[i][k] * gradient[i];
        for (int i = 0; i < n; ++i) x[i] -= factors.j[i][k] * along;
    }
    const auto slack_of = [&](int i) {
        double slack = -bounds[i];
        for (int k = 0; k < n; ++k) slack += rows[i][k] * x[k];
        return slack;
    };
    std::array<int, kMostVariables> active{};
    std::array<double, kMostVariables + 1> u{};  // their multipliers
    for (int iteration = 0; iteration < kIterations; ++iteration) {
        double worst = 0.0;
        int p = -1;
        for (int i = 0; i < m; ++i) {
            const double slack = slack_of(i);
            if (slack >= worst) continue;
            double size = std::abs(bounds[i]) + 1e-3;
            for (int k = 0; k < n; ++k) size += std::abs(rows[i][k] * x[k]);
            if (slack < -kFeasible * size) worst = slack, p = i;
        }
        if (p < 0) {
            for (int k = 0; k < factors.active; ++k) multipliers[active[k]] = u[k];
            return QpStatus::kSolved;
        }
        u[factors.active] = 0.0;
        while (true) {
            const int count = factors.active;
            QpVector d{}, z{}, r{};
            factors.directions(rows[p], d, z, r);
            double t1 = kInfinity;
            int leaving = -1;
            for (int k = 0; k < count; ++k)
                if (r[k] > 0.0 && u[k] / r[k] < t1) t1 = u[k] / r[k], leaving = k;
            double gain = 0.0, size = 0.0;
            for (int k = 0; k < n; ++k) gain += z[k] * rows[p][k];
            for (int k = 0; k < n; ++k) size += d[k] * d[k];
            const double t2 = gain > 1e-13 * size && count < n ? -slack_of(p) / gain : kInfinity;
            const double t = std::min(t1, t2);
            if (!(t < kInfinity)) return QpStatus::kInfeasible;
            for (int k = 0; k < count; ++k) u[k] -= t * r[k];
            u[count] += t;
            if (t2 < kInfinity)
                for (int k = 0; k < n; ++k) x[k] += t * z[k];
            if (t2 <= t1) {
                factors.add(d);
                active[count] = p;
                break;
            }
            factors.drop(leaving);
            for (int k = leaving; k < count - 1; ++k) active[k] = active[k + 1], u[k] = u[k + 1];
            u[count - 1] = u[count];
        }
    }
    return QpStatus::kStalled;
}

bool cholesky(const QpMatrix& h, int n, double least, QpMatrix& factor) {
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j <= i; ++j) {
            double total = h[i][j] - (i == j ? least : 0.0);
            for (int k = 0; k < j; ++k) total -= factor[i][k] * factor[j][k];
            if (i != j) {
                factor[i][j] = total / factor[j][j];
            } else {
                if (!(total > 0.0)) return false;
                factor[i][i] = std::sqrt(total);
            }
        }
    }
    return true;
}

// Eigenvalues by Jacobi's rotations.
void make_positive(QpMatrix& h, int n, double least) {
    QpMatrix factor;
    if (cholesky(h, n, least, factor)) return;
    QpMatrix a = h, v{};
    for (int i = 0; i < n; ++i) v[i][i] = 1.0;
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        double off = 0.0, total = 0.0;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) (i == j ? total : off) += a[i][j] * a[i][j];
        if (off <= 1e-30 * total) break;
        for (int p = 0; p < n; ++p) {
            for (int q = p + 1; q < n; ++q) {
                if (a[p][q] == 0.0) continue;
                const double theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
                const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
                for (int k = 0; k < n; ++k) {
                    const double x = a[k][p], y = a[k][q];
                    a[k][p] = c * x - s * y, a[k][q] = s * x + c * y;
                }
                for (int k = 0; k < n; ++k) {
                    const double x = a[p][k], y = a[q][k];
                    a[p][k] = c * x - s * y, a[q][k] = s * x + c * y;
                }
                for (int k = 0; k < n; ++k) {
                    const double x = v[k][p], y = v[k][q];
                    v[k][p] = c * x - s * y, v[k][q] = s * x + c * y;
                }
            }
        }
    }
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            h[i][j] = 0.0;
            for (int k = 0; k < n; ++k) h[i][j] += std::max(std::abs(a[k][k]), least) * v[i][k] * v[j][k];
        }
    }
}

}  // namespace stairwright::poses
