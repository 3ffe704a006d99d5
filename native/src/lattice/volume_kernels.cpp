#include "stairwright/lattice/volume_kernels.hpp"

#include <algorithm>

#include "stairwright/simd.hpp"

namespace stairwright::lattice {

namespace {

constexpr float kTwoSteps = 2.6F;  // cost of two lattice steps in one move, in steps

STAIRWRIGHT_VECTOR_CLONES
void widest(const std::uint8_t* __restrict src, std::uint8_t* __restrict dst, int n) {
    for (int k = 0; k < n; ++k) dst[k] = src[k] > dst[k] ? src[k] : dst[k];
}

STAIRWRIGHT_VECTOR_CLONES
void cheapest(const float* __restrict src, float* __restrict dst, int n, float cost) {
    for (int k = 0; k < n; ++k) {
        const float v = src[k] + cost;
        dst[k] = v < dst[k] ? v : dst[k];
    }
}

// b = largest of a within two strides `o`.
STAIRWRIGHT_VECTOR_CLONES
void largest_near(const std::uint8_t* __restrict a, std::uint8_t* __restrict b, int low, int high, int o) {
    for (int k = low; k < high; ++k) {
        const std::uint8_t u = std::max(a[k - 2 * o], a[k - o]), v = std::max(a[k + o], a[k + 2 * o]);
        b[k] = std::max(std::max(u, v), a[k]);
    }
}

// b = least of a within two strides `o` plus what the way costs.
STAIRWRIGHT_VECTOR_CLONES
void least_near(const float* __restrict a, float* __restrict b, int low, int high, int o, float near, float far) {
    for (int k = low; k < high; ++k) {
        const float u = std::min(a[k - o], a[k + o]) + near, v = std::min(a[k - 2 * o], a[k + 2 * o]) + far;
        b[k] = std::min(a[k], std::min(u, v));
    }
}

FlatRange shifted_range(FlatRange range, int by, int size) {
    return {std::max(0, range.low - by), std::min(size, range.high - by)};
}

FlatRange inner(FlatRange range, int o, int size) {
    return {std::max(range.low, 2 * o), std::min(range.high, size - 2 * o)};
}

}  // namespace

void gather_widest(const std::uint8_t* volume, FlatRange range, int by, std::uint8_t* out, int size) {
    const auto [a, b] = shifted_range(range, by, size);
    if (a < b) widest(volume + a + by, out + a, b - a);
}

void gather_cheapest(const float* volume, FlatRange range, int by, float cost, float* out, int size) {
    const auto [a, b] = shifted_range(range, by, size);
    if (a < b) cheapest(volume + a + by, out + a, b - a, cost);
}

void dilate(std::uint8_t* a, std::uint8_t* b, FlatRange range, const Lattice& lattice) {
    for (const int o : {1, lattice.row, lattice.layer()}) {
        const FlatRange r = inner(range, o, lattice.volume());
        largest_near(a, b, r.low, r.high, o);
        std::swap(a, b);
    }
}

void convolve(float* a, float* b, FlatRange range, const Lattice& lattice, float one) {
    for (const int o : {1, lattice.row, lattice.layer()}) {
        const FlatRange r = inner(range, o, lattice.volume());
        least_near(a, b, r.low, r.high, o, one, one * kTwoSteps);
        std::swap(a, b);
    }
}

}  // namespace stairwright::lattice
