// The error state of the estimator and its covariance.
//
// Attitude error is a small turn in the world frame, R = exp(e) R_hat (the error of the right-invariant filter of
// Hartley et al. 2020, in which noise of the attitude does not leak into what is not observable); all other
// errors are added: an error-state filter (Sola 2017, section 6).
#pragma once

#include <array>
#include <cstddef>

#include "stairwright/vec2.hpp"

namespace stairwright::estimation {

// First index of each part of the error state.
enum Part : std::size_t {
    kAttitude = 0,      // 3, world frame [rad]
    kVelocity = 3,      // 3, world frame [m/s]
    kPlace = 6,         // 2, trunk point x, z [m]
    kGyroBias = 8,      // 3, trunk frame [rad/s]
    kForceBias = 11,    // 3, trunk frame [m/s^2]
    kScale = 14,        // 1, share by which the wheels roll farther than their angle says
    kFrontOffset = 15,  // 2, what has to be added to the front wheels' place to be on the map [m]
    kRearOffset = 17,   // 2, the same for the rear wheels
    kErrors = 19,
};

using Error = std::array<double, kErrors>;
using Matrix = std::array<std::array<double, kErrors>, kErrors>;

class Covariance {
  public:
    // From the standard deviations of independent errors.
    explicit Covariance(const Error& deviations);

    double operator()(std::size_t i, std::size_t j) const { return P_[i][j]; }
    // P h for a row h of a measurement matrix.
    Error times(const Error& h) const;

    // Kalman update by one scalar measurement `h e = residual` of variance `noise`, with the Joseph form; adds
    // the correction to `error`, which holds that of the updates before since the state was last corrected.
    void update(const Error& h, double residual, double noise, Error& error);
    // The same where `ph`, P h, is known already.
    void update(const Error& h, const Error& ph, double residual, double noise, Error& error);

    // A step of time: attitude, velocity and place by the linearised strapdown equations. `R` is trunk to world,
    // `force` the specific force in the world frame.
    void propagate(const std::array<std::array<double, 3>, 3>& R, const std::array<double, 3>& force, double dt);

    void add_noise(std::size_t i, double variance) { P_[i][i] += variance; }
    // Of a pair of errors, i and i + 1, along one direction.
    void add_noise(std::size_t i, Vec2 along, double variance);

  private:
    Matrix P_{};
};

}  // namespace stairwright::estimation
