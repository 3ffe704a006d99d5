#include "stairwright/statics.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <optional>

namespace stairwright {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kParallel = 1e-9;
constexpr double kMostSqueeze = 3.0;  // largest inner force looked at, in weights

// The rays of the friction cones: direction and moment about the origin of each.
struct Rays {
    std::array<double, 2 * kMostContacts> x, z, moment;
    std::size_t count = 0;

    explicit Rays(std::span<const Contact> contacts) {
        assert(contacts.size() <= kMostContacts);
        for (const Contact& c : contacts) {
            for (const double side : {c.friction, -c.friction}) {
                x[count] = c.normal.x + side * c.normal.z;
                z[count] = c.normal.z - side * c.normal.x;
                // Weight acts down at the CoM: force balance sum(f) = (0, 1), moment about the origin
                // sum(x f_z - z f_x) = x_com.
                moment[count] = c.point.x * z[count] - c.point.z * x[count];
                ++count;
            }
        }
    }

    // Whether the weight lies in the zonotope of the rays: every direction normal to a ray is tested.
    bool carry_weight(double limit) const {
        for (std::size_t i = 0; i < count; ++i) {
            for (const double side : {1.0, -1.0}) {
                const double ux = -side * z[i], uz = side * x[i];
                double support = 0.0;
                for (std::size_t j = 0; j < count; ++j) support += std::max(0.0, ux * x[j] + uz * z[j]);
                if (uz > limit * support + kParallel) return false;
            }
        }
        return true;
    }
};

// Factors of the inner force that keep both contact forces inside their cones.
Interval squeeze_range(const std::array<ContactForce, 2>& base, const std::array<ContactForce, 2>& inner, double friction) {
    double low = -kMostSqueeze, high = kMostSqueeze;
    for (int k = 0; k < 2; ++k) {
        for (int m = 0; m < 3; ++m) {
            // m = 0, 2: friction * normal -/+ tangential >= 0; m = 1: normal >= 0
            const double side = 1.0 - m, mu = m != 1 ? friction : 1.0;
            const double a = mu * base[k].normal - side * base[k].tangential;
            const double b = mu * inner[k].normal - side * inner[k].tangential;
            if (b > 1e-12)
                low = std::max(low, -a / b);
            else if (b < -1e-12)
                high = std::min(high, -a / b);
            else if (a < -1e-9)
                return {1.0, -1.0};
        }
    }
    return {low, high};
}

}  // namespace

// With ray strengths between 0 and `limit` the question is a linear programme with two equations. Its dual has two
// variables and is piecewise linear, so its optimum lies where two of the rays' lines cross: all crossings are tried.
Interval com_interval(std::span<const Contact> contacts, double limit) {
    const Rays ray(contacts);
    if (!ray.carry_weight(limit)) return {};
    double low = -kInfinity, high = kInfinity;
    for (std::size_t i = 0; i < ray.count; ++i) {
        for (std::size_t j = i + 1; j < ray.count; ++j) {
            const double det = ray.x[i] * ray.z[j] - ray.z[i] * ray.x[j];
            if (std::abs(det) < kParallel) continue;
            const double yx = (ray.moment[i] * ray.z[j] - ray.moment[j] * ray.z[i]) / det;
            const double yz = (ray.x[i] * ray.moment[j] - ray.x[j] * ray.moment[i]) / det;
            double above = 0.0, below = 0.0;
            for (std::size_t k = 0; k < ray.count; ++k) {
                const double slack = ray.moment[k] - yx * ray.x[k] - yz * ray.z[k];
                (slack > 0.0 ? above : below) += slack;
            }
            high = std::min(high, yz + limit * above);
            low = std::max(low, yz + limit * below);
        }
    }
    if (low > high + 1e-7 || !std::isfinite(low + high)) return {};
    return {std::min(low, high), std::max(low, high)};
}

double com_margin(Interval interval, double com_x) {
    if (interval.empty()) return kNothingHolds;
    return std::max(kNothingHolds, std::min(com_x - interval.lower, interval.upper - com_x));
}

// What a bisection would find, to the last bit, with a quarter of its steps: false position (Illinois) among the same
// 2^24 values, and first the least of them, which holds most poses on level ground.
double friction_needed(std::span<const Contact> contacts, double com_x) {
    std::array<Contact, kMostContacts> tried;
    const auto margin = [&](double friction) {
        std::size_t n = 0;
        for (const Contact& c : contacts) tried[n++] = {c.point, c.normal, friction};
        return com_margin(com_interval({tried.data(), n}), com_x);
    };
    double low = 0.0, high = 1.0, spare = margin(high), lacking = kNothingHolds;
    while (spare < 0.0) {
        low = high, high *= 2.0, lacking = spare, spare = margin(high);
        if (high > 1e3) return kInfinity;
    }
    constexpr std::int64_t parts = 1 << 24;
    const double unit = (high - low) / parts;
    std::int64_t below = 0, enough = parts;
    int side = 0;  // of the last value: 1 where it was enough, -1 where it was not
    for (std::int64_t k = 1; enough - below > 1;) {
        const double found = margin(low + unit * static_cast<double>(k));
        const int now = found >= 0.0 ? 1 : -1;
        if (now > 0)
            enough = k, spare = found, lacking *= side == now ? 0.5 : 1.0;
        else
            below = k, lacking = found, spare *= side == now ? 0.5 : 1.0;
        side = now;
        const double share = -lacking / (spare - lacking), ahead = share * static_cast<double>(enough - below);
        k = lacking <= kNothingHolds || !(share > 0.0) ? (below + enough) / 2 : below + static_cast<std::int64_t>(std::ceil(ahead));
        k = std::min(std::max(k, below + 1), enough - 1);  // nothing is between them in the end
    }
    return low + unit * static_cast<double>(enough);
}

namespace {

// Forces of two contacts that hold a CoM, in weights: base + factor * inner for any factor of a range.
struct TwoForces {
    std::array<ContactForce, 2> base, inner;

    Interval factors(double friction) const { return squeeze_range(base, inner, friction); }
    std::array<ContactForce, 2> gentlest(Interval range) const {
        const double factor = std::min(std::max(0.0, range.lower), range.upper);
        std::array<ContactForce, 2> out;
        for (int k = 0; k < 2; ++k)
            out[k] = {base[k].tangential + factor * inner[k].tangential, base[k].normal + factor * inner[k].normal};
        return out;
    }
};

// Nothing where both contacts are in one place.
std::optional<TwoForces> two_forces(const std::array<Contact, 2>& contacts, double com_x) {
    const Vec2 line = contacts[0].point - contacts[1].point;
    const double gap = norm(line);
    if (gap < 1e-9) return std::nullopt;
    const Vec2 u = {line.x / gap, line.z / gap};
    const double front = (com_x - contacts[1].point.x) / gap;  // across the line of contacts: lever `gap`
    const std::array<double, 2> across = {front, -front + u.x};
    TwoForces out;
    for (int k = 0; k < 2; ++k) {
        const Vec2 n = contacts[k].normal, along = k == 0 ? -u : u;
        const Vec2 f = {-across[k] * u.z + 0.5 * u.z * u.x, across[k] * u.x + 0.5 * u.z * u.z};
        out.base[k] = {cross(f, n), dot(f, n)};
        out.inner[k] = {cross(along, n), dot(along, n)};
    }
    return out;
}

}  // namespace

double least_friction(const std::array<Contact, 2>& contacts, double com_x, double ample, std::array<ContactForce, 2>& forces) {
    const auto two = two_forces(contacts, com_x);
    if (!two || two->factors(1e4).empty()) return kInfinity;
    double low = 0.0, high = 8.0;
    Interval range = two->factors(high);
    while (range.empty()) {
        low = high, high *= 2.0;
        range = two->factors(high);
    }
    for (int k = 0; k < 40 && high - low >= 1e-7; ++k) {
        const double middle = 0.5 * (low + high);
        const Interval tried = two->factors(middle);
        if (tried.empty())
            low = middle;
        else
            high = middle, range = tried;
    }
    if (ample > high) range = two->factors(ample);
    forces = two->gentlest(range);
    return high;
}

bool held_within(const std::array<Contact, 2>& contacts, double com_x, double ample, std::array<ContactForce, 2>& forces) {
    const auto two = two_forces(contacts, com_x);
    if (!two) return false;
    const Interval range = two->factors(ample);
    if (range.empty()) return false;
    forces = two->gentlest(range);
    return true;
}

namespace {

// About +y the moment of a force f at r is r_z f_x - r_x f_z.
double moment(Vec2 r, Vec2 f) { return r.z * f.x - r.x * f.z; }

}  // namespace

LegLevers leg_levers(const Leg& leg, const LegPoints& p) {
    const Vec2 thigh_line = p.knee - p.hip, calf_line = p.wheel - p.knee;
    const Vec2 thigh_com = p.hip + link_turn(leg.thigh, thigh_line) * leg.thigh.com;
    const Vec2 calf_com = p.knee + link_turn(leg.calf, calf_line) * leg.calf.com;
    const auto weight = [](double mass, Vec2 at, Vec2 joint) { return mass * kGravity * (at.x - joint.x); };
    return {p.wheel - p.hip, calf_line,
            weight(leg.thigh.mass, thigh_com, p.hip) + weight(leg.calf.mass, calf_com, p.hip) + weight(leg.wheel.mass, p.wheel, p.hip),
            weight(leg.calf.mass, calf_com, p.knee) + weight(leg.wheel.mass, p.wheel, p.knee)};
}

LegTorques static_torques(const Leg& leg, const LegPoints& p, const Contact& contact, const ContactForce& f) {
    const Vec2 force = world_force(contact, f);
    return static_torques(leg_levers(leg, p), {force, moment(contact.point - p.wheel, force)});
}

}  // namespace stairwright
