#include "stairwright/lattice/widest_paths.hpp"

#include <algorithm>
#include <cmath>

#include "stairwright/lattice/leg_clearance.hpp"
#include "stairwright/simd.hpp"

namespace stairwright::lattice {

namespace {

constexpr double kFullMargin = 0.06;  // m; more CoM margin is no better
constexpr float kReserved = 101.0F;   // quality from here on: equilibrium also at the reserved friction

// Quality of poses with their CoM at com[k] [m]: more is safer, 0 is impossible.
STAIRWRIGHT_VECTOR_CLONES
void rate(const float lower, const float upper, const float reserve_lower, const float reserve_upper, const float least,
          const float* __restrict com, const int count, std::uint8_t* __restrict quality) {
    const float scale = static_cast<float>(1.0 / kFullMargin);
    for (int k = 0; k < count; ++k) {
        const float m = std::min(com[k] - lower, upper - com[k]);
        const float reserve = std::min(com[k] - reserve_lower, reserve_upper - com[k]);
        const float base = 99.0F * std::min(1.0F, (m - least) * scale) + 1.0F;
        const float more = 154.0F * std::min(1.0F, (reserve - least) * scale) + kReserved;
        const float level = reserve >= least ? more : base;
        quality[k] = static_cast<std::uint8_t>(static_cast<std::int32_t>(m >= least ? level : 0.0F));
    }
}

void rate(const ComIntervals& com, double least, const float* x, int count, std::uint8_t* quality) {
    Interval reserve = com.reserve;
    if (reserve.empty()) reserve = {1e6, -1e6};
    const auto single = [](double v) { return static_cast<float>(v); };
    rate(single(com.friction.lower), single(com.friction.upper), single(reserve.lower), single(reserve.upper),
         single(least), x, count, quality);
}

}  // namespace

struct WidestPaths::Wider {
    explicit Wider(std::size_t n) : at(n), com(n), x(n), z(n), cos(n), sin(n), width(n), clear(n), held(n) {}

    TrunkPoses poses(int count) const { return {x.data(), z.data(), cos.data(), sin.data(), count}; }
    // Makes pose `from` pose `to`.
    void move(int from, int to) {
        at[to] = at[from], com[to] = com[from], width[to] = width[from];
        x[to] = x[from], z[to] = z[from], cos[to] = cos[from], sin[to] = sin[from];
    }
    // Leaves out poses whose legs are not clear of each other; how many of `count` are left.
    int keep_clear(int count) {
        int kept = 0;
        for (int k = 0; k < count; ++k)
            if (clear[k] != 0) move(k, kept++);
        std::fill_n(clear.begin(), kept, std::uint8_t{1});
        return kept;
    }

    std::vector<std::int32_t> at;          // position in the cell's volume
    std::vector<float> com;                // x of the CoM [m]
    std::vector<float> x, z, cos, sin;     // of the trunk from the front wheel [m], of its pitch
    std::vector<std::uint8_t> width;       // of the path
    std::vector<std::uint8_t> clear;       // whether the legs keep clear of each other
    std::vector<std::uint8_t> held;        // quality by what motors hold
};

WidestPaths::WidestPaths(const Lattice& lattice, std::size_t cells)
    : slot(cells, -1), first(cells, lattice.volume()), last(cells, 0), best(cells, 0), history(cells),
      size_(static_cast<std::size_t>(lattice.volume())), widths_(cells * size_) {}

std::uint8_t* WidestPaths::enter(std::size_t cell) {
    if (slot[cell] < 0) {
        slot[cell] = static_cast<std::int32_t>(used_++);
        std::fill_n(width(cell), size_, std::uint8_t{0});
    }
    return width(cell);
}

bool WidestPaths::sweep(const Problem& problem, std::span<const Cell> cells, std::span<const ComIntervals> com,
                        std::span<const std::uint8_t> entry, const WindowRange& begin, int moves) {
    const Lattice& lattice = problem.lattice;
    const int size = lattice.volume(), margin = lattice.reach();
    std::vector<std::uint8_t> gathered(size, 0), result(size, 0);
    Wider wider(static_cast<std::size_t>(lattice.nt) * lattice.nz * lattice.nx + 1);
    bool changed = false;
    for (std::size_t c = 0; c < cells.size(); ++c) {
        const Cell& cell = cells[c];
        FlatRange range{size, 0};
        bool news = entry[c] != 0 && history.seen[c] < 0;
        for (int m = 0; m < moves; ++m) {
            const int p = cell.origin[m];
            if (p < 0 || !reached(p)) continue;
            const int by = offset(lattice, cell, cells[p]);
            range = {std::min(range.low, first[p] - by), std::max(range.high, last[p] - by)};
            news = news || history.grown[p] > history.seen[c];
        }
        if (!news) continue;
        history.seen[c] = ++history.visits;
        if (entry[c] != 0) range = {0, size};
        range = {std::max(0, range.low - margin), std::min(size, range.high + margin)};
        if (range.empty()) continue;
        const int a = std::max(0, range.low - margin), b = std::min(size, range.high + margin);
        std::fill(gathered.begin() + a, gathered.begin() + b, std::uint8_t{0});
        std::fill(result.begin() + a, result.begin() + b, std::uint8_t{0});
        for (int m = 0; m < moves; ++m) {
            const int p = cell.origin[m];
            if (p >= 0 && reached(p))
                gather_widest(width(p), this->range(p), offset(lattice, cell, cells[p]), gathered.data(), size);
        }
        dilate(gathered.data(), result.data(), range, lattice);
        if (entry[c] != 0)
            for (int t = begin.first.t; t < begin.last.t; ++t)
                for (int z = begin.first.z; z < begin.last.z; ++z) {
                    const auto row = result.begin() + lattice.row_start(t, z);
                    std::fill(row + begin.first.x, row + begin.last.x, std::uint8_t{255});
                }
        enter(c);
        if (widen(problem, cell, com[c], c, range, result.data(), wider)) {
            history.grown[c] = history.visits;
            changed = true;
        }
    }
    return changed;
}

// Fills `wider` with possible poses in `range` where `result` is above `width`; how many there are.
int WidestPaths::collect(const Problem& problem, const Cell& cell, FlatRange range, const std::uint8_t* result,
                         const std::uint8_t* width, Wider& wider) const {
    const Lattice& lattice = problem.lattice;
    const LegTable &front = problem.legs[kFront], &rear = problem.legs[kRear];
    const TrunkTable& trunk = problem.trunk;
    const Vec2 wheel = problem.centres[cell.front];
    const double left = cell.x0 * lattice.step - wheel.x, down = cell.z0 * lattice.step - wheel.z;
    const ComTerms terms(problem, cell);
    const float step = static_cast<float>(lattice.step), x_first = static_cast<float>(cell.x0 * lattice.step);
    int count = 0;
    for (int t = std::max(0, range.low / lattice.layer() - 2); t < std::min(lattice.nt, range.high / lattice.layer() - 1); ++t) {
        const int pitch_index = cell.t0 + t;
        const double cosine = problem.cosines[pitch_index], sine = problem.sines[pitch_index];
        const float cos = static_cast<float>(cosine), sin = static_cast<float>(sine);
        const float trunk_com = terms.trunk_offset(problem, cosine, sine);
        const TableWindow at = table_window(problem, cell, t);
        const Bits *front_bits = front.bitsets(cell.front, pitch_index), *rear_bits = rear.bitsets(cell.rear, pitch_index);
        const float *front_moments = front.moments(cell.front, pitch_index), *rear_moments = rear.moments(cell.rear, pitch_index);
        for (int z = at.low; z < at.high; ++z) {
            const int row = lattice.row_start(t, z);
            const int a = std::max(range.low - row, 0), b = std::min(range.high - row, lattice.nx);
            if (a >= b) continue;
            const std::size_t trunk_row = static_cast<std::size_t>(pitch_index) * trunk.rows + at.trunk_row + z;
            Bits possible = shifted(front_bits[at.front_row + z], at.front_column) & shifted(rear_bits[at.rear_row + z], at.rear_column);
            possible &= trunk.possible[trunk_row * trunk.columns + at.trunk_column] & between(a, b);
            if (possible == 0) continue;
            const std::uint8_t *to = result + row, *so_far = width + row;
            possible &= packed(lattice.nx, [&](int x) { return to[x] > so_far[x]; });
            const float* fm = front_moments + static_cast<std::ptrdiff_t>(at.front_row + z) * front.rows + at.front_column;
            const float* rm = rear_moments + static_cast<std::ptrdiff_t>(at.rear_row + z) * rear.rows + at.rear_column;
            for_each_bit(possible, [&](int x) {
                const float legs = terms.carried + terms.per_mass * (fm[x] + rm[x]);
                wider.at[count] = row + x;
                wider.com[count] = terms.trunk_share * (x_first + static_cast<float>(x) * step) + legs + trunk_com;
                wider.x[count] = static_cast<float>(left + x * lattice.step);
                wider.z[count] = static_cast<float>(down + z * lattice.step);
                wider.cos[count] = cos;
                wider.sin[count] = sin;
                ++count;
            });
        }
    }
    return count;
}

// Widens the paths to poses of a cell to what `result` holds in `range`; true if any grew.
bool WidestPaths::widen(const Problem& problem, const Cell& cell, const ComIntervals& com, std::size_t number,
                        FlatRange range, const std::uint8_t* result, Wider& wider) {
    std::uint8_t* widths = width(number);
    const int found = collect(problem, cell, range, result, widths, wider);
    rate(com, problem.least_com_margin, wider.com.data(), found, wider.width.data());
    bool changed = false;
    int count = 0;
    for (int k = 0; k < found; ++k) {
        const int at = wider.at[k];
        const std::uint8_t least = std::min(wider.width[k], result[at]), so_far = widths[at];
        if (least <= so_far) continue;
        if (so_far > 0 && !torques_) {  // possible, as is known
            widths[at] = least;
            best[number] = std::max(best[number], least);
            changed = true;
            continue;
        }
        wider.width[k] = least;
        wider.move(k, count++);
    }
    if (count == 0) return changed;
    const Vec2 front = problem.centres[cell.front], rear_wheel = problem.centres[cell.rear] - front;
    legs_clear(problem.robot, problem.least_leg_distance, rear_wheel, wider.poses(count), wider.clear.data());
    if (torques_) {
        count = wider.keep_clear(count);
        torques_->rate(problem, cell, number, com, wider.poses(count), wider.com.data(), wider.held.data());
    }
    for (int k = 0; k < count; ++k) {
        if (wider.clear[k] == 0) continue;
        const int at = wider.at[k];
        const std::uint8_t least = torques_ ? std::min(wider.width[k], wider.held[k]) : wider.width[k];
        if (least <= widths[at]) continue;
        widths[at] = least;
        best[number] = std::max(best[number], least);
        first[number] = std::min(first[number], at);
        last[number] = std::max(last[number], at + 1);
        changed = true;
    }
    return changed;
}

std::vector<std::uint8_t> WidestPaths::leading_to(std::span<const Cell> cells, int level, std::size_t goal, int moves) const {
    std::vector<std::uint8_t> out(size(), 0);
    out[goal] = best[goal] >= level;
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t c = out.size(); c-- > 0;) {
            if (out[c] == 0) continue;
            for (int m = 0; m < moves; ++m) {
                const int p = cells[c].origin[m];
                if (p < 0 || out[p] != 0 || best[p] < level) continue;
                out[p] = 1;
                changed = changed || static_cast<std::size_t>(p) > c;  // those before it are still to come
            }
        }
    }
    return out;
}

}  // namespace stairwright::lattice
