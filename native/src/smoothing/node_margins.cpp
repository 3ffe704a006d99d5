#include "stairwright/smoothing/node_margins.hpp"

#include "stairwright/gentlest_support.hpp"

namespace stairwright::smoothing {

namespace {

constexpr double kQueryRadius = 0.3;  // m; larger clearances are not told apart

double larger(double a, double b) { return std::abs(b) > std::abs(a) ? b : a; }

// Largest static torques of both legs of all ways of touching the ground that hold the robot; of `otherwise` if none does.
std::array<LegTorques, 2> worst_torques(const RobotModel& robot, const Posture& posture, const Touches& touches, double friction,
                                        double weight, const Support& otherwise) {
    std::array<LegTorques, 2> out;
    bool any = false;
    const auto count = [&](const Support& support, double unit) {
        for (const int pair : {kFront, kRear}) {
            const ContactForce f = {0.5 * unit * support.forces[pair].tangential, 0.5 * unit * support.forces[pair].normal};
            const LegTorques t = static_torques(robot.legs[pair].leg, posture.legs[pair], support.faces[pair], f);
            out[pair] = {larger(out[pair].thigh, t.thigh), larger(out[pair].calf, t.calf), larger(out[pair].wheel, t.wheel)};
        }
        any = true;
    };
    for (int way = 0; way < touches.count; ++way) {
        const Support support = resting_support(touches.ways[way][kFront], touches.ways[way][kRear], posture.com.x, friction);
        if (support.found) count(support, weight);
    }
    if (!any) count(otherwise, 1.0);
    return out;
}

}  // namespace

std::vector<NodeMargins> node_margins(const Terrain& terrain, const WheelPath& path, const RobotModel& robot,
                                      std::span<const Node> nodes, double friction, double lag) {
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
        node.strayed_com = com_margin(strayed_interval(path, s, friction, kLeastStray), com_x);
        node.friction_needed = friction_needed({all.data(), count}, com_x);

        const Faces front = with_bisector(contacts[kFront], wheels[kFront], path.radius());
        const Faces rear = with_bisector(contacts[kRear], wheels[kRear], path.radius());
        Support support = gentlest_support(front, rear, com_x, friction);
        if (support.found)
            for (ContactForce& f : support.forces) f = {f.tangential * weight, f.normal * weight};
        else
            support = {before, {front.at[0], rear.at[0]}, true};
        node.forces = before = support.forces;
        const int carrying = support.forces[kRear].size() > support.forces[kFront].size() ? kRear : kFront;
        node.com_height = node.geometry.posture.com.z - contacts[carrying].at[0].point.z;
        node.torques = worst_torques(robot, node.geometry.posture, touches(path, s, friction, lag), friction, weight, support);
    }
    return out;
}

}  // namespace stairwright::smoothing
