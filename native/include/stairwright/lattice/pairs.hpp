// Pairs of wheel samples: which there are, what CoM they hold, and the windows of the body lattice round them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "stairwright/lattice/problem.hpp"
#include "stairwright/wheel_contacts.hpp"

namespace stairwright::lattice {

// How a window lies round its pair.
struct WindowShape {
    Lattice lattice;
    int low = 0;  // first row, relative to the mean wheel height
};

struct SamplePair {
    int front = 0, rear = 0;
};

// Samples of front and rear wheels whose centres are `near` to `far` apart [m], in lexicographic order. The front wheel
// is at sample `front` or ahead of it, the rear wheel not ahead of `rear`: wheels that roll forward from one stand to
// another are nowhere else.
std::vector<SamplePair> sample_pairs(const std::vector<Vec2>& centres, double near, double far, int front, int rear);

// Pitches [first, last) of the lattice that any window of a sample looks at; by wheel pair, then sample.
struct PitchRange {
    int first = 0, last = 0;
};
std::array<std::vector<PitchRange>, 2> pitch_ranges(const std::vector<Vec2>& centres, const std::vector<SamplePair>& pairs,
                                                   const WindowShape& shape);

// Cells of the search: the pairs that can stand at all, with a window each.
struct CellTable {
    std::vector<Cell> cells;
    std::vector<ComIntervals> com;          // with lag: left empty; at the reserve: empty where it is 0
    std::vector<std::int32_t> number;       // (samples, samples) of cells by front and rear, -1 where there is none
};
struct CellProblem {
    const WheelPath& path;
    const std::vector<double>& s;      // arc lengths of the samples [m]
    const std::vector<Vec2>& centres;  // [m]
    double friction = 0.0, reserve = 0.0;
    double least_com_margin = 0.0;     // [m]
};
CellTable cell_table(const CellProblem& problem, const std::vector<SamplePair>& pairs, const WindowShape& shape);

// CoM interval of a cell with wheels that lag; the middle of the one at the stated friction where there is none.
Interval lag_interval(const WheelPath& path, WheelPlaces s, const Interval& stated, double friction, double lag);

// Rows of what the ground looks like within `reach` [m] of each wheel centre, seen from there, rounded to 1e-7 m:
// samples with equal rows are alike. Rows are `width` long.
struct Outlines {
    std::size_t width = 0;
    std::vector<std::int64_t> rows;
};
Outlines outlines(const std::vector<Vec2>& profile, const std::vector<Vec2>& centres, double reach);

}  // namespace stairwright::lattice
