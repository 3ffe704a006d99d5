#include "stairwright/lattice/leg_tables.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stairwright/lattice/ground_clearance.hpp"
#include "stairwright/simd.hpp"

namespace stairwright::lattice {

namespace {

constexpr double kSoftShare = 0.15;    // of the mean link length: clearance from which on more is no cheaper
constexpr double kReachShare = 0.1;    // of the reach's range, near whose ends poses cost
constexpr double kReachWeight = 0.2, kThighWeight = 0.2;
constexpr double kClearanceWeight = 0.25;
constexpr double kNearlyStraight = 0.9995;  // of the straight leg's length
constexpr float kThighSoft = 0.15F;         // rad; of room at the thigh's limits from which on more is no cheaper

double thickest(const Leg& leg) {
    double out = 0.0;
    for (const Link* link : {&leg.thigh, &leg.calf})
        for (const Capsule& c : link->shape) out = std::max(out, c.radius);
    return out;
}

double square(double x) { return x * x; }

// Costs of a row: those of the grid, and the thigh's room at its limits.
STAIRWRIGHT_VECTOR_CLONES
void read_row(const float* cost, const float* angle, int width, float shift, float half_range, float* out) {
    constexpr float pi = std::numbers::pi_v<float>, full = static_cast<float>(2.0 * std::numbers::pi);
    constexpr float weight = static_cast<float>(kThighWeight);
    for (int k = 0; k < width; ++k) {
        float w = angle[k] - shift;
        w = w - full * std::floor((w + pi) / full);
        const float room = half_range - std::abs(w);
        const float e = std::max(0.0F, kThighSoft - room) / kThighSoft;
        out[k] = room >= 0.0F ? cost[k] + weight * e * e : kInfeasible;
    }
}

}  // namespace

HipGrid hip_grid(const Terrain& terrain, const RobotModel& robot, int pair, const std::vector<Vec2>& centres,
                 const std::vector<int>& wanted, const HipGridShape& shape, const TableWeights& weights, const Tolerances& tolerances) {
    const LegModel& model = robot.legs[pair];
    const Leg& leg = model.leg;
    const double straight = leg.thigh.length + leg.calf.length, span = model.reach.most - model.reach.least;
    const double nearest = model.reach.least + tolerances.reach;
    const double farthest = std::min(model.reach.most - tolerances.reach, kNearlyStraight * straight);
    const double soft = kSoftShare * straight / 2.0;
    const double load = robot.mass * kGravity / 4.0;
    const double fine = 0.5 * shape.step;
    const std::size_t m = static_cast<std::size_t>(shape.parity_size()), page = 4 * m * m;
    HipGrid out{shape, std::vector<float>(centres.size() * page, kInfeasible), std::vector<float>(page), std::vector<float>(page)};
    std::vector<Vec2> wheels;
    for (const int i : wanted) wheels.push_back(centres[i]);
    if (wheels.empty()) return out;
    const GroundNearWheels ground(terrain, wheels, farthest + soft + thickest(leg));
    std::vector<float> clear(wheels.size());
    for (int v = 0; v < shape.size(); ++v) {
        for (int u = 0; u < shape.size(); ++u) {
            const Vec2 hip = {(u - shape.half) * fine, (v - shape.half) * fine};
            const double d = std::hypot(hip.x, hip.z);
            if (d < nearest || d > farthest) continue;
            const Vec2 thigh = knee_offset(leg, -hip), knee = hip + thigh;
            const std::size_t at = ((2 * (v % 2) + u % 2) * m + v / 2) * m + u / 2;
            out.angle[at] = static_cast<float>(std::atan2(-thigh.x, -thigh.z) - leg.thigh.bend);
            out.moment[at] = static_cast<float>(2.0 * (leg.thigh.mass * (hip + link_turn(leg.thigh, thigh) * leg.thigh.com).x +
                                                       leg.calf.mass * (knee + link_turn(leg.calf, -knee) * leg.calf.com).x));
            const double edge = kReachShare * span;
            const double stretched = (std::max(0.0, model.reach.least + edge - d) + std::max(0.0, d - model.reach.most + edge)) / edge;
            const double torque = square(load / leg.calf_motor.torque * knee.x) + square(load / leg.thigh_motor.torque * hip.x);
            const double base = kReachWeight * square(stretched) + weights.torque * torque;
            leg_clearances(terrain, ground, leg, {hip, knee}, wheels, soft, tolerances.links, clear);
            for (std::size_t k = 0; k < wheels.size(); ++k) {
                if (clear[k] < tolerances.links) continue;
                const double e = std::max(0.0, soft - clear[k]) / soft;
                out.cost[wanted[k] * page + at] = static_cast<float>(weights.clearance * kClearanceWeight * e * e + base);
            }
        }
    }
    return out;
}

LegTableData leg_table(const HipGrid& grid, const LegModel& model, const std::vector<int>& like, const std::vector<Vec2>& centres,
                       const std::vector<PitchRange>& wanted, const Lattice& lattice, double thigh_slack) {
    const Leg& leg = model.leg;
    const int n = static_cast<int>(centres.size()), m = grid.shape.parity_size(), half = grid.shape.half;
    const double fine = 0.5 * lattice.step;
    const std::size_t slices = static_cast<std::size_t>(n) * lattice.pitches, square_size = static_cast<std::size_t>(m) * m;
    LegTableData out{n, lattice.pitches, m, lattice.row, huge_array<float>(slices * m * lattice.row), std::vector<Bits>(slices * m), {}, {}, {}, {}, {}};
    for (std::vector<std::int32_t>* one : {&out.x0, &out.z0, &out.u, &out.v}) one->resize(slices);
    const auto middle = static_cast<float>(leg.thigh_range.middle());
    const auto half_range = static_cast<float>(0.5 * (leg.thigh_range.upper - leg.thigh_range.lower) - thigh_slack);
    const auto first_inside = [&](double centre, double offset) {  // lattice index whose hip is the first on the grid
        return static_cast<int>(std::ceil((centre - half * fine - offset) / lattice.step));
    };
    const auto on_grid = [&](int index, double offset, double centre) {
        return static_cast<int>(std::nearbyint((index * lattice.step + offset - centre) / fine)) + half;
    };
    for (int i = 0; i < n; ++i) {
        out.carried.push_back(static_cast<float>(leg.pair_mass() * centres[i].x));
        for (int t = wanted[i].first; t < wanted[i].last; ++t) {
            const std::size_t slice = static_cast<std::size_t>(i) * lattice.pitches + t;
            const double pitch = (t - lattice.pitches / 2) * lattice.turn;
            const Vec2 hip = Turn::by(pitch) * leg.hip;
            const int x0 = out.x0[slice] = first_inside(centres[i].x, hip.x), z0 = out.z0[slice] = first_inside(centres[i].z, hip.z);
            const int u = out.u[slice] = on_grid(x0, hip.x, centres[i].x), v = out.v[slice] = on_grid(z0, hip.z, centres[i].z);
            const float shift = static_cast<float>(pitch) + middle;
            const std::size_t parity = 2 * (v % 2) + u % 2;
            const int width = std::min(lattice.row, m - u / 2);
            float* rows = out.cost.get() + slice * m * lattice.row;
            std::fill(rows, rows + static_cast<std::size_t>(m) * lattice.row, kInfeasible);
            for (int j = 0; j < m - v / 2; ++j) {
                const std::size_t from = parity * square_size + static_cast<std::size_t>(v / 2 + j) * m + u / 2;
                float* row = rows + static_cast<std::size_t>(j) * lattice.row;
                read_row(grid.cost.data() + like[i] * 4 * square_size + from, grid.angle.data() + from, width, shift, half_range, row);
                out.possible[slice * m + j] = packed(width, [&](int x) { return x < width && row[x] < kInfeasible; });
            }
        }
    }
    return out;
}

}  // namespace stairwright::lattice
