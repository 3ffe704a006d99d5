#include "stairwright/obstacles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stairwright {

namespace {

constexpr double kTread = 0.10;                            // m
constexpr double kLevel = 3.0 * std::numbers::pi / 180.0;  // rad
constexpr double kSlope = 0.2;  // rad; ground between two faces of a flight that is no steeper is a tread too
constexpr double kLow = 0.02;   // m
constexpr double kStep = 0.005; // m, sampling of arcs and long lines
constexpr double kRounding = 1e-12;

// First and last sample of a stretch.
struct Stretch {
    std::size_t first, last;
};

struct Samples {
    std::vector<double> s, z;
    std::vector<std::size_t> ends;  // samples where a piece of the curve ends

    std::size_t count() const { return s.size(); }
    bool gentle(std::size_t k, double slope) const {
        return std::abs(z[k + 1] - z[k]) <= std::sin(slope) * (s[k + 1] - s[k]) + kRounding;
    }
};

Samples sampled(const WheelPath& path, double lower, double upper) {
    std::vector<double> marks = {lower};
    for (const Piece& piece : path.pieces())
        if (lower < piece.s && piece.s < upper) marks.push_back(piece.s);
    marks.push_back(upper);
    Samples out{{lower}, {}, {0}};
    for (std::size_t k = 0; k + 1 < marks.size(); ++k) {
        const double a = marks[k], b = marks[k + 1];
        const double n = std::max(1.0, std::ceil((b - a) / kStep));
        for (double i = 1.0; i < n; ++i) out.s.push_back(a + i * ((b - a) / n));
        if (b > out.s.back()) {  // a piece may have no length
            out.ends.push_back(out.count());
            out.s.push_back(b);
        }
    }
    for (const double s : out.s) out.z.push_back(path.centre(s).z);
    return out;
}

// Stretches between treads, where treads are no steeper than `slope`.
std::vector<Stretch> rough_stretches(const Samples& at, Stretch within, double slope) {
    std::vector<Stretch> out;
    std::size_t first = within.first;
    for (std::size_t i = within.first; i < within.last;) {
        if (!at.gentle(i, slope)) {
            ++i;
            continue;
        }
        std::size_t j = i;
        while (j < within.last && at.gentle(j, slope)) ++j;
        // The ends count as treads however short: the robot stands there.
        if (at.s[j] - at.s[i] >= kTread || i == within.first || j == within.last) {
            if (i > first) out.push_back({first, i});
            first = j;
        }
        i = j;
    }
    if (first < within.last) out.push_back({first, within.last});
    return out;
}

// Rises and descents of at least kLow, smaller turns within them ignored.
std::vector<Stretch> monotone_runs(const std::vector<double>& z, Stretch within) {
    std::vector<Stretch> out;
    std::size_t start = within.first, extreme = within.first;
    double direction = 0.0;
    for (std::size_t i = within.first + 1; i <= within.last; ++i) {
        if (direction == 0.0) {
            if (std::abs(z[i] - z[start]) >= kLow) direction = std::copysign(1.0, z[i] - z[start]), extreme = i;
        } else if (direction * (z[i] - z[extreme]) > 0.0) {
            extreme = i;
        } else if (direction * (z[extreme] - z[i]) >= kLow) {
            out.push_back({start, extreme});
            start = extreme, extreme = i, direction = -direction;
        }
    }
    if (direction != 0.0) out.push_back({start, extreme});
    return out;
}

// The run without level pieces at its ends, up to whole pieces.
Stretch steep_part(const Samples& at, Stretch run) {
    const auto& ends = at.ends;
    const auto first = std::upper_bound(ends.begin(), ends.end(), run.first) - 1;
    const auto last = std::lower_bound(ends.begin(), ends.end(), run.last);
    Stretch out = run;
    bool any = false;
    for (auto mark = first; mark != last; ++mark) {
        const std::size_t a = *mark, b = *(mark + 1);
        if (std::abs(at.z[b] - at.z[a]) <= std::sin(kLevel) * (at.s[b] - at.s[a]) + kRounding) continue;
        if (!any) out.first = a;
        out.last = b;
        any = true;
    }
    return out;
}

Obstacle obstacle(const WheelPath& path, const Samples& at, Stretch run) {
    const auto [a, b] = steep_part(at, run);
    const double height = at.z[b] - at.z[a];
    // Normals lean back by the slope; pieces end at samples, so look between these.
    std::vector<double> slopes;
    for (std::size_t k = a; k < b; ++k)
        slopes.push_back(-std::copysign(1.0, height) * path.normal((at.s[k] + at.s[k + 1]) / 2).x);
    const double steepest = *std::max_element(slopes.begin(), slopes.end());
    std::size_t k = slopes.size() - 1;
    while (slopes[k] < steepest - 1e-6) --k;
    const double place = (at.s[a + k] + at.s[a + k + 1]) / 2;
    return {at.s[a], at.s[b], height, std::abs(height) / std::max(steepest, 1e-3), place};
}

}  // namespace

std::vector<Obstacle> find_obstacles(const WheelPath& path, double lower, double upper) {
    lower = std::max(lower, 0.0), upper = std::min(upper, path.length());
    if (!(lower < upper)) return {};
    const Samples at = sampled(path, lower, upper);
    std::vector<Obstacle> out;
    for (const Stretch rough : rough_stretches(at, {0, at.count() - 1}, kLevel)) {
        std::vector<Stretch> faces = rough_stretches(at, rough, kSlope);
        if (faces.size() < 2) faces = {rough};  // no flight
        for (const Stretch face : faces)
            for (const Stretch run : monotone_runs(at.z, face)) out.push_back(obstacle(path, at, run));
    }
    return out;
}

}  // namespace stairwright
