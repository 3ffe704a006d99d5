#include "stairwright/rollout/sensor_model.hpp"

#include <bit>
#include <cmath>

namespace stairwright::rollout {

namespace {

constexpr std::size_t kNumbers = control::kPositions + control::kVelocities;
using Numbers = std::array<double, kNumbers>;

}  // namespace

const RobotState& SensorModel::perceive(const RobotState& truth, std::span<const double> noise) {
    const std::size_t size = history_.size();
    RobotState& latest = history_[seen_ % size];
    latest = truth;
    if (noise.size() == kNoiseWidth) {
        auto numbers = std::bit_cast<Numbers>(truth);
        for (std::size_t i = 0; i < kNumbers; ++i) numbers[i] += noise[i];
        latest = std::bit_cast<RobotState>(numbers);
        const auto [w, x, y, z] = truth.quaternion;
        const double a = noise[kNumbers], b = noise[kNumbers + 1], c = noise[kNumbers + 2];
        auto& q = latest.quaternion;
        q = {w - x * a - y * b - z * c, x + w * a + y * c - z * b, y + w * b + z * a - x * c, z + w * c + x * b - y * a};
        const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
        for (double& v : q) v /= length;
    }
    const Misbelief& wrong = misbelief_;
    latest.position[0] += wrong.offset;
    latest.position[0] += wrong.scale * (latest.position[0] - wrong.start);
    if (wrong.pitch != 0.0) {  // turned about the trunk's lateral axis
        const auto [w, x, y, z] = latest.quaternion;
        const double c = std::cos(0.5 * wrong.pitch), s = std::sin(0.5 * wrong.pitch);
        latest.quaternion = {w * c - y * s, x * c - z * s, y * c + w * s, z * c + x * s};
    }
    const std::size_t oldest = seen_ + 1 >= size ? seen_ + 1 - size : 0;
    ++seen_;
    return history_[oldest % size];
}

}  // namespace stairwright::rollout
