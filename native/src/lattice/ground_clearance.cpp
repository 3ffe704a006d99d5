#include "stairwright/lattice/ground_clearance.hpp"

#include <algorithm>
#include <cmath>

#include "stairwright/simd.hpp"

namespace stairwright::lattice {

namespace {

// A face and the link in single precision, as the inner loop wants them.
struct LinkAgainstFace {
    float cx, cz;              // from the link's begin to the face's, for a wheel at the origin
    float ex, ez, over_face;   // the face's vector, 1 / its squared length
    float lx, lz, over_link;   // the link's
};

STAIRWRIGHT_VECTOR_CLONES
void lower_by_face(const LinkAgainstFace& f, const float* x, const float* z, int count, float* best) {
    const float turn = f.lx * f.ez - f.lz * f.ex, along = f.lx * f.ex + f.lz * f.ez;
    const auto within = [](float t) { return std::min(1.0F, std::max(0.0F, t)); };
    for (int i = 0; i < count; ++i) {
        // From the link's begin to the face's; s, g: on which side of link and of face.
        const float rx = f.cx - x[i], rz = f.cz - z[i];
        const float re = rx * f.ex + rz * f.ez, rl = rx * f.lx + rz * f.lz;
        const float s = f.lx * rz - f.lz * rx, g = f.ez * rx - f.ex * rz;
        float t = within(-re * f.over_face);
        float px = rx + t * f.ex, pz = rz + t * f.ez;
        float gap = px * px + pz * pz;
        t = within((along - re) * f.over_face);
        px = rx + t * f.ex - f.lx, pz = rz + t * f.ez - f.lz;
        gap = std::min(gap, px * px + pz * pz);
        t = within(rl * f.over_link);
        px = rx - t * f.lx, pz = rz - t * f.lz;
        gap = std::min(gap, px * px + pz * pz);
        t = within((rl + along) * f.over_link);
        px = rx + f.ex - t * f.lx, pz = rz + f.ez - t * f.lz;
        gap = std::min(gap, px * px + pz * pz);
        const bool crosses = (s * (s + turn) < 0.0F) & (g * (g - turn) < 0.0F);
        const bool under = (rx <= 0.0F) & (rx + f.ex >= 0.0F) & (g < 0.0F) & (f.ex > 0.0F);
        gap = crosses | under ? kBuried : gap;
        best[i] = std::min(best[i], gap);
    }
}

constexpr float kInGround = -1e9F;  // clearance, until it is measured

float as_float(double x) { return static_cast<float>(x); }

}  // namespace

GroundNearWheels::GroundNearWheels(const Terrain& terrain, const std::vector<Vec2>& centres, double reach) {
    const Vec2 origin = centres.front();
    std::vector<double> x;
    for (const Vec2 c : centres) {
        x.push_back(c.x);
        x_.push_back(as_float(c.x - origin.x));
        z_.push_back(as_float(c.z - origin.z));
    }
    const std::vector<Vec2>& p = terrain.vertices();
    for (std::size_t k = 0; k + 1 < p.size(); ++k) {
        if (p[k + 1].x < x.front() - reach || p[k].x > x.back() + reach) continue;
        const auto first = std::lower_bound(x.begin(), x.end(), p[k].x - reach);
        const auto last = std::upper_bound(x.begin(), x.end(), p[k + 1].x + reach);
        if (first >= last) continue;
        const int a = static_cast<int>(first - x.begin()), b = static_cast<int>(last - x.begin());
        double lowest = centres[a].z;
        for (int i = a; i < b; ++i) lowest = std::min(lowest, centres[i].z);
        const Vec2 e = p[k + 1] - p[k];
        faces_.push_back({as_float(p[k].x - origin.x), as_float(p[k].z - origin.z), as_float(e.x), as_float(e.z),
                          as_float(std::max(p[k].z, p[k + 1].z) - lowest), as_float(1.0 / std::max(dot(e, e), 1e-18)), a, b});
    }
}

void GroundNearWheels::lower(Vec2 begin, Vec2 line, double query, std::span<float> best) const {
    const float ax = as_float(begin.x), az = as_float(begin.z), lx = as_float(line.x), lz = as_float(line.z);
    const float reach = as_float(query);
    const float over_link = 1.0F / std::max(lx * lx + lz * lz, 1e-18F);
    const float low = std::min(0.0F, lx) + ax - reach, high = std::max(0.0F, lx) + ax + reach;
    const float bottom = az + std::min(0.0F, lz) - reach;
    for (const Face& face : faces_) {
        if (face.top < bottom) continue;
        int a = face.first, b = face.last;
        const float first = face.x - high, last = face.x + face.dx - low;
        while (a < b && x_[a] < first) ++a;
        while (b > a && x_[b - 1] > last) --b;
        const LinkAgainstFace f = {face.x - ax, face.z - az, face.dx, face.dz, face.inverse_square, lx, lz, over_link};
        lower_by_face(f, x_.data() + a, z_.data() + a, b - a, best.data() + a);
    }
}

void leg_clearances(const Terrain& terrain, const GroundNearWheels& ground, const Leg& leg, const MovingLeg& moving,
                    const std::vector<Vec2>& centres, double query_radius, double least, std::span<float> out) {
    thread_local std::vector<float> squared;
    squared.resize(out.size());
    std::fill(out.begin(), out.end(), as_float(query_radius));
    double thinnest = query_radius;
    const auto visit = [&](const Link& link, Vec2 joint, Vec2 line) {
        const Turn turn = link_turn(link, line);
        for (const Capsule& c : link.shape) {
            const Vec2 a = joint + turn * c.a, b = joint + turn * c.b;
            const double reach = query_radius + c.radius;
            std::fill(squared.begin(), squared.end(), as_float(reach * reach));
            ground.lower(a, b - a, reach, squared);
            thinnest = std::min(thinnest, c.radius);
            for (std::size_t i = 0; i < out.size(); ++i)
                out[i] = std::min(out[i], squared[i] < 0.0F ? kInGround : as_float(std::sqrt(squared[i]) - c.radius));
        }
    };
    visit(leg.thigh, moving.hip, moving.knee - moving.hip);
    visit(leg.calf, moving.knee, -moving.knee);
    const double deepest = -thinnest;  // no link in the ground has more clearance
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (out[i] > kInGround) continue;
        out[i] = as_float(deepest);
        if (deepest < least) continue;
        const Vec2 wheel = centres[i];
        double exact = query_radius;
        const auto measure = [&](const Link& link, Vec2 joint, Vec2 line) {
            const Turn turn = link_turn(link, line);
            for (const Capsule& c : link.shape)
                exact = std::min(exact, terrain.link_clearance(joint + turn * c.a, joint + turn * c.b, c.radius, query_radius));
        };
        measure(leg.thigh, wheel + moving.hip, moving.knee - moving.hip);
        measure(leg.calf, wheel + moving.knee, -moving.knee);
        out[i] = as_float(exact);
    }
}

}  // namespace stairwright::lattice
