// Tables of the search: what a leg or the trunk costs at each place, or that it cannot be.
//
// A leg's cost depends on where the hip lies relative to the wheel and on the terrain there, so it is computed once per
// wheel sample on a hip grid, then read onto the body lattice for every pitch: a pose of the search costs one read per
// leg and one for the trunk.
#pragma once

#include "stairwright/lattice/memory.hpp"
#include "stairwright/lattice/pairs.hpp"

namespace stairwright::lattice {

// Of the search, from the user's weights.
struct TableWeights {
    double clearance = 1.0, torque = 1.0;
};

// Bounds that every lattice pose keeps. Negative ones widen what is possible.
struct Tolerances {
    double trunk = 0.0, links = 0.0;  // least clearances [m]
    double reach = 0.0;               // slack of the hip-wheel distance [m]
    double thigh = 0.0;               // slack of the thigh joints [rad]
};

// Hip positions -half..half of half a lattice step round a wheel.
struct HipGridShape {
    double step = 0.0;  // of the body lattice [m]
    int half = 0;

    int size() const { return 2 * half + 1; }
    int parity_size() const { return size() / 2 + 1; }
};

// By parity of row and column, then row / 2 and column / 2, so that the body lattice, which reads every second hip
// position, reads neighbours in memory.
struct HipGrid {
    HipGridShape shape;
    std::vector<float> cost;    // (samples, 2, 2, m, m), kInfeasible where impossible
    std::vector<float> moment;  // (2, 2, m, m) of the leg pair about the wheel's centre [kg m]
    std::vector<float> angle;   // (2, 2, m, m) of the thigh in the world [rad]
};

// For wheels at `centres`, x rising; samples that are not `wanted` stay impossible.
HipGrid hip_grid(const Terrain& terrain, const RobotModel& robot, int pair, const std::vector<Vec2>& centres,
                 const std::vector<int>& wanted, const HipGridShape& shape, const TableWeights& weights, const Tolerances& tolerances);

// Storage of a LegTable.
struct LegTableData {
    int samples = 0, pitches = 0, rows = 0, columns = 0;
    std::unique_ptr<float[], Free> cost;
    std::vector<Bits> possible;
    std::vector<float> carried;
    std::vector<std::int32_t> x0, z0, u, v;
};

// Read a hip grid onto the body lattice; limits of the thigh are applied here. `like` says which sample of the grid
// stands for one here; of pitches out of `wanted` the table holds nothing.
LegTableData leg_table(const HipGrid& grid, const LegModel& leg, const std::vector<int>& like, const std::vector<Vec2>& centres,
                       const std::vector<PitchRange>& wanted, const Lattice& lattice, double thigh_slack);

struct TrunkTableData {
    int rows = 0, columns = 0, stored = 0, x0 = 0, z0 = 0;
    std::vector<float> cost;     // (pitches, rows, stored)
    std::vector<Bits> possible;  // (pitches, rows, columns)
};

TrunkTableData trunk_table(const Terrain& terrain, const RobotModel& robot, const WindowShape& shape, const TableWeights& weights,
                           double least_clearance, const std::vector<Vec2>& centres, const std::vector<SamplePair>& pairs);

}  // namespace stairwright::lattice
