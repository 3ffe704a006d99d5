#include <algorithm>
#include <cmath>

#include "stairwright/control/balance_qp.hpp"

namespace stairwright::control {

namespace {

constexpr int kIterations = 40;
constexpr double kTolerance = 1e-9;  // of stationarity and complementarity, relative to the gradient
constexpr int kRows = 16;

using Rows = std::array<double, kRows>;  // per wheel: forward and backward friction, pushing, saturation

// d - C x
void slacks(const Forces& x, const std::array<double, 4>& mu, double limit, Rows& out) {
    for (int w = 0; w < 4; ++w) {
        const double t = x[2 * w], n = x[2 * w + 1];
        out[4 * w] = mu[w] * n - t;
        out[4 * w + 1] = mu[w] * n + t;
        out[4 * w + 2] = n;
        out[4 * w + 3] = limit - n;
    }
}

struct WheelEntries {
    double tangential, normal;
};

// Entries of C' z of one wheel.
WheelEntries transposed(const Rows& z, double mu, int w) {
    const double a = z[4 * w], b = z[4 * w + 1], c = z[4 * w + 2], d = z[4 * w + 3];
    return {a - b, d - c - mu * (a + b)};
}

// Factor of H + C' diag(z / s) C; C couples only a wheel's two forces.
void factor_newton(const BalanceQp& qp, const Rows& s, const Rows& z, Matrix8& K) {
    for (int i = 0; i < 8; ++i)
        for (int j = 0; j <= i; ++j) K[i][j] = qp.H[i][j];
    for (int w = 0; w < 4; ++w) {
        const double mu = qp.friction[w];
        const double a = z[4 * w] / s[4 * w], b = z[4 * w + 1] / s[4 * w + 1];
        const double c = z[4 * w + 2] / s[4 * w + 2], d = z[4 * w + 3] / s[4 * w + 3];
        K[2 * w][2 * w] += a + b;
        K[2 * w + 1][2 * w] += mu * (b - a);
        K[2 * w + 1][2 * w + 1] += mu * mu * (a + b) + c + d;
    }
    factor(K, 8);
}

}  // namespace

void factor(Matrix8& K, int n) {
    for (int i = 0; i < n; ++i)
        for (int j = 0; j <= i; ++j) {
            double v = K[i][j];
            for (int k = 0; k < j; ++k) v -= K[i][k] * K[j][k];
            K[i][j] = i == j ? std::sqrt(std::max(v, 1e-300)) : v / K[j][j];
        }
}

void solve_factored(const Matrix8& K, std::array<double, 8>& b, int n) {
    for (int i = 0; i < n; ++i) {
        double v = b[i];
        for (int k = 0; k < i; ++k) v -= K[i][k] * b[k];
        b[i] = v / K[i][i];
    }
    for (int i = n - 1; i >= 0; --i) {
        double v = b[i];
        for (int k = i + 1; k < n; ++k) v -= K[k][i] * b[k];
        b[i] = v / K[i][i];
    }
}

int interior_point(const BalanceQp& qp, Forces& x) {
    const auto& mu = qp.friction;
    Rows s, z, ds{}, dz{}, drive;
    Matrix8 K;
    std::array<double, 8> step, residual;
    double scale = 1.0;
    for (const double g : qp.g) scale = std::max(scale, std::abs(g));
    for (int w = 0; w < 4; ++w) x[2 * w] = 0.0, x[2 * w + 1] = 0.25 * qp.load_limit;
    slacks(x, mu, qp.load_limit, s);
    z.fill(0.1 * scale);
    for (int iteration = 0; iteration < kIterations; ++iteration) {
        double gap = 0.0, worst = 0.0;
        for (int i = 0; i < kRows; ++i) gap += s[i] * z[i];
        gap /= kRows;
        for (int i = 0; i < 8; ++i) {
            double r = qp.g[i];
            for (int j = 0; j < 8; ++j) r += qp.H[i][j] * x[j];
            residual[i] = r;
        }
        for (int w = 0; w < 4; ++w) {
            const WheelEntries e = transposed(z, mu[w], w);
            residual[2 * w] += e.tangential;
            residual[2 * w + 1] += e.normal;
        }
        for (const double r : residual) worst = std::max(worst, std::abs(r));
        if (worst < kTolerance * scale && gap < kTolerance * scale) return iteration;
        factor_newton(qp, s, z, K);
        double aim = 0.0, step_s = 1.0, step_z = 1.0;
        for (const bool corrector : {false, true}) {
            // H dx + C' dz = -residual,  ds = -C dx,  s dz + z ds = aim - s z (- ds dz of the predictor)
            for (int i = 0; i < kRows; ++i) {
                double c = aim - s[i] * z[i];
                if (corrector) c -= ds[i] * dz[i];
                drive[i] = c / s[i];
            }
            for (int w = 0; w < 4; ++w) {
                const WheelEntries e = transposed(drive, mu[w], w);
                step[2 * w] = -residual[2 * w] - e.tangential;
                step[2 * w + 1] = -residual[2 * w + 1] - e.normal;
            }
            solve_factored(K, step, 8);
            slacks(step, mu, 0.0, ds);
            step_s = step_z = 1.0;
            for (int i = 0; i < kRows; ++i) {
                dz[i] = drive[i] - z[i] / s[i] * ds[i];
                if (ds[i] < 0.0) step_s = std::min(step_s, -s[i] / ds[i]);
                if (dz[i] < 0.0) step_z = std::min(step_z, -z[i] / dz[i]);
            }
            if (!corrector) {
                double reached = 0.0;
                for (int i = 0; i < kRows; ++i) reached += (s[i] + step_s * ds[i]) * (z[i] + step_z * dz[i]);
                const double share = reached / kRows / gap;
                aim = gap * (share * share * share);
            }
        }
        const double length = 0.995 * std::min(step_s, step_z);
        for (int i = 0; i < 8; ++i) x[i] += length * step[i];
        for (int i = 0; i < kRows; ++i) z[i] += length * dz[i];
        slacks(x, mu, qp.load_limit, s);
        for (int i = 0; i < kRows; ++i) s[i] = std::max(s[i], 1e-10), z[i] = std::max(z[i], 1e-10);
    }
    return kIterations;
}

}  // namespace stairwright::control
