// The body lattice, and the windows of it that pairs of wheel samples look at.
#pragma once

#include <cstddef>

namespace stairwright::lattice {

// x = i * step, z = j * step, pitch = (t - pitches / 2) * turn.
//
// A window's volume is stored flat with a rim of two lattice steps on every side, rows `row` long: shifting by any few
// steps, dilating and comparing volumes are single loops over a range of it.
struct Lattice {
    double step = 0.0;  // m
    double turn = 0.0;  // rad
    int pitches = 0;    // of the tables
    int nt = 0, nz = 0, nx = 0;  // pitches, rows and columns of a window
    int row = 0;        // columns stored per row: the window, its rim, and room for shifts

    int layer() const { return row * (nz + 4); }
    int volume() const { return layer() * (nt + 4); }
    // Position of column 0 of row (t, z) of a window.
    int row_start(int t, int z) const { return ((t + 2) * (nz + 4) + z + 2) * row + 2; }
    // Flat distance of poses that are so many lattice steps apart.
    int shift(int t, int z, int x) const { return (t * (nz + 4) + z) * row + x; }
    // Flat distance that two lattice steps along every axis span.
    int reach() const { return 2 * (layer() + row + 1); }
};

// Lattice steps of a pose within a window.
struct WindowPose {
    int t = 0, z = 0, x = 0;
};

// Window poses from `first` to `last`, excluded.
struct WindowRange {
    WindowPose first, last;
};

}  // namespace stairwright::lattice
