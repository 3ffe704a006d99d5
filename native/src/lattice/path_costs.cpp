// What moves and poses cost, and the path that the costs lead back along.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "stairwright/lattice/cheapest_paths.hpp"
#include "stairwright/simd.hpp"

namespace stairwright::lattice {

namespace {

// Whether a row's widths are all 0. Eight are looked at together: up to seven of the row's rim, which is 0, too.
bool all_zero(const std::uint8_t* width, int columns) {
    std::uint64_t any = 0;
    for (int x = 0; x < columns; x += 8) {
        std::uint64_t eight;
        std::memcpy(&eight, width + x, sizeof eight);
        any |= eight;
    }
    return any == 0;
}

// What the costs of a cell's poses have in common.
struct CostTerms {
    float low, high, reserve_low, reserve_high;  // CoM intervals [m]
    float wanted, heavy;
};

STAIRWRIGHT_INLINE float smaller(float a, float b) { return a < b ? a : b; }
STAIRWRIGHT_INLINE float larger(float a, float b) { return a > b ? a : b; }
STAIRWRIGHT_INLINE float missing(float margin, float wanted) {
    return larger(0.0F, wanted - larger(-0.06F, margin)) / wanted;
}

// cost[k] = to_come[k] + what pose k costs, whose CoM is at com[k].
STAIRWRIGHT_VECTOR_CLONES
void add_costs(const CostTerms r, const int count, const float* __restrict com, const float* __restrict to_come,
               const float* __restrict tables, const float* __restrict base, float* __restrict cost) {
    for (int k = 0; k < count; ++k) {
        const float h = missing(smaller(com[k] - r.low, r.high - com[k]), r.wanted);
        const float g = missing(smaller(com[k] - r.reserve_low, r.reserve_high - com[k]), r.wanted);
        cost[k] = to_come[k] + 0.5F * tables[k] + base[k] + r.heavy * (h * h + g * g);
    }
}

}  // namespace

// Of rolling into a cell: the distance, dearer when one wheel rolls alone.
double CheapestPaths::move_cost(const Problem& problem, const Cell& cell, int move) const {
    const auto [df, dr] = kMoves[move];
    const double length = std::abs(problem.s[cell.front] - problem.s[cell.front - df]) +
                          std::abs(problem.s[cell.rear] - problem.s[cell.rear - dr]);
    const double factor = move == 0 ? 1.0 : (move < kForwardMoves ? 1.25 : 2.5);
    return length * factor / (2.0 * problem.lattice.step);
}

// Costs of paths to the poses of a cell in `range`: the cost `to_come` there and the pose's own. Narrower ones are
// infeasible.
void CheapestPaths::pose_costs(const Problem& problem, const Cell& cell, const ComIntervals& com, const std::uint8_t* width,
                               FlatRange range, const float* to_come, PoseBuffer& poses, float* out) const {
    const Lattice& lattice = problem.lattice;
    const LegTable &front = problem.legs[kFront], &rear = problem.legs[kRear];
    const TrunkTable& trunk = problem.trunk;
    const double mean = 0.5 * (problem.centres[cell.front].z + problem.centres[cell.rear].z);
    const auto single = [](double v) { return static_cast<float>(v); };
    const bool no_reserve = com.reserve.empty();
    const ComTerms terms(problem, cell);
    const auto reserve = no_reserve ? Interval{com.friction.middle(), com.friction.middle()} : com.reserve;
    const CostTerms shared{single(com.lag.lower), single(com.lag.upper), single(reserve.lower), single(reserve.upper),
                           single(weights_.wanted_margin), single(0.25 * weights_.com_margin)};
    const float advance = terms.trunk_share * single(lattice.step);
    int count = 0;
    const float left = terms.trunk_share * single(cell.x0 * lattice.step) + terms.carried;
    std::fill(out + range.low, out + range.high, kInfeasible);
    for (int t = std::max(0, range.low / lattice.layer() - 2); t < std::min(lattice.nt, range.high / lattice.layer() - 1); ++t) {
        const int pitch_index = cell.t0 + t;
        const double pitch = (pitch_index - lattice.pitches / 2) * lattice.turn, lean = pitch + 0.8 * cell.slope;
        const float first = left + terms.trunk_offset(problem, problem.cosines[pitch_index], problem.sines[pitch_index]);
        const TableWindow at = table_window(problem, cell, t);
        const float *front_moments = front.moments(cell.front, pitch_index), *rear_moments = rear.moments(cell.rear, pitch_index);
        const float *front_costs = front.costs(cell.front, pitch_index), *rear_costs = rear.costs(cell.rear, pitch_index);
        const float* trunk_costs = trunk.cost + static_cast<std::ptrdiff_t>(pitch_index) * trunk.rows * trunk.stored;
        for (int z = at.low; z < at.high; ++z) {
            const int row = lattice.row_start(t, z);
            const int a = std::max(range.low - row, 0), b = std::min(range.high - row, lattice.nx);
            if (a >= b) continue;
            // Most rows have none that is wide enough.
            const std::uint8_t* widths = width + row;
            if (all_zero(widths, lattice.nx)) continue;
            const Bits wide = packed(lattice.nx, [&](int x) { return widths[x] >= level_; }) & between(a, b);
            if (wide == 0) continue;
            const double rise = ((cell.z0 + z) * lattice.step - mean) / weights_.height - 1.0;
            const std::ptrdiff_t fz = at.front_row + z, rz = at.rear_row + z, tz = at.trunk_row + z;
            const float base = single(0.075 * weights_.pitch * lean * lean + 0.3 * rise * rise);
            const float* fm = front_moments + fz * front.rows + at.front_column;
            const float* rm = rear_moments + rz * rear.rows + at.rear_column;
            const float* fc = front_costs + fz * front.columns + at.front_column;
            const float* rc = rear_costs + rz * rear.columns + at.rear_column;
            const float* tc = trunk_costs + tz * trunk.stored + at.trunk_column;
            for_each_bit(wide, [&](int x) {
                poses.at[count] = row + x;
                poses.com[count] = first + static_cast<float>(x) * advance + terms.per_mass * (fm[x] + rm[x]);
                poses.to_come[count] = to_come[row + x];
                poses.tables[count] = fc[x] + rc[x] + tc[x];
                poses.base[count] = base;
                count += to_come[row + x] < kInfeasible;
            });
        }
    }
    add_costs(shared, count, poses.com.data(), poses.to_come.data(), poses.tables.data(), poses.base.data(), poses.cost.data());
    for (int k = 0; k < count; ++k) out[poses.at[k]] = poses.cost[k];
}

std::optional<std::vector<PathPose>> CheapestPaths::backtrack(const Problem& problem, std::span<const Cell> cells,
                                                              std::size_t source, std::size_t goal, const WindowPose& pose,
                                                              std::size_t longest) const {
    const Lattice& lattice = problem.lattice;
    const double one = weights_.body_step;
    const std::array<double, 5> price = {2.6 * one, 1.0 * one, 0.0 * one, 1.0 * one, 2.6 * one};
    std::vector<PathPose> out;
    std::size_t c = goal;
    WindowPose at = pose;
    while (out.size() < longest) {
        const Cell& cell = cells[c];
        out.push_back({cell.front, cell.rear, cell.t0 + at.t - lattice.pitches / 2, cell.z0 + at.z, cell.x0 + at.x});
        if (c == source) return out;
        double least = 1e8;
        int origin = -1;
        WindowPose from;
        for (int m = 0; m < moves_; ++m) {
            const int p = cell.origin[m];
            if (p < 0 || !reached(p)) continue;
            const Cell& before = cells[p];
            const double cost = move_cost(problem, cell, m);
            const float* value = costs(p);
            for (int dt = -2; dt <= 2; ++dt)
                for (int dz = -2; dz <= 2; ++dz) {
                    const int t = at.t + dt + cell.t0 - before.t0, z = at.z + dz + cell.z0 - before.z0;
                    if (t < 0 || t >= lattice.nt || z < 0 || z >= lattice.nz) continue;
                    for (int dx = -2; dx <= 2; ++dx) {
                        const int x = at.x + dx + cell.x0 - before.x0;
                        if (x < 0 || x >= lattice.nx) continue;
                        const int k = lattice.row_start(t, z) + x;
                        if (k < low[p] || k >= high[p]) continue;
                        const double total = value[k] + cost + (price[dt + 2] + price[dz + 2] + price[dx + 2]);
                        if (total >= least) continue;
                        least = total;
                        origin = p;
                        from = {t, z, x};
                    }
                }
        }
        if (origin < 0) return std::nullopt;
        c = static_cast<std::size_t>(origin);
        at = from;
    }
    return std::nullopt;
}

}  // namespace stairwright::lattice
