#include "stairwright/lattice/pairs.hpp"

#include <algorithm>
#include <cmath>

namespace stairwright::lattice {

namespace {

constexpr double kSlopeShare = 0.8;  // of the slope between the wheels that a window's pitch follows

double slope(const std::vector<Vec2>& centres, SamplePair pair) {
    const Vec2 d = centres[pair.front] - centres[pair.rear];
    return std::atan2(d.z, d.x);
}

int rounded(double x) { return static_cast<int>(std::nearbyint(x)); }

// Index of the first pitch in the window of a cell of this slope.
int first_pitch(double slope, const Lattice& lattice) {
    const int middle = rounded(-kSlopeShare * slope / lattice.turn) + lattice.pitches / 2;
    return std::min(lattice.pitches - lattice.nt, std::max(0, middle - lattice.nt / 2));
}

// The concave corner that a wheel at each sample touches, -1 for none.
std::vector<int> touched_corners(const WheelPath& path, const std::vector<double>& s) {
    const std::vector<double>& corners = path.corners();
    std::vector<int> out;
    for (const double at : s) {
        const std::size_t k = path.corner_from(at);
        const bool ahead = k < corners.size() && corners[k] - at <= kTouch;
        const bool behind = k > 0 && at - corners[k - 1] <= kTouch;
        out.push_back(ahead ? static_cast<int>(k) : behind ? static_cast<int>(k) - 1 : -1);
    }
    return out;
}

// A wheel comes to touch a second face, or leaves it, while the other stands: what carries the robot then changes at a
// place that the search has judged, not somewhere on a diagonal.
void set_origins(const CellProblem& problem, CellTable& table) {
    const std::vector<int> touch = touched_corners(problem.path, problem.s);
    const int n = static_cast<int>(problem.s.size());
    for (Cell& cell : table.cells) {
        cell.origin.fill(-1);
        for (std::size_t m = 0; m < kMoves.size(); ++m) {
            const int i = cell.front - kMoves[m].front, j = cell.rear - kMoves[m].rear;
            if (i < 0 || j < 0 || i >= n || j >= n) continue;
            const bool same_contacts = touch[i] == touch[cell.front] && touch[j] == touch[cell.rear];
            if (i == cell.front || j == cell.rear || same_contacts)
                cell.origin[m] = table.number[static_cast<std::size_t>(i) * n + j];
        }
    }
}

Interval of(const stairwright::Interval& i) { return {i.lower, i.upper}; }

}  // namespace

std::vector<SamplePair> sample_pairs(const std::vector<Vec2>& centres, double near, double far, int front, int rear) {
    std::vector<SamplePair> out;
    const int n = static_cast<int>(centres.size());
    for (int i = std::max(0, front); i < n; ++i) {
        int first = i;
        while (first > 0 && centres[i].x - centres[first - 1].x <= far) --first;
        for (int j = first; j < std::min(i, rear + 1); ++j) {
            const Vec2 d = centres[i] - centres[j];
            const double distance = std::hypot(d.x, d.z);
            if (near <= distance && distance <= far) out.push_back({i, j});
        }
    }
    return out;
}

std::array<std::vector<PitchRange>, 2> pitch_ranges(const std::vector<Vec2>& centres, const std::vector<SamplePair>& pairs,
                                                   const WindowShape& shape) {
    const Lattice& lattice = shape.lattice;
    std::array<std::vector<PitchRange>, 2> out;
    out.fill(std::vector<PitchRange>(centres.size(), {lattice.pitches, 0}));
    for (const SamplePair pair : pairs) {
        const int first = first_pitch(slope(centres, pair), lattice);
        for (const int wheel : {kFront, kRear}) {
            PitchRange& range = out[wheel][wheel == kFront ? pair.front : pair.rear];
            range = {std::min(range.first, first), std::max(range.last, first + lattice.nt)};
        }
    }
    return out;
}

CellTable cell_table(const CellProblem& problem, const std::vector<SamplePair>& pairs, const WindowShape& shape) {
    const std::size_t n = problem.s.size();
    const Lattice& lattice = shape.lattice;
    CellTable out;
    out.number.assign(n * n, -1);
    for (const SamplePair pair : pairs) {
        const WheelPlaces s = {problem.s[pair.front], problem.s[pair.rear]};
        ComIntervals com;
        com.friction = of(pair_interval(problem.path, s, problem.friction));
        if (!(com.friction.upper - com.friction.lower >= 2.0 * problem.least_com_margin)) continue;
        com.reserve = {1.0, -1.0};
        if (problem.reserve > 0.0) com.reserve = of(steady_interval(problem.path, s, problem.reserve));
        const Vec2 middle = 0.5 * (problem.centres[pair.front] + problem.centres[pair.rear]);
        Cell cell;
        cell.front = pair.front, cell.rear = pair.rear;
        cell.slope = slope(problem.centres, pair);
        cell.t0 = first_pitch(cell.slope, lattice);
        cell.x0 = rounded(middle.x / lattice.step) - lattice.nx / 2;
        cell.z0 = rounded(middle.z / lattice.step) + shape.low;
        out.number[pair.front * n + pair.rear] = static_cast<std::int32_t>(out.cells.size());
        out.cells.push_back(cell);
        out.com.push_back(com);
    }
    set_origins(problem, out);
    return out;
}

Interval lag_interval(const WheelPath& path, WheelPlaces s, const Interval& stated, double friction, double lag) {
    const Interval found = of(lagged_interval(path, s, friction, lag, true));
    return found.empty() ? Interval{stated.middle(), stated.middle()} : found;
}

Outlines outlines(const std::vector<Vec2>& profile, const std::vector<Vec2>& centres, double reach) {
    struct Span {
        std::size_t first, last;
    };
    const auto less = [](Vec2 v, double x) { return v.x < x; };
    const auto more = [](double x, Vec2 v) { return x < v.x; };
    std::vector<Span> spans;
    std::size_t longest = 0;
    for (const Vec2 centre : centres) {
        const auto first = std::lower_bound(profile.begin(), profile.end(), centre.x - reach, less);
        const auto last = std::upper_bound(profile.begin(), profile.end(), centre.x + reach, more);
        spans.push_back({static_cast<std::size_t>(first - profile.begin()), static_cast<std::size_t>(last - profile.begin())});
        longest = std::max(longest, spans.back().last - spans.back().first);
    }
    Outlines out{2 * longest + 5, {}};
    out.rows.assign(out.width * centres.size(), 0);
    for (std::size_t i = 0; i < centres.size(); ++i) {
        const auto [first, last] = spans[i];
        const std::size_t a = first > 0 ? first - 1 : 0, b = std::min(last + 1, profile.size());
        std::int64_t* row = out.rows.data() + i * out.width;
        *row++ = static_cast<std::int64_t>(b - a);
        for (std::size_t k = a; k < b; ++k) {
            Vec2 d = profile[k] - centres[i];
            // A segment that enters from outside counts by where it crosses the border.
            if (k < first || k >= last) {
                const Vec2 e = profile[k < first ? k + 1 : k - 1] - profile[k];
                const double side = k < first ? -reach : reach;
                d = {side, d.z + e.z * (side - d.x) / e.x};
            }
            *row++ = std::llrint(d.x * 1e7);
            *row++ = std::llrint(d.z * 1e7);
        }
    }
    return out;
}

}  // namespace stairwright::lattice
