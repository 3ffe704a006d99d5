#include "stairwright/poses/footing.hpp"

#include <algorithm>
#include <cmath>

#include "stairwright/wheel_contacts.hpp"
#include "stairwright/whole.hpp"

namespace stairwright::poses {

namespace {

constexpr double kSettle = 0.10;  // m that a resting rear wheel is past steep ground, for legs of 0.4 m
constexpr double kGrip = 0.9;     // of the friction angle: steeper ground does not hold a resting wheel alone
constexpr double kAhead = 3.0, kStride = 0.005;  // m that steep ground is looked for ahead, and how finely
constexpr int kSettleSamples = 5, kGroundSamples = 15;

// Angle of the ground's normal from the vertical [rad].
double slope(const WheelPath& path, double s) {
    const Vec2 n = path.normal(s);
    return std::abs(std::atan2(n.x, n.z));
}

}  // namespace

bool rests(const WheelPath& path, double s, double friction, double scale) {
    const double most = kGrip * std::atan(friction);
    for (int k = 0; k < kSettleSamples; ++k)
        if (slope(path, std::max(0.0, s - 0.25 * k * kSettle * scale)) > most) return false;
    return true;
}

double steep_ahead(const WheelPath& path, double s, double friction, double scale) {
    const double most = kGrip * std::atan(friction);
    for (int k = 0; k < static_cast<int>(whole_part(kAhead * scale / kStride)); ++k)
        if (slope(path, s + k * kStride) > most) return s + k * kStride;
    return std::numeric_limits<double>::infinity();
}

double mean_height(const Terrain& terrain, double lower, double upper) {
    const double first = terrain.vertices().front().x, last = terrain.vertices().back().x;
    double total = 0.0;
    for (int k = 0; k < kGroundSamples; ++k) {
        const double x = lower + (upper - lower) * k / (kGroundSamples - 1);
        total += terrain.height(std::min(std::max(x, first), last));
    }
    return total / kGroundSamples;
}

std::vector<double> rear_places(const WheelPath& path, const RearSearch& query) {
    const double lower = std::max(query.rear.lower, query.front - 1.2 * query.distance.upper);
    const double upper = std::min(query.rear.upper, query.front);
    if (upper < lower) return {};
    struct Place {
        double s, off;
    };
    std::vector<Place> found;
    const auto count = static_cast<int>(whole_part((upper - lower) / query.step) + 1);
    const Vec2 front = path.centre(query.front);
    for (int k = 0; k < count; ++k) {
        const double s = lower + (upper - lower) * k / std::max(1, count - 1);
        const Vec2 apart = path.centre(s) - front;
        const double distance = std::hypot(apart.x, apart.z);
        if (query.distance.slack(distance) < 0.0) continue;
        if (query.resting && !rests(path, s, query.friction, query.scale)) continue;
        if (stated_interval(path, {query.face, s}, query.friction).empty()) continue;
        found.push_back({s, std::abs(distance - query.usual_distance)});
    }
    std::stable_sort(found.begin(), found.end(), [](const Place& a, const Place& b) { return a.off < b.off; });
    std::vector<double> out;
    for (const Place& place : found) out.push_back(place.s);
    return out;
}

}  // namespace stairwright::poses
