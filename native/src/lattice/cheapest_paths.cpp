#include "stairwright/lattice/cheapest_paths.hpp"

#include <algorithm>
#include <cmath>

namespace stairwright::lattice {

namespace {

// Ranges of positions of the cells that are wide enough.
struct Layout {
    std::vector<std::int32_t> first, last;
    std::vector<std::ptrdiff_t> base;
    std::size_t total = 0;
};

Layout lay_out(const WidestPaths& widest, int level, std::span<const std::uint8_t> wanted) {
    Layout out{std::vector<std::int32_t>(widest.size(), 0), std::vector<std::int32_t>(widest.size(), 0),
             std::vector<std::ptrdiff_t>(widest.size(), 0)};
    for (std::size_t c = 0; c < widest.size(); ++c) {
        if (wanted[c] != 0 && widest.reached(c)) {
            const std::uint8_t* width = widest.width(c);
            auto [a, b] = widest.range(c);
            while (a < b && width[a] < level) ++a;
            while (a < b && width[b - 1] < level) --b;
            out.first[c] = a;
            out.last[c] = b;
        }
        out.base[c] = static_cast<std::ptrdiff_t>(out.total) - out.first[c];
        out.total += static_cast<std::size_t>(out.last[c] - out.first[c]);
    }
    return out;
}

}  // namespace

CheapestPaths::CheapestPaths(const WidestPaths& widest, int level, std::span<const std::uint8_t> wanted,
                             const CostWeights& weights, int moves)
    : low(widest.size(), 0), high(widest.size(), 0), history(widest.size()), level_(level), moves_(moves), weights_(weights),
      values_([&] {
          Layout layout = lay_out(widest, level, wanted);
          first = std::move(layout.first);
          last = std::move(layout.last);
          base_ = std::move(layout.base);
          return layout.total;
      }()) {}

bool CheapestPaths::sweep(const Problem& problem, std::span<const Cell> cells, std::span<const ComIntervals> com,
                          const WidestPaths& widest, std::size_t source, const WindowPose& begin) {
    const Lattice& lattice = problem.lattice;
    const int size = lattice.volume(), margin = lattice.reach();
    const auto body_step = static_cast<float>(weights_.body_step);
    std::vector<float> gathered(size, kInfeasible), result(size, kInfeasible);
    PoseBuffer poses(static_cast<std::size_t>(lattice.nt) * lattice.nz * lattice.nx + 1);
    bool changed = false;
    for (std::size_t c = 0; c < cells.size(); ++c) {
        if (first[c] >= last[c]) continue;
        const Cell& cell = cells[c];
        FlatRange range{size, 0};
        bool news = c == source && history.seen[c] < 0;
        for (int m = 0; m < moves_; ++m) {
            const int p = cell.origin[m];
            if (p < 0 || !reached(p)) continue;
            const int by = offset(lattice, cell, cells[p]);
            range = {std::min(range.low, low[p] - by), std::max(range.high, high[p] - by)};
            news = news || history.grown[p] > history.seen[c];
        }
        if (!news) continue;
        history.seen[c] = ++history.visits;
        if (c == source) range = {0, size};
        range = {std::max(0, range.low - margin), std::min(size, range.high + margin)};
        if (std::max(range.low, first[c]) >= std::min(range.high, last[c])) continue;
        const int a = std::max(0, range.low - margin), b = std::min(size, range.high + margin);
        std::fill(gathered.begin() + a, gathered.begin() + b, kInfeasible);
        std::fill(result.begin() + a, result.begin() + b, kInfeasible);
        for (int m = 0; m < moves_; ++m) {
            const int p = cell.origin[m];
            if (p < 0 || !reached(p)) continue;
            const auto cost = static_cast<float>(move_cost(problem, cell, m));
            gather_cheapest(costs(p), {low[p], high[p]}, offset(lattice, cell, cells[p]), cost, gathered.data(), size);
        }
        convolve(gathered.data(), result.data(), range, lattice, body_step);
        if (c == source)
            for (int t = std::max(0, begin.t - 2); t < std::min(lattice.nt, begin.t + 3); ++t)
                for (int z = std::max(0, begin.z - 2); z < std::min(lattice.nz, begin.z + 3); ++z)
                    for (int x = std::max(0, begin.x - 2); x < std::min(lattice.nx, begin.x + 3); ++x)
                        result[lattice.row_start(t, z) + x] =
                            static_cast<float>(std::abs(t - begin.t) + std::abs(z - begin.z) + std::abs(x - begin.x));
        range = {std::max(range.low, first[c]), std::min(range.high, last[c])};
        pose_costs(problem, cell, com[c], widest.width(c), range, result.data(), poses, gathered.data());
        if (keep(c, range, gathered.data())) {
            history.grown[c] = history.visits;
            changed = true;
        }
    }
    return changed;
}

// Takes over what of `result` in `range` is cheaper than what the cell has; true if any is.
bool CheapestPaths::keep(std::size_t cell, FlatRange range, const float* result) {
    auto [a, b] = range;
    while (a < b && result[a] >= kInfeasible) ++a;
    while (a < b && result[b - 1] >= kInfeasible) --b;
    if (a >= b) return false;
    float* value = costs(cell);
    if (!reached(cell)) {
        std::copy(result + a, result + b, value + a);
        low[cell] = a;
        high[cell] = b;
        return true;
    }
    for (int k = a; k < low[cell]; ++k) value[k] = kInfeasible;
    for (int k = high[cell]; k < b; ++k) value[k] = kInfeasible;
    low[cell] = std::min(a, low[cell]);
    high[cell] = std::max(b, high[cell]);
    bool changed = false;
    for (int k = a; k < b; ++k)
        if (result[k] < value[k] - 1e-4F) {
            value[k] = result[k];
            changed = true;
        }
    return changed;
}

WindowPose CheapestPaths::cheapest_pose(const Lattice& lattice, std::size_t cell, const WindowRange& range) const {
    WindowPose best = range.first;
    float least = kInfeasible;
    for (int t = range.first.t; t < range.last.t; ++t)
        for (int z = range.first.z; z < range.last.z; ++z)
            for (int x = range.first.x; x < range.last.x; ++x) {
                const int k = lattice.row_start(t, z) + x;
                if (k < low[cell] || k >= high[cell] || costs(cell)[k] >= least) continue;
                least = costs(cell)[k];
                best = {t, z, x};
            }
    return best;
}

}  // namespace stairwright::lattice
