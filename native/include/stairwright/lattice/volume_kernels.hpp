// Operations of the sweeps on ranges of flat volumes, as single loops that compilers vectorise.
#pragma once

#include <cstdint>

#include "stairwright/lattice/lattice.hpp"

namespace stairwright::lattice {

// Positions [low, high) of a volume.
struct FlatRange {
    int low = 0, high = 0;
    bool empty() const { return low >= high; }
};

// out = max(out, volume shifted by `by`) for what lies in `range` of `volume`; `out` has `size` positions.
void gather_widest(const std::uint8_t* volume, FlatRange range, int by, std::uint8_t* out, int size);

// Largest value within two lattice steps along each axis, in `range`. The result is in `b`, `a` is spent; both are zero
// outside what `a` holds, as far as `range` and a `reach` beyond. Right inside the window; the rim holds scratch.
void dilate(std::uint8_t* a, std::uint8_t* b, FlatRange range, const Lattice& lattice);

// out = min(out, volume shifted by `by` + cost), as above; volume[k] is position k.
void gather_cheapest(const float* volume, FlatRange range, int by, float cost, float* out, int size);

// Min-plus convolution with the cost of moving the body, `one` a lattice step, as in `dilate`.
void convolve(float* a, float* b, FlatRange range, const Lattice& lattice, float one);

}  // namespace stairwright::lattice
