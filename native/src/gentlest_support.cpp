#include "stairwright/gentlest_support.hpp"

#include <algorithm>
#include <cmath>

#include "stairwright/whole.hpp"

namespace stairwright {

namespace {

constexpr double kPinched = 1.6;      // weights; wheels that press harder pinch something between them
constexpr double kNotHeld = 100.0;    // weights; more than any forces that hold the robot
// Shares of the friction that forces may take without harm, tried in turn.
constexpr std::array<double, 4> kAmple = {0.75, 0.82, 0.9, 0.98};

WheelLoad load_on_one(const Contact& contact, const ContactForce& f, Vec2 centre, double weight) {
    const Vec2 force = 0.5 * weight * world_force(contact, f), r = contact.point - centre;
    return {force, r.z * force.x - r.x * force.z};
}

}  // namespace

Faces with_bisector(const WheelContacts& contacts, Vec2 centre, double radius) {
    Faces out;
    for (const Contact& contact : contacts.span()) out.at[out.count++] = contact;
    if (out.count < 2) return out;
    const Vec2 sum = out.at[0].normal + out.at[1].normal;
    const double length = norm(sum);
    if (length < 0.2) return out;  // opposite walls: no direction between them
    const Vec2 normal = {sum.x / length, sum.z / length};
    out.at[out.count++] = {centre - radius * normal, normal, contacts.at[0].friction};
    return out;
}

// The gentlest pair of faces that holds the robot.
Support gentlest_support(const Faces& front, const Faces& rear, double com_x, double friction) {
    Support out;
    double least = std::numeric_limits<double>::infinity();
    for (const double share : kAmple) {
        // Wheels that pinch a curb between them press hard at low friction: use more of it.
        if (share != kAmple.front() && least < kPinched) break;
        const double ample = share * friction;
        for (int i = front.count - 1; i >= 0; --i) {
            for (int j = rear.count - 1; j >= 0; --j) {
                std::array<ContactForce, 2> forces;
                const std::array<Contact, 2> faces = {front.at[i], rear.at[j]};
                const bool holds = held_within(faces, com_x, ample, forces);
                if (!holds && least < kNotHeld) continue;
                const double score = holds ? forces[0].normal + forces[1].normal : kNotHeld + least_friction(faces, com_x, ample, forces);
                if (score >= least - 1e-9) continue;
                least = score;
                out = {forces, faces, true};
            }
        }
    }
    return out;
}

Support resting_support(const Faces& front, const Faces& rear, double com_x, double friction) {
    Support out;
    double least = std::numeric_limits<double>::infinity();
    for (const double share : kAmple) {
        const double ample = share * friction;
        for (int i = 0; i < std::min(front.count, 2); ++i) {
            for (int j = 0; j < std::min(rear.count, 2); ++j) {
                std::array<ContactForce, 2> forces;
                const std::array<Contact, 2> faces = {front.at[i], rear.at[j]};
                if (!held_within(faces, com_x, ample, forces)) continue;
                double size = 0.0;
                for (const ContactForce& f : forces) size += f.tangential * f.tangential + f.normal * f.normal;
                if (size >= least - 1e-9) continue;
                least = size;
                out = {forces, faces, true};
            }
        }
        if (out.found) return out;
    }
    return gentlest_support(front, rear, com_x, friction);
}

Touches touches(const WheelPath& path, WheelPlaces s, double friction, double lag) {
    Touches out;
    std::array<Faces, 2> in_time;
    for (const int pair : {kFront, kRear})
        in_time[pair] = with_bisector(wheel_contacts(path, s[pair], friction), path.centre(s[pair]), path.radius());
    out.ways[out.count++] = in_time;
    for (const int pair : {kFront, kRear}) {
        const std::size_t k = path.corner_from(s[pair]);
        if (k == 0 || s[pair] - path.corners()[k - 1] > lag || in_time[pair].count > 1) continue;
        const Vec2 centre = path.centre(s[pair]), normal = path.normal(path.corners()[k - 1] - 1e-7);
        out.ways[out.count] = in_time;
        out.ways[out.count][pair] = {{Contact{centre - path.radius() * normal, normal, friction}}, 1};
        ++out.count;
    }
    return out;
}

WheelLoads::WheelLoads(const WheelPath& path, WheelPlaces s, double friction, double lag, Interval com, double weight)
    : first_(com.lower), step_((com.upper - com.lower) / (kSamples - 1)), friction_(friction), weight_(weight),
      centres_{path.centre(s.front), path.centre(s.rear)}, touches_(touches(path, s, friction, lag)) {}

void WheelLoads::make(int way, int first, int last) const {
    for (int k = first; k <= last; ++k) {
        const std::uint32_t bit = std::uint32_t{1} << k;
        if (made_[way] & bit) continue;
        made_[way] |= bit;
        const std::array<Faces, 2>& faces = touches_.ways[way];
        const Support support = resting_support(faces[kFront], faces[kRear], first_ + k * step_, friction_);
        Samples& samples = samples_[way];
        samples.held[k] = support.found ? 1.0 : 0.0;
        for (const int pair : {kFront, kRear}) {
            const WheelLoad load = support.found ? load_on_one(support.faces[pair], support.forces[pair], centres_[pair], weight_) : WheelLoad{};
            samples.values[3 * pair][k] = load.force.x;
            samples.values[3 * pair + 1][k] = load.force.z;
            samples.values[3 * pair + 2][k] = load.moment;
        }
    }
}

const WheelLoads::Samples& WheelLoads::samples(int way, double low, double high) const {
    const auto sample = [&](double com_x) { return std::min(static_cast<int>(whole_part(place(com_x))), kSamples - 2); };
    make(way, sample(low), sample(high) + 1);
    return samples_[way];
}

std::optional<std::array<WheelLoad, 2>> WheelLoads::at(int way, double com_x) const {
    const double u = place(com_x);
    const int k = std::min(static_cast<int>(whole_part(u)), kSamples - 2);
    make(way, k, k + 1);
    const double share = u - k;
    const Samples& samples = samples_[way];
    if (samples.held[k] == 0.0 || samples.held[k + 1] == 0.0) return std::nullopt;
    const auto value = [&](int n) { return samples.values[n][k] + share * (samples.values[n][k + 1] - samples.values[n][k]); };
    std::array<WheelLoad, 2> out;
    for (const int pair : {kFront, kRear}) out[pair] = {{value(3 * pair), value(3 * pair + 1)}, value(3 * pair + 2)};
    return out;
}

}  // namespace stairwright
