#include "stairwright/estimation/error_state.hpp"

namespace stairwright::estimation {

namespace {

double dot(const Error& a, const Error& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < kErrors; ++i) sum += a[i] * b[i];
    return sum;
}

}  // namespace

Covariance::Covariance(const Error& deviations) {
    for (std::size_t i = 0; i < kErrors; ++i) P_[i][i] = deviations[i] * deviations[i];
}

Error Covariance::times(const Error& h) const {
    Error out{};
    for (std::size_t j = 0; j < kErrors; ++j) {
        if (h[j] == 0.0) continue;
        for (std::size_t i = 0; i < kErrors; ++i) out[i] += P_[j][i] * h[j];  // P is symmetric
    }
    return out;
}

void Covariance::update(const Error& h, double residual, double noise, Error& error) {
    update(h, times(h), residual, noise, error);
}

void Covariance::update(const Error& h, const Error& ph, double residual, double noise, Error& error) {
    const double spread = dot(h, ph) + noise;
    Error gain, rest;
    const double share = noise / spread;  // P h - K (h P h)
    for (std::size_t i = 0; i < kErrors; ++i) gain[i] = ph[i] / spread, rest[i] = ph[i] * share;
    const double miss = residual - dot(h, error);
    // (I - K h) P, then (I - K h)' from the right, and K noise K'.
    for (std::size_t i = 0; i < kErrors; ++i) {
        const double k = gain[i], b = noise * gain[i] - rest[i];
        error[i] += gain[i] * miss;
        for (std::size_t j = 0; j <= i; ++j) P_[i][j] = P_[i][j] - k * ph[j] + b * gain[j];
        for (std::size_t j = 0; j < i; ++j) P_[j][i] = P_[i][j];  // symmetric, whatever rounding says
    }
}

void Covariance::propagate(const std::array<std::array<double, 3>, 3>& R, const std::array<double, 3>& f, double dt) {
    const double cross[3][3] = {{0.0, -f[2], f[1]}, {f[2], 0.0, -f[0]}, {-f[1], f[0], 0.0}};
    // F P, row by row from the integrals down, so that each takes the old rows of what it integrates.
    const auto rows = [&](auto&& at) {
        for (std::size_t j = 0; j < kErrors; ++j) {
            at(kPlace, j) += dt * at(kVelocity, j);
            at(kPlace + 1, j) += dt * at(kVelocity + 2, j);
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t k = 0; k < 3; ++k)
                    at(kVelocity + i, j) -= dt * (cross[i][k] * at(kAttitude + k, j) + R[i][k] * at(kForceBias + k, j));
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t k = 0; k < 3; ++k) at(kAttitude + i, j) -= dt * R[i][k] * at(kGyroBias + k, j);
        }
    };
    rows([&](std::size_t i, std::size_t j) -> double& { return P_[i][j]; });
    rows([&](std::size_t i, std::size_t j) -> double& { return P_[j][i]; });
}

void Covariance::add_noise(std::size_t i, Vec2 along, double variance) {
    P_[i][i] += along.x * along.x * variance, P_[i + 1][i + 1] += along.z * along.z * variance;
    P_[i][i + 1] = P_[i + 1][i] += along.x * along.z * variance;
}

}  // namespace stairwright::estimation
