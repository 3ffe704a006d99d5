#include "stairwright/lattice/torque_limits.hpp"

#include <algorithm>
#include <cmath>

#include "stairwright/simd.hpp"

namespace stairwright::lattice {

namespace {

// Shares of a motor's torque: a path may take no more than the first (smoothing keeps a little below), below the second
// less is no better.
constexpr double kFirm = 0.88, kLight = 0.7;
constexpr double kKept = 101.0;  // quality from here on: as much as a path may take
constexpr int kLevers = 6;       // numbers of `LegLevers`

STAIRWRIGHT_INLINE double least(double a, double b) { return a < b ? a : b; }
STAIRWRIGHT_INLINE double most(double a, double b) { return a > b ? a : b; }

// x of a link's mass centre from its upper joint, with the lower one at `line` from it; see `link_turn`.
STAIRWRIGHT_INLINE double turned_com(const Link& link, double line_x, double line_z) {
    const double cosine = (link.end.x * line_x + link.end.z * line_z) * link.per_square;
    const double sine = (line_x * link.end.z - line_z * link.end.x) * link.per_square;
    return cosine * link.com.x + sine * link.com.z;
}

// `LegLevers` of many poses whose trunk is at (x, z) from `from`, each number for all of them; the wheel is at `wheel`.
// As `knee_offset` and `leg_levers`, written so that it vectorises.
STAIRWRIGHT_VECTOR_CLONES
void set_levers(const Leg& leg, const Vec2 from, const Vec2 wheel, const float* __restrict x, const float* __restrict z,
                const float* __restrict cos, const float* __restrict sin, const int count, double* __restrict thigh_x,
                double* __restrict thigh_z, double* __restrict calf_x, double* __restrict calf_z, double* __restrict thigh_weight,
                double* __restrict calf_weight) {
    const double thigh = leg.thigh.length, calf = leg.calf.length, hip_x = leg.hip.x, hip_z = leg.hip.z, side = leg.knee;
    const double thigh_mass = leg.thigh.mass * kGravity, calf_mass = leg.calf.mass * kGravity, wheel_mass = leg.wheel.mass * kGravity;
    for (int k = 0; k < count; ++k) {
        const double c = cos[k], s = sin[k];
        const double hx = from.x + x[k] + (c * hip_x + s * hip_z), hz = from.z + z[k] + (-s * hip_x + c * hip_z);
        const double rx = wheel.x - hx, rz = wheel.z - hz;
        const double d = most(std::sqrt(rx * rx + rz * rz), 1e-9), ex = rx / d, ez = rz / d;
        const double a = least(most((thigh * thigh - calf * calf + d * d) / (2.0 * d), -thigh), thigh);
        const double h = std::sqrt(most(0.0, thigh * thigh - a * a));
        const double kx = hx + (a * ex - side * h * ez), kz = hz + (a * ez + side * h * ex);
        const double thigh_at = hx + turned_com(leg.thigh, kx - hx, kz - hz), calf_at = kx + turned_com(leg.calf, wheel.x - kx, wheel.z - kz);
        thigh_x[k] = rx;
        thigh_z[k] = rz;
        calf_x[k] = wheel.x - kx;
        calf_z[k] = wheel.z - kz;
        thigh_weight[k] = thigh_mass * (thigh_at - hx) + calf_mass * (calf_at - hx) + wheel_mass * rx;
        calf_weight[k] = calf_mass * (calf_at - kx) + wheel_mass * (wheel.x - kx);
    }
}

struct Torques {
    double thigh, calf, wheel;
};

// Raises taken[k] to the largest share of torques that the loads of one way ask of one leg.
STAIRWRIGHT_VECTOR_CLONES
void raise_shares(const double* __restrict force_x, const double* __restrict force_z, const double* __restrict moment,
                  const double* __restrict held, const double first, const double step, const Torques limits,
                  const float* __restrict com_x, const double* __restrict levers, const std::size_t stride, const int count,
                  double* __restrict taken) {
    constexpr double last = WheelLoads::kSamples - 1.0;
    for (int k = 0; k < count; ++k) {
        const double u = step > 0.0 ? std::min(std::max((com_x[k] - first) / step, 0.0), last) : 0.0;
        const int at = std::min(static_cast<int>(u), WheelLoads::kSamples - 2);
        const double share = u - at;
        const double fx = force_x[at] + share * (force_x[at + 1] - force_x[at]);
        const double fz = force_z[at] + share * (force_z[at + 1] - force_z[at]);
        const double m = moment[at] + share * (moment[at + 1] - moment[at]);
        const double thigh = levers[stride + k] * fx - levers[k] * fz + m + levers[4 * stride + k];
        const double calf = levers[3 * stride + k] * fx - levers[2 * stride + k] * fz + m + levers[5 * stride + k];
        const double most = std::max(std::max(std::abs(thigh) / limits.thigh, std::abs(calf) / limits.calf), std::abs(m) / limits.wheel);
        taken[k] = std::max(taken[k], held[at] * held[at + 1] > 0.0 ? most : 0.0);
    }
}

}  // namespace

void TorqueLimits::rate(const Problem& problem, const Cell& cell, std::size_t number, const ComIntervals& com,
                        const TrunkPoses& poses, const float* com_x, std::uint8_t* quality) {
    if (poses.count == 0) return;
    std::optional<WheelLoads>& loads = loads_[number];
    if (!loads) {
        const WheelPlaces s = {problem.s[cell.front], problem.s[cell.rear]};
        loads.emplace(path_, s, friction_, lag_, stairwright::Interval{com.friction.lower, com.friction.upper}, problem.robot.mass * kGravity);
    }
    const auto count = static_cast<std::size_t>(poses.count);
    taken_.assign(count, 0.0);
    levers_.resize(kLevers * count);
    const auto lever = [&](std::size_t n) { return levers_.data() + n * count; };
    const auto [low, high] = std::minmax_element(com_x, com_x + count);
    for (const int pair : {kFront, kRear}) {
        const Leg& leg = problem.robot.legs[pair].leg;
        const Torques limits = {leg.thigh_motor.torque, leg.calf_motor.torque, leg.wheel_motor.torque};
        set_levers(leg, problem.centres[cell.front], problem.centres[pair == kFront ? cell.front : cell.rear], poses.x, poses.z,
                   poses.cos, poses.sin, poses.count, lever(0), lever(1), lever(2), lever(3), lever(4), lever(5));
        for (int way = 0; way < loads->ways(); ++way) {
            const WheelLoads::Samples& samples = loads->samples(way, *low, *high);
            const auto of = [&](int n) { return samples.values[3 * pair + n].data(); };
            raise_shares(of(0), of(1), of(2), samples.held.data(), loads->first(), loads->step(), limits, com_x, levers_.data(), count,
                         poses.count, taken_.data());
        }
    }
    for (std::size_t k = 0; k < count; ++k) {
        const double taken = taken_[k];  // the largest share
        const double kept = kKept + (255.0 - kKept) * std::min(1.0, (kFirm - taken) / (kFirm - kLight));
        const double beyond = 1.0 + (kKept - 2.0) * (share_ - taken) / std::max(share_ - kFirm, 1e-9);
        quality[k] = taken > share_ ? 0 : static_cast<std::uint8_t>(taken <= kFirm ? kept : beyond);
    }
}

}  // namespace stairwright::lattice
