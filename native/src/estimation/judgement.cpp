// How far the estimate is from the truth, and whether its own uncertainty says so.
#include "stairwright/estimation/estimator.hpp"

#include <algorithm>
#include <cmath>

#include "spatial.hpp"

namespace stairwright::estimation {

Estimator::Judgement Estimator::judge(const control::RobotState& truth) const {
    const auto [w, x, y, z] = attitude_;
    const auto d = product(truth.quaternion, {w, -x, -y, -z});
    const double sign = d[0] < 0.0 ? -2.0 : 2.0;
    Judgement out;
    out.error = {sign * d[1], sign * d[2], sign * d[3], truth.velocity[0] - velocity_[0], truth.velocity[1] - velocity_[1],
                 truth.velocity[2] - velocity_[2], truth.position[0] - place_.x, truth.position[2] - place_.z};
    constexpr std::size_t parts[] = {kAttitude, kAttitude + 1, kVelocity, kVelocity + 2, kPlace, kPlace + 1};
    const double error[] = {out.error[0], out.error[1], out.error[3], out.error[5], out.error[6], out.error[7]};
    // Cholesky factor of the marginal covariance, and its solution with the error.
    double L[6][6] = {}, y6[6];
    out.scale = scale_, out.offset = offset_;
    out.nees = 0.0;
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j <= i; ++j) {
            double sum = covariance_(parts[i], parts[j]);
            for (int k = 0; k < j; ++k) sum -= L[i][k] * L[j][k];
            L[i][j] = i == j ? std::sqrt(std::max(sum, 1e-16)) : sum / L[j][j];
        }
        double sum = error[i];
        for (int k = 0; k < i; ++k) sum -= L[i][k] * y6[k];
        y6[i] = sum / L[i][i];
        out.nees += y6[i] * y6[i];
    }
    return out;
}

}  // namespace stairwright::estimation
