#include "stairwright/smoothing/node_margins.hpp"

#include <cmath>

namespace stairwright::smoothing {

namespace {

constexpr double kQueryRadius = 0.3;  // m; larger clearances are not told apart
constexpr double kPinched = 1.6;      // weights; wheels that press harder pinch something between them
// Shares of the friction that forces may take without harm, tried in turn.
constexpr std::array<double, 2> kAmple = {0.75, 0.98};

// A wheel's contacts, and where it touches two faces the bisector of both: it stands for leaning on both, with a cone
// that is narrower than the true one.
struct Faces {
    std::array<Contact, 3> at;
    int count = 0;
};

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

// Forces on both wheel pairs in weights, and the faces that they push on.
struct Support {
    std::array<ContactForce, 2> forces;
    std::array<Contact, 2> faces;
    bool found = false;
};

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
                const double needed = least_friction(faces, com_x, ample, forces);
                const double score = needed <= ample ? forces[0].normal + forces[1].normal : 100.0 + needed;
                if (score >= least - 1e-9) continue;
                least = score;
                out = {forces, faces, true};
            }
        }
    }
    return out;
}

}  // namespace

std::vector<NodeMargins> node_margins(const Terrain& terrain, const WheelPath& path, const RobotModel& robot,
                                      std::span<const Node> nodes, double friction) {
    std::vector<NodeMargins> out(nodes.size());
    const double weight = robot.mass * kGravity;
    std::array<ContactForce, 2> before = {ContactForce{0.0, 0.5 * weight}, ContactForce{0.0, 0.5 * weight}};
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        const auto [s, body] = nodes[k];
        NodeMargins& node = out[k];
        const WheelCentres wheels = {path.centre(s.front), path.centre(s.rear)};
        node.geometry = pose_geometry(terrain, robot, body, wheels, {kQueryRadius, kQueryRadius});
        const double com_x = node.geometry.posture.com.x;
        const std::array<WheelContacts, 2> contacts = {wheel_contacts(path, s.front, friction),
                                                       wheel_contacts(path, s.rear, friction)};
        std::array<Contact, 4> all;
        std::size_t count = 0;
        for (const WheelContacts& wheel : contacts)
            for (const Contact& contact : wheel.span()) all[count++] = contact;
        node.com = com_margin(com_interval({all.data(), count}), com_x);
        node.firm_com = com_margin(pair_interval(path, s, friction), com_x);
        node.friction_needed = friction_needed({all.data(), count}, com_x);

        const Faces front = with_bisector(contacts[kFront], wheels[kFront], path.radius());
        const Faces rear = with_bisector(contacts[kRear], wheels[kRear], path.radius());
        Support support = gentlest_support(front, rear, com_x, friction);
        if (support.found)
            for (ContactForce& f : support.forces) f = {f.tangential * weight, f.normal * weight};
        else
            support = {before, {front.at[0], rear.at[0]}, true};
        node.forces = before = support.forces;
        for (const int pair : {kFront, kRear}) {
            const ContactForce of_one_leg = {0.5 * support.forces[pair].tangential, 0.5 * support.forces[pair].normal};
            node.torques[pair] = static_torques(robot.legs[pair].leg, node.geometry.posture.legs[pair],
                                                support.faces[pair], of_one_leg);
        }
    }
    return out;
}

}  // namespace stairwright::smoothing
