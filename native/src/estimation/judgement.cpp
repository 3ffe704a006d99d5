// How far the estimate is from the truth, and whether its own uncertainty says so.
#include "stairwright/estimation/estimator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "spatial.hpp"

namespace stairwright::estimation {

namespace {

constexpr std::size_t kJudgedParts = 6;
using Judged = std::array<double, kJudgedParts>;

// The square of an error, normalised by its covariance: of the filter's, and of independent errors besides. By the
// Cholesky factor of both, and its solution with the error.
double normalised(const Judged& error, const Covariance& filter, const std::array<std::size_t, kJudgedParts>& parts, const Judged& besides) {
    double L[kJudgedParts][kJudgedParts] = {}, y[kJudgedParts], out = 0.0;
    for (std::size_t i = 0; i < kJudgedParts; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = filter(parts[i], parts[j]) + (i == j ? besides[i] * besides[i] : 0.0);
            for (std::size_t k = 0; k < j; ++k) sum -= L[i][k] * L[j][k];
            L[i][j] = i == j ? std::sqrt(std::max(sum, 1e-16)) : sum / L[j][j];
        }
        double sum = error[i];
        for (std::size_t k = 0; k < i; ++k) sum -= L[i][k] * y[k];
        y[i] = sum / L[i][i];
        out += y[i] * y[i];
    }
    return out;
}

}  // namespace

Estimator::Judgement Estimator::judge(const control::RobotState& truth) const {
    const auto [w, x, y, z] = attitude_;
    const auto d = product(truth.quaternion, {w, -x, -y, -z});
    const double sign = d[0] < 0.0 ? -2.0 : 2.0;
    Judgement out;
    out.error = {sign * d[1], sign * d[2], sign * d[3], truth.velocity[0] - velocity_[0], truth.velocity[1] - velocity_[1],
                 truth.velocity[2] - velocity_[2], truth.position[0] - place_.x, truth.position[2] - place_.z};
    constexpr std::array<std::size_t, kJudgedParts> parts = {kAttitude, kAttitude + 1, kVelocity, kVelocity + 2, kPlace, kPlace + 1};
    const Judged error = {out.error[0], out.error[1], out.error[3], out.error[5], out.error[6], out.error[7]};
    out.nees = normalised(error, covariance_, parts, {});
    // Wheels tell place and roll on the map; how that lies in the world they cannot: along, and sideways level or not.
    // Noise has the place of one face against another, each of which is off by itself.
    out.nees_in_world = normalised(error, covariance_, parts, {noise_.cross_slope, 0.0, 0.0, 0.0, noise_.face_place / std::numbers::sqrt2, 0.0});
    out.scale = scale_, out.offset = offset_;
    return out;
}

}  // namespace stairwright::estimation
