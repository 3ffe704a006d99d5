#include "stairwright/smoothing/refine.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "stairwright/smoothing/densify.hpp"
#include "stairwright/smoothing/objective.hpp"
#include "stairwright/smoothing/resample.hpp"
#include "stairwright/smoothing/smoothing.hpp"
#include "stairwright/whole.hpp"
#include "surprises.hpp"
#include "tipping.hpp"

namespace stairwright::smoothing {

namespace {

constexpr int kIterations = 40;
constexpr std::size_t kFewestNodes = 40;
constexpr double kStop = 0.0018;  // m
constexpr double kAsDrawn = 0.3;   // m that both wheels roll together; how far a pose shapes others, for legs of 0.4 m

// Nodes as columns: front and rear arc length, trunk x, z, pitch.
std::array<Column, 5> columns(std::span<const Node> nodes) {
    std::array<Column, 5> out;
    for (const auto& [s, body] : nodes) {
        const std::array<double, 5> row = {s.front, s.rear, body.x, body.z, body.pitch};
        for (std::size_t c = 0; c < row.size(); ++c) out[c].push_back(row[c]);
    }
    return out;
}

std::vector<Node> nodes_of(const std::array<Column, 5>& c) {
    std::vector<Node> out(c[0].size());
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = {{c[0][k], c[1][k]}, {c[2][k], c[3][k], c[4][k]}};
    return out;
}

// Gaussian smoothing with point-mirrored ends, which stay in place.
Column gaussian(const Column& a, double sigma) {
    if (sigma < 0.3) return a;
    const auto n = static_cast<std::ptrdiff_t>(a.size());
    const std::ptrdiff_t reach = std::min(static_cast<std::ptrdiff_t>(whole_part(4 * sigma, a.size())) + 1, n - 1);
    Column kernel;
    double total = 0.0;
    for (std::ptrdiff_t k = -reach; k <= reach; ++k) {
        const double share = static_cast<double>(k) / sigma;
        kernel.push_back(std::exp(-0.5 * (share * share)));
        total += kernel.back();
    }
    const auto at = [&](std::ptrdiff_t k) { return k < 0 ? 2 * a[0] - a[-k] : k >= n ? 2 * a[n - 1] - a[2 * (n - 1) - k] : a[k]; };
    Column out(a.size());
    for (std::ptrdiff_t i = 0; i < n; ++i)
        for (std::ptrdiff_t k = -reach; k <= reach; ++k) out[i] += at(i + k) * (kernel[k + reach] / total);
    return out;
}

bool rolls_forward(std::span<const Node> poses) {
    for (std::size_t k = 1; k < poses.size(); ++k)
        if (poses[k].s.front < poses[k - 1].s.front || poses[k].s.rear < poses[k - 1].s.rear) return false;
    return true;
}

bool is_near(const WheelPlaces& s, std::span<const WheelPlaces> places, double distance) {
    return std::ranges::any_of(places, [&](const WheelPlaces& at) {
        return std::abs(at.front - s.front) + std::abs(at.rear - s.rear) < distance;
    });
}

// A wheel this near to a concave corner stops in it: only there it leans on both faces.
void stop_in_corners(Column& s, const std::vector<double>& corners) {
    for (double& at : s) {
        const auto next = std::lower_bound(corners.begin(), corners.end(), at);
        if (next != corners.end() && *next - at <= kStop) at = *next;
        else if (next != corners.begin() && at - *(next - 1) <= kStop) at = *(next - 1);
    }
}

// A wheel that rolls through a concave corner stops in it: before and after it a leg reaches less far.
void stop_in_all_corners(Column& s, const std::vector<double>& corners) {
    for (std::size_t k = 1; k < s.size(); ++k) {
        const auto corner = std::lower_bound(corners.begin(), corners.end(), std::min(s[k - 1], s[k]));
        if (corner == corners.end() || *corner > std::max(s[k - 1], s[k])) continue;
        double& nearer = std::abs(s[k - 1] - *corner) < std::abs(s[k] - *corner) ? s[k - 1] : s[k];
        nearer = *corner;
    }
}

// Smoothing must not make wheels roll back that only rolled forward.
void keep_rising(Column& s, double first, double last) {
    double highest = first;
    for (double& at : s) at = highest = std::max(highest, std::clamp(at, first, last));
}

}  // namespace

RefinedPath refine(const RefineProblem& problem, const std::array<Node, 2>& ends, std::span<const Node> poses,
                   const NodeSpacing& spacing, std::size_t held, std::span<const WheelPlaces> as_drawn) {
    if (poses.size() < 2 || held < 1 || held > kFewestNodes)
        throw std::invalid_argument("a path has two poses or more; from 1 to 40 nodes at its ends can be held");
    std::vector<Node> way(poses.begin(), poses.end());
    way.front() = ends[0], way.back() = ends[1];
    const double size = problem.robot.scale();
    const Column u = path_parameter(way, spacing.swing);
    const std::size_t n = std::max(kFewestNodes, whole_part(u.back() / (spacing.spacing * size)));
    const double hop = u.back() / static_cast<double>(n - 1);
    const std::vector<Node> laid = resample(way, u, n);
    std::array<Column, 5> smoothed = columns(laid);
    for (std::size_t c = 0; c < smoothed.size(); ++c)
        smoothed[c] = gaussian(smoothed[c], spacing.softness * (c < 2 ? 0.01 : 0.05) * size / hop);
    if (rolls_forward(way))
        for (int pair : {kFront, kRear}) keep_rising(smoothed[pair], laid[held - 1].s[pair], laid[n - held].s[pair]);
    for (int pair : {kFront, kRear}) stop_in_corners(smoothed[pair], problem.path.corners());
    if (spacing.thorough)
        for (int pair : {kFront, kRear}) stop_in_all_corners(smoothed[pair], problem.path.corners());
    std::vector<Node> nodes = nodes_of(smoothed);
    std::vector<bool> fixed(n, false);
    for (std::size_t k = 0; k < held; ++k)
        for (const std::size_t end : {k, n - 1 - k}) fixed[end] = true, nodes[end] = laid[end];

    const std::vector<double> changes = contact_changes(problem.path, nodes);
    const std::vector<NodeIntervals> intervals =
        intervals_along(problem.path, nodes, changes, problem.friction, problem.reserve, problem.lag);
    auto [wheels, contacts, slopes, bodies] = geometry_along(problem.path, nodes);
    std::vector<std::vector<WheelLoads>> loads;
    if (problem.torques)
        loads = loads_along(problem.path, nodes, changes, problem.friction, problem.lag, problem.robot.mass * kGravity);
    std::vector<std::array<Surprise, 2>> met = surprises(problem, nodes, intervals);
    for (std::size_t k = 0; k < n; ++k)
        if (is_near(nodes[k].s, as_drawn, kAsDrawn * size)) met[k] = {};
    const std::vector<TippingBounds> tipping = tipping_bounds(problem, nodes, intervals);
    const SmoothingProblem smoothing{problem.terrain, problem.robot, wheels, contacts, slopes, intervals, loads, met, tipping, fixed,
                                     objective(problem, spacing, hop / kUsualSpacing)};
    smooth(smoothing, bodies, kIterations, spacing.thorough);
    for (std::size_t k = 0; k < n; ++k) nodes[k].body = bodies[k];

    RefinedPath out;
    out.nodes = densify(problem.path, problem.robot, nodes, changes);
    out.margins = node_margins(problem.terrain, problem.path, problem.robot, out.nodes, problem.friction, problem.lag);
    return out;
}

}  // namespace stairwright::smoothing
