// What the sweeps over the lattice read: tables of legs and trunk, pairs of wheel samples, the robot.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "stairwright/lattice/bitset.hpp"
#include "stairwright/lattice/lattice.hpp"
#include "stairwright/posture.hpp"

namespace stairwright::lattice {

inline constexpr float kInfeasible = 1e9F;  // cost

// Moves of front and rear wheels by samples; the first three roll forward.
struct WheelMove {
    int front = 0, rear = 0;
};
inline constexpr std::array<WheelMove, 8> kMoves = {
    {{1, 1}, {1, 0}, {0, 1}, {1, -1}, {-1, 1}, {-1, 0}, {0, -1}, {-1, -1}}};
inline constexpr int kForwardMoves = 3;

// A leg on the body lattice, by wheel sample, pitch, row and column; views of tables that somebody else keeps.
struct LegTable {
    int samples = 0, pitches = 0, rows = 0, columns = 0;  // `rows` is also the size of the moments' grid
    const float* cost = nullptr;             // (samples, pitches, rows, columns), kInfeasible where impossible
    const Bits* possible = nullptr;          // (samples, pitches, rows)
    const float* moment = nullptr;           // (2, 2, rows, rows) about the wheel's centre, by parity [kg m]
    const float* carried = nullptr;          // (samples) what to add about the world's origin [kg m]
    const std::int32_t *x0 = nullptr, *z0 = nullptr;  // (samples, pitches) lattice index of column and row 0
    const std::int32_t *u = nullptr, *v = nullptr;    // (samples, pitches) column and row of the hip grid there

    std::size_t at(int sample, int pitch) const { return static_cast<std::size_t>(sample) * pitches + pitch; }
    const Bits* bitsets(int sample, int pitch) const { return possible + at(sample, pitch) * rows; }
    const float* costs(int sample, int pitch) const { return cost + at(sample, pitch) * rows * columns; }
    // Moments of a sample at a pitch, less what it carried: that of row 0 and column 0; rows are `rows` long.
    const float* moments(int sample, int pitch) const {
        const std::size_t k = at(sample, pitch), size = static_cast<std::size_t>(rows) * rows;
        return moment + (2 * (v[k] % 2) + u[k] % 2) * size + static_cast<std::size_t>(v[k] / 2) * rows + u[k] / 2;
    }
};

// The trunk on the body lattice.
struct TrunkTable {
    int pitches = 0, rows = 0, columns = 0, stored = 0;  // `stored` columns a row of costs
    int x0 = 0, z0 = 0;               // lattice index of the first column and row
    const float* cost = nullptr;      // (pitches, rows, stored)
    const Bits* possible = nullptr;   // (pitches, rows, columns) of the columns from there on
};

struct Interval {
    double lower = 0.0, upper = 0.0;
    bool empty() const { return lower > upper; }
    double middle() const { return 0.5 * (lower + upper); }
};

// CoM intervals of a pair of wheel samples [m].
struct ComIntervals {
    Interval friction;  // at the stated friction
    Interval reserve;   // at the reserved one
    Interval lag;       // with lagging wheels
};

// A pair of wheel samples with its window of body poses.
struct Cell {
    int front = 0, rear = 0;      // samples
    int t0 = 0, z0 = 0, x0 = 0;   // lattice index of the window's corner
    double slope = 0.0;           // of the line from the rear to the front wheel, upward positive [rad]
    std::array<int, kMoves.size()> origin{};  // cell that a move into this one comes from, -1: none
};

struct Problem {
    RobotModel robot;
    Lattice lattice;
    std::vector<double> s;       // arc lengths of the samples [m]
    std::vector<Vec2> centres;   // of the wheels there [m]
    std::array<LegTable, 2> legs;
    TrunkTable trunk;
    std::vector<double> cosines, sines;  // of the lattice's pitches
    double least_leg_distance = 0.0;  // [m]
    double least_com_margin = 0.0;    // [m]
};

// Where pitch `t` of a cell finds its values: rows and columns of the tables that the window's row and column 0 read,
// and the rows [low, high) of the window that all tables have.
struct TableWindow {
    int front_row = 0, rear_row = 0, trunk_row = 0;
    int front_column = 0, rear_column = 0, trunk_column = 0;
    int low = 0, high = 0;
};
TableWindow table_window(const Problem& problem, const Cell& cell, int t);

// Flat shift from a pose's place in `cell` to its place in `other`.
inline int offset(const Lattice& lattice, const Cell& cell, const Cell& other) {
    return lattice.shift(cell.t0 - other.t0, cell.z0 - other.z0, cell.x0 - other.x0);
}

// x of the robot's CoM for lattice poses, from the moments of its parts, in single precision.
struct ComTerms {
    float per_mass = 0.0F;    // 1 / the robot's mass
    float trunk_share = 0.0F; // the trunk's part of it
    float carried = 0.0F;     // by the legs about the world's origin, per mass [m]

    ComTerms(const Problem& problem, const Cell& cell);
    // What the trunk's mass centre adds at a pitch [m].
    float trunk_offset(const Problem& problem, double cos, double sin) const;
};

}  // namespace stairwright::lattice
