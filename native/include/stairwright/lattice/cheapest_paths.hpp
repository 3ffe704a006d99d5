// Second pass of the search: the cheapest path among poses whose widest path is wide enough.
#pragma once

#include <optional>
#include <span>

#include "stairwright/lattice/widest_paths.hpp"

namespace stairwright::lattice {

struct CostWeights {
    double com_margin = 0.0, pitch = 0.0;
    double height = 0.0;          // nominal, of the trunk above the wheels' mean [m]
    double wanted_margin = 0.0;   // CoM margin from which on more is no cheaper [m]
    double body_step = 0.0;       // cost of one lattice step of the body
};

// A lattice pose on a path: wheel samples and body lattice indices, pitch 0 being level.
struct PathPose {
    int front = 0, rear = 0, pitch = 0, z = 0, x = 0;
};

// Costs of the poses that are wide enough, of all cells one after the other.
class CheapestPaths {
public:
    // No costs yet, with room for poses at least `level` wide of the cells that `wanted` marks; `moves` of kMoves.
    CheapestPaths(const WidestPaths& widest, int level, std::span<const std::uint8_t> wanted, const CostWeights& weights, int moves);

    // One sweep from the pose `begin` of cell `source` over all cells; true if any changed.
    bool sweep(const Problem& problem, std::span<const Cell> cells, std::span<const ComIntervals> com,
               const WidestPaths& widest, std::size_t source, const WindowPose& begin);

    // The path that ends at a pose of a cell, back to `source`, goal first; nothing if it is longer than `longest`.
    std::optional<std::vector<PathPose>> backtrack(const Problem& problem, std::span<const Cell> cells, std::size_t source,
                                                   std::size_t goal, const WindowPose& pose, std::size_t longest) const;

    // The pose of a cell within `range` that is the cheapest; the first of them where no path leads to any.
    WindowPose cheapest_pose(const Lattice& lattice, std::size_t cell, const WindowRange& range) const;

    bool reached(std::size_t cell) const { return low[cell] < high[cell]; }
    // Costs of a cell, by position: of those from `low` to `high`.
    float* costs(std::size_t cell) { return values_.data() + base_[cell]; }
    const float* costs(std::size_t cell) const { return values_.data() + base_[cell]; }

    std::vector<std::int32_t> first, last;  // by cell: range of positions for which there is room
    std::vector<std::int32_t> low, high;    // by cell: range of those that have a value
    SweepHistory history;

private:
    // Poses of a cell that are wide enough.
    struct PoseBuffer {
        explicit PoseBuffer(std::size_t n) : at(n), com(n), to_come(n), tables(n), base(n), cost(n) {}

        std::vector<std::int32_t> at;       // position in the cell's volume
        std::vector<float> com;             // x of the CoM [m]
        std::vector<float> to_come;         // cost so far (cost-to-come)
        std::vector<float> tables, base;    // costs of legs and trunk, of height and pitch
        std::vector<float> cost;            // of all
    };

    double move_cost(const Problem& problem, const Cell& cell, int move) const;
    void pose_costs(const Problem& problem, const Cell& cell, const ComIntervals& com, const std::uint8_t* width,
                    FlatRange range, const float* to_come, PoseBuffer& poses, float* out) const;
    bool keep(std::size_t cell, FlatRange range, const float* result);

    int level_ = 0, moves_ = 0;
    CostWeights weights_;
    std::vector<std::ptrdiff_t> base_;
    Reused<float> values_;
};

}  // namespace stairwright::lattice
