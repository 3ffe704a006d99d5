#include "stairwright/wheel_contacts.hpp"

#include <algorithm>

namespace stairwright {

namespace {

constexpr double kNoticed = 0.05;  // m round its edge that a wheel is by the time it has been noticed
constexpr double kLeastNoticed = 0.35 * kNoticed;

// What a wheel between two faces leans on.
enum Lean { kFirstFace = 0, kSecondFace = 1, kBothFaces = 2 };

// Contacts of both wheel pairs that are counted together.
struct Counted {
    std::array<Contact, 4> at;
    std::size_t count = 0;

    void add(const Contact& contact) { at[count++] = contact; }
    void add_all(const WheelContacts& wheel) {
        for (const Contact& contact : wheel.span()) add(contact);
    }
    std::span<const Contact> span() const { return {at.data(), count}; }
};

// Friction is on the face that the wheel leans on; leaning on both it takes none.
void add_leaning(Counted& out, const WheelContacts& wheel, int lean) {
    for (std::size_t k = 0; k < wheel.count; ++k) {
        if (lean != kBothFaces && lean != static_cast<int>(k)) continue;
        Contact contact = wheel.at[k];
        if (lean == kBothFaces) contact.friction = 0.0;
        out.add(contact);
    }
}

int leans(const WheelContacts& wheel) { return wheel.count == 1 ? 1 : 3; }

// Whether the face tilts from `s` to `other`, both between the same two corners.
bool tilts(const WheelPath& path, double s, double other) {
    if (path.corner_from(std::min(s, other) - kTouch) != path.corner_from(std::max(s, other) + kTouch)) return false;
    return dot(path.normal(s), path.normal(other)) < 1.0 - 1e-6;
}

enum Timing { kInTime = 0, kLate = 1, kLittleLate = 2, kAhead = 3 };

// The contact of a wheel at `s` on a face that is turned as at `other`: the direction decides.
void add_turned(Counted& out, const WheelPath& path, double s, double other, double friction) {
    const Vec2 normal = path.normal(other);
    out.add({path.centre(s) - path.radius() * normal, normal, friction});
}

// Contacts of a wheel that is not where it was planned.
void add_strayed(Counted& out, const WheelPath& path, double s, double friction, int timing, double lag) {
    if (timing == kInTime) {
        out.add_all(wheel_contacts(path, s, friction));
        return;
    }
    double other = timing == kLate ? s - lag : s - 0.3 * lag;
    if (timing == kAhead) {
        other = s + kStray;
        const std::size_t k = path.corner_from(s);
        if (k < path.corners().size() && path.corners()[k] < other) other = s;
    }
    add_turned(out, path, s, other, friction);
}

// Where on its edge a wheel at `s` may be if a drop ahead comes kEarlyDrop before it is planned, and is noticed `noticed`
// round the edge; `s` if there is none.
double early_place(const WheelPath& path, double s, double noticed) {
    const auto drop = path.next_drop(s);
    return drop ? std::max(s, std::min(s + kEarlyDrop, *drop + noticed)) : s;
}

}  // namespace

WheelContacts wheel_contacts(const WheelPath& path, double s, double friction) {
    const std::vector<double>& corners = path.corners();
    const std::size_t k = path.corner_from(s), none = corners.size();
    std::size_t near = none;
    if (k < corners.size() && corners[k] - s <= kTouch) near = k;
    if (k > 0 && s - corners[k - 1] <= kTouch && (near == none || s - corners[k - 1] < corners[k] - s)) near = k - 1;
    const double r = path.radius();
    if (near == none) {
        const CurvePoint p = path.at(s);
        return {{Contact{p.centre - r * p.normal, p.normal, friction}}, 1};
    }
    WheelContacts out{{}, 2};
    for (int m = 0; m < 2; ++m) {
        const CurvePoint p = path.at(corners[near] + (m == 0 ? -1e-7 : 1e-7));
        out.at[m] = {p.centre - r * p.normal, p.normal, friction};
    }
    return out;
}

Interval pair_interval(const WheelPath& path, WheelPlaces s, double friction, double ray_limit, const std::array<Vec2, 2>& off) {
    WheelContacts front = wheel_contacts(path, s.front, friction), rear = wheel_contacts(path, s.rear, friction);
    for (Contact& contact : front.at) contact.point += off[kFront];
    for (Contact& contact : rear.at) contact.point += off[kRear];
    Interval out;
    for (int i = 0; i < leans(front); ++i) {
        for (int j = 0; j < leans(rear); ++j) {
            Counted counted;
            add_leaning(counted, front, i);
            add_leaning(counted, rear, j);
            out = out.join(com_interval(counted.span(), ray_limit));
        }
    }
    return out;
}

Interval stated_interval(const WheelPath& path, WheelPlaces s, double friction) {
    Counted counted;
    for (const double at : {s.front, s.rear}) counted.add_all(wheel_contacts(path, at, friction));
    return com_interval(counted.span());
}

Interval strayed_interval(const WheelPath& path, WheelPlaces s, double friction, double stray, double ray_limit) {
    Interval out = pair_interval(path, s, friction, ray_limit);
    for (const int pair : {kFront, kRear}) {
        for (const double by : {stray, -stray}) {
            if (out.empty() || !tilts(path, s[pair], s[pair] + by)) continue;
            WheelPlaces other = s;
            (pair == kFront ? other.front : other.rear) += by;
            out = out.intersect(pair_interval(path, other, friction, ray_limit));
        }
    }
    return out;
}

Interval steady_interval(const WheelPath& path, WheelPlaces s, double friction) {
    return strayed_interval(path, s, friction, kStray, kGentleRays);
}

namespace {

// What is left of `in_time` where a pair is over a drop before it is planned (of the drops that leave anything, the
// farthest round), or still on the tread before a drop that it is to be round.
Interval other_drop_interval(const WheelPath& path, WheelPlaces s, double friction, const Interval& in_time, bool surely) {
    Interval out = in_time;
    for (const int pair : {kFront, kRear}) {
        const auto turned = [&](double other) {
            Counted counted;
            add_turned(counted, path, s[pair], other, friction);
            counted.add_all(wheel_contacts(path, s[pair == kFront ? kRear : kFront], friction));
            return out.intersect(com_interval(counted.span(), kGentleRays));
        };
        for (const double noticed : {kNoticed, 0.7 * kNoticed, kLeastNoticed}) {
            const double other = early_place(path, s[pair], noticed);
            if (other == s[pair]) break;
            const Interval both = turned(other);
            if (both.empty() && !(surely && noticed == kLeastNoticed)) continue;
            out = both;
            break;
        }
        const auto drop = path.next_drop(s[pair]);
        if (!drop || *drop > s[pair]) continue;
        const Interval both = turned(*drop);
        if (!both.empty() || surely) out = both;
    }
    return out;
}

}  // namespace

Interval lagged_interval(const WheelPath& path, WheelPlaces s, double friction, double lag, bool surely) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Interval out{-infinity, infinity};
    for (int a = kInTime; a <= kAhead; ++a) {
        for (int b = kInTime; b <= kAhead; ++b) {
            if (std::max(a, b) == kAhead && a + b > kAhead) continue;  // ahead while the other is not in time: too much to ask
            Counted counted;
            add_strayed(counted, path, s.front, friction, a, lag);
            add_strayed(counted, path, s.rear, friction, b, lag);
            out = out.intersect(com_interval(counted.span(), kGentleRays));
            if (out.empty()) return out;
        }
    }
    return other_drop_interval(path, s, friction, out, surely);
}

NodeIntervals node_intervals(const WheelPath& path, WheelPlaces s, double friction, double reserve, double lag) {
    NodeIntervals out;
    out.full = pair_interval(path, s, friction);
    if (out.full.empty()) {
        const double middle = 0.5 * (path.centre(s.front).x + path.centre(s.rear).x);
        out.full = {middle + 0.05, middle - 0.05};
    }
    out.reserve = pair_interval(path, s, reserve, kGentleRays);
    if (out.reserve.empty()) out.reserve = out.full;
    out.lagged = lagged_interval(path, s, friction, lag);
    if (out.lagged.empty()) out.lagged = lagged_interval(path, s, friction, 0.3 * lag);
    if (out.lagged.empty()) out.lagged = out.reserve;
    return out;
}

}  // namespace stairwright
