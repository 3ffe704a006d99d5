#include "tipping.hpp"

#include <algorithm>
#include <limits>

namespace stairwright::smoothing {

namespace {

constexpr double kInside = 0.008;  // m inside the end of an interval; there friction holds whatever it holds at all
constexpr double kMostInside = 0.25;  // of the interval

}  // namespace

std::vector<std::array<double, 2>> tipping_heights(const RefineProblem& problem, std::span<const Node> nodes,
                                                   std::span<const NodeIntervals> intervals) {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    std::vector<std::array<double, 2>> out(nodes.size(), {kNever, kNever});
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        const Interval& com = intervals[k].full;
        const WheelPlaces& s = nodes[k].s;
        std::array<WheelContacts, 2> contacts;
        std::array<Faces, 2> faces;
        for (const int pair : {kFront, kRear}) {
            contacts[pair] = wheel_contacts(problem.path, s[pair], problem.friction);
            faces[pair] = with_bisector(contacts[pair], problem.path.centre(s[pair]), problem.path.radius());
        }
        const double inside = std::min(kInside, kMostInside * (com.upper - com.lower));
        const std::array<double, 2> ends = {com.lower + inside, com.upper - inside};
        for (const std::size_t end : {0, 1}) {
            const Support support = gentlest_support(faces[kFront], faces[kRear], ends[end], problem.friction);
            if (!support.found) continue;
            const double front = support.forces[kFront].size(), rear = support.forces[kRear].size();
            if (std::min(front, rear) < kLight * (front + rear)) out[k][end] = contacts[rear > front ? kRear : kFront].at[0].point.z;
        }
    }
    return out;
}

double lean_margin(const RobotModel& robot, double height) {
    const Leg& leg = robot.legs[kFront].leg;
    return kLean * std::max(0.0, height - kLow * (leg.thigh.length + leg.calf.length));
}

}  // namespace stairwright::smoothing
