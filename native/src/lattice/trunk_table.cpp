#include <algorithm>
#include <cmath>
#include <limits>

#include "stairwright/lattice/leg_tables.hpp"

namespace stairwright::lattice {

namespace {

constexpr double kSoftShare = 0.15;  // of the mean link length: clearance from which on more is no cheaper
constexpr double kClearanceWeight = 0.5;

// Balls round the trunk's point: one that holds the outline, and one that it holds (negative where there is none).
struct Balls {
    double outer = 0.0, inner = -std::numeric_limits<double>::infinity();
};

Balls balls(const Trunk& trunk) {
    Balls out;
    for (const Polygon& polygon : trunk.outline) {
        for (const Vec2 corner : polygon.corners()) out.outer = std::max(out.outer, norm(corner));
        out.inner = std::max(out.inner, -polygon.separation({0.0, 0.0}));
    }
    return out;
}

// Places that the window of some pair of wheels covers, and at which pitches. Every window lies round the mean of its two
// wheels; what lies between windows of one front wheel counts too.
struct Covered {
    int x0 = 0, z0 = 0, columns = 0, rows = 0;
    std::vector<PitchRange> pitches;  // (rows, columns), empty where no window is
};

Covered covered(const WindowShape& shape, const std::vector<Vec2>& centres, const std::vector<SamplePair>& pairs) {
    const Lattice& lattice = shape.lattice;
    const int half = lattice.nx / 2 + 2;
    const auto steps = [&](double x) { return x / lattice.step; };
    Vec2 low = centres.front(), high = low;
    for (const Vec2 c : centres) {
        low = {std::min(low.x, c.x), std::min(low.z, c.z)};
        high = {std::max(high.x, c.x), std::max(high.z, c.z)};
    }
    Covered out;
    out.x0 = static_cast<int>(std::floor(steps(low.x))) - half;
    out.z0 = static_cast<int>(std::floor(steps(low.z))) + shape.low - 2;
    out.columns = static_cast<int>(std::ceil(steps(high.x))) + half - out.x0 + 1;
    out.rows = static_cast<int>(std::ceil(steps(high.z))) + shape.low + lattice.nz + 2 - out.z0 + 1;
    out.pitches.assign(static_cast<std::size_t>(out.rows) * out.columns, {lattice.pitches, 0});
    const std::vector<PitchRange> of_front = pitch_ranges(centres, pairs, shape)[kFront];
    for (std::size_t begin = 0, end = 0; begin < pairs.size(); begin = end) {
        const Vec2 front = centres[pairs[begin].front];
        double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
        for (end = begin; end < pairs.size() && pairs[end].front == pairs[begin].front; ++end) {
            lowest = std::min(lowest, centres[pairs[end].rear].z);
            highest = std::max(highest, centres[pairs[end].rear].z);
        }
        const auto column = [&](int rear) { return static_cast<int>(steps(0.5 * (centres[rear].x + front.x))); };
        const auto row = [&](double z) { return static_cast<int>(steps(0.5 * (z + front.z))); };
        const int a = std::max(0, column(pairs[begin].rear) - half - out.x0);
        const int b = std::min(out.columns - 1, column(pairs[end - 1].rear) + half - out.x0);
        const int d = std::max(0, row(lowest) + shape.low - 2 - out.z0);
        const int e = std::min(out.rows - 1, row(highest) + shape.low + lattice.nz + 2 - out.z0);
        const PitchRange looked_at = of_front[pairs[begin].front];
        for (int j = d; j <= e; ++j)
            for (int i = a; i <= b; ++i) {
                PitchRange& there = out.pitches[static_cast<std::size_t>(j) * out.columns + i];
                there = {std::min(there.first, looked_at.first), std::max(there.last, looked_at.last)};
            }
    }
    return out;
}

double clearance(const Terrain& terrain, const Trunk& trunk, Vec2 at, Turn pitch, double query_radius) {
    double least = query_radius;
    for (const Polygon& polygon : trunk.outline) least = std::min(least, terrain.polygon_clearance(polygon, at, pitch, query_radius));
    return least;
}

}  // namespace

TrunkTableData trunk_table(const Terrain& terrain, const RobotModel& robot, const WindowShape& shape, const TableWeights& weights,
                           double least_clearance, const std::vector<Vec2>& centres, const std::vector<SamplePair>& pairs) {
    const Lattice& lattice = shape.lattice;
    const Trunk& trunk = robot.robot.trunk;
    const Covered places = covered(shape, centres, pairs);
    TrunkTableData out{places.rows, places.columns, places.columns + lattice.row, places.x0, places.z0, {}, {}};
    const std::size_t page = static_cast<std::size_t>(out.rows) * out.stored;
    out.cost.assign(page * lattice.pitches, kInfeasible);
    double straight = 0.0;
    for (const LegModel& leg : robot.legs) straight = std::max(straight, leg.leg.thigh.length + leg.leg.calf.length);
    const double soft = kSoftShare * straight / 2.0;
    const Balls ball = balls(trunk);
    std::vector<Turn> turns;
    for (int t = 0; t < lattice.pitches; ++t) turns.push_back(Turn::by((t - lattice.pitches / 2) * lattice.turn));
    for (int j = 0; j < out.rows; ++j) {
        for (int i = 0; i < out.columns; ++i) {
            const PitchRange looked_at = places.pitches[static_cast<std::size_t>(j) * out.columns + i];
            if (looked_at.first >= looked_at.last) continue;
            const Vec2 at = {(places.x0 + i) * lattice.step, (places.z0 + j) * lattice.step};
            // One look at the trunk's point settles most places for all pitches.
            const double around = terrain.link_clearance(at, at, 0.0, ball.outer + soft);
            if (around < ball.inner + least_clearance) continue;
            for (int t = looked_at.first; t < looked_at.last; ++t) {
                const double c = around < ball.outer + soft ? clearance(terrain, trunk, at, turns[t], soft) : soft;
                if (c < least_clearance) continue;
                const double e = std::max(0.0, soft - c) / soft;
                out.cost[t * page + static_cast<std::size_t>(j) * out.stored + i] = static_cast<float>(weights.clearance * kClearanceWeight * e * e);
            }
        }
    }
    out.possible.resize(static_cast<std::size_t>(lattice.pitches) * out.rows * out.columns);
    for (std::size_t r = 0; r < static_cast<std::size_t>(lattice.pitches) * out.rows; ++r) {
        Bits bits = 0;
        for (int i = out.columns - 1; i >= 0; --i) {
            bits = bits << 1 | static_cast<Bits>(out.cost[r * out.stored + i] < kInfeasible);
            out.possible[r * out.columns + i] = bits;
        }
    }
    return out;
}

}  // namespace stairwright::lattice
