#include "stairwright/clearance.hpp"

#include <algorithm>
#include <cmath>

#include "stairwright/whole.hpp"

namespace stairwright {

namespace {

constexpr double kRaster = 1e-3;  // m

class Search {
  public:
    explicit Search(const Terrain& terrain) : terrain_(terrain) {}

    void capsule(Vec2 a, Vec2 b, double radius) {
        const std::vector<Vec2>& p = terrain_.vertices();
        double apart = kFar;
        Vec2 near = a;
        const double right = std::max(a.x, b.x) + kFar;
        for (std::size_t i = terrain_.first_segment(std::min(a.x, b.x) - kFar); i + 1 < p.size() && p[i].x <= right; ++i) {
            const double gap = segment_distance(a, b, p[i], p[i + 1]);
            if (gap < apart) apart = gap, near = p[i];
        }
        if (apart > 0.0 && a.z >= terrain_.height(a.x)) {
            keep(apart - radius, near);
            return;
        }
        const auto steps = static_cast<int>(std::max<std::size_t>(1, whole_part(norm(b - a) / kRaster)));
        for (int i = 0; i <= steps; ++i) {
            const Vec2 at = {a.x + (b.x - a.x) * i / steps, a.z + (b.z - a.z) * i / steps};
            if (at.z <= terrain_.height(at.x)) keep(-terrain_.distance(at, kFar) - radius, at);
        }
    }

    // A corner of the ground inside the polygon may be deeper than any of its sides.
    void corners_inside(const std::vector<Vec2>& polygon) {
        for (const Vec2 corner : terrain_.vertices()) {
            double deep = kFar;
            for (std::size_t k = 0; k < polygon.size() && deep > 0.0; ++k) {
                const Vec2 a = polygon[k], side = polygon[(k + 1) % polygon.size()] - a;
                deep = std::min(deep, cross(side, corner - a) / norm(side));
            }
            if (deep > 0.0) keep(-deep, corner);
        }
    }

    Clearance least() const { return least_; }

  private:
    void keep(double distance, Vec2 at) {
        if (distance < least_.distance) least_ = {distance, at};
    }

    const Terrain& terrain_;
    Clearance least_{kFar, {}};
};

}  // namespace

Clearance least_clearance(const Terrain& terrain, const Robot& robot, const Body& body, const std::array<LegPoints, 2>& legs) {
    Search search(terrain);
    const Vec2 origin = {body.x, body.z};
    const Turn pitch = Turn::by(body.pitch);
    for (const Polygon& polygon : robot.trunk.outline) {
        std::vector<Vec2> corners;
        for (const Vec2 corner : polygon.corners()) corners.push_back(origin + pitch * corner);
        for (std::size_t k = 0; k < corners.size(); ++k) search.capsule(corners[k], corners[(k + 1) % corners.size()], 0.0);
        search.corners_inside(corners);
    }
    for (int k = 0; k < 2; ++k) {
        const Leg& leg = robot.legs[k];
        const auto& [hip, knee, wheel] = legs[k];
        const Turn thigh = link_turn(leg.thigh, knee - hip), calf = link_turn(leg.calf, wheel - knee);
        for (const Capsule& c : leg.thigh.shape) search.capsule(hip + thigh * c.a, hip + thigh * c.b, c.radius);
        for (const Capsule& c : leg.calf.shape) search.capsule(knee + calf * c.a, knee + calf * c.b, c.radius);
    }
    return search.least();
}

}  // namespace stairwright
