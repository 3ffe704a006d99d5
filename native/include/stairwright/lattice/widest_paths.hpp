// First pass of the search: the widest (bottleneck) path to every pose, and so the verdict whether there is one.
//
// A move takes one or both wheels to the next sample while the body shifts by up to two lattice steps in each
// direction. The width of a pose is the least quality (CoM margin, at the reserved friction where that is possible; for
// weak robots also what motors have to spare) on the best path to it: one byte a pose, 0 where there is none.
#pragma once

#include <span>

#include "stairwright/lattice/memory.hpp"
#include "stairwright/lattice/problem.hpp"
#include "stairwright/lattice/torque_limits.hpp"
#include "stairwright/lattice/volume_kernels.hpp"

namespace stairwright::lattice {

// What has happened to cells: a sweep leaves out those to which nothing new leads.
struct SweepHistory {
    explicit SweepHistory(std::size_t cells) : grown(cells, 0), seen(cells, -1) {}

    int visits = 0;                   // how often any cell was looked at
    std::vector<std::int32_t> grown;  // by cell: the visit at which its values last changed
    std::vector<std::int32_t> seen;   // by cell: the visit at which paths into it were last looked for, -1: never
};

class WidestPaths {
public:
    WidestPaths(const Lattice& lattice, std::size_t cells);

    // Also ask that motors hold every pose, and how easily; before the first sweep.
    void limit_torques(TorqueLimits limits) { torques_ = std::move(limits); }

    // One sweep over all cells; true if any changed. Ways begin in cells that `entry` marks, in poses of `begin`;
    // `moves` of kMoves are allowed.
    bool sweep(const Problem& problem, std::span<const Cell> cells, std::span<const ComIntervals> com,
               std::span<const std::uint8_t> entry, const WindowRange& begin, int moves);

    // Which cells have poses at least `level` wide and lead to `goal` through such cells.
    std::vector<std::uint8_t> leading_to(std::span<const Cell> cells, int level, std::size_t goal, int moves) const;

    bool reached(std::size_t cell) const { return first[cell] < last[cell]; }
    FlatRange range(std::size_t cell) const { return {first[cell], last[cell]}; }
    std::uint8_t* width(std::size_t cell) { return widths_.data() + static_cast<std::size_t>(slot[cell]) * size_; }
    const std::uint8_t* width(std::size_t cell) const { return widths_.data() + static_cast<std::size_t>(slot[cell]) * size_; }
    std::size_t size() const { return slot.size(); }
    std::size_t volume() const { return size_; }

    std::vector<std::int32_t> slot;         // by cell: which of the stored volumes is its, -1: none
    std::vector<std::int32_t> first, last;  // by cell: range of positions that are reached
    std::vector<std::uint8_t> best;         // by cell: largest width
    SweepHistory history;

private:
    // Poses of a cell to which a path leads that is wider than before.
    struct Wider;
    int collect(const Problem& problem, const Cell& cell, FlatRange range, const std::uint8_t* result,
                const std::uint8_t* width, Wider& wider) const;
    bool widen(const Problem& problem, const Cell& cell, const ComIntervals& com, std::size_t number, FlatRange range,
               const std::uint8_t* result, Wider& wider);
    std::uint8_t* enter(std::size_t cell);

    std::size_t size_ = 0, used_ = 0;
    Reused<std::uint8_t> widths_;
    std::optional<TorqueLimits> torques_;
};

}  // namespace stairwright::lattice
