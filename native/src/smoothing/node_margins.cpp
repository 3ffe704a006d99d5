#include "stairwright/smoothing/node_margins.hpp"

#include "stairwright/gentlest_support.hpp"

namespace stairwright::smoothing {

namespace {

constexpr double kQueryRadius = 0.3;  // m; larger clearances are not told apart
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
