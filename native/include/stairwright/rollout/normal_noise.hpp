// Normal random numbers that are the same on every machine for the same seed.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace stairwright::rollout {

class NormalNoise {
  public:
    explicit NormalNoise(std::uint64_t seed) : bits_(seed) {}

    // Mean 0, variance 1 (Box and Muller; the library's own distribution differs between libraries).
    double operator()() {
        if (spare_) return spare_ = false, next_;
        const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform())), angle = 2.0 * std::numbers::pi * uniform();
        next_ = radius * std::sin(angle), spare_ = true;
        return radius * std::cos(angle);
    }

  private:
    double uniform() { return static_cast<double>(bits_() >> 11) * 0x1.0p-53; }  // [0, 1)

    std::mt19937_64 bits_;
    double next_ = 0.0;
    bool spare_ = false;
};

}  // namespace stairwright::rollout
