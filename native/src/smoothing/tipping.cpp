#include "tipping.hpp"

#include <algorithm>
#include <limits>

namespace stairwright::smoothing {

namespace {

constexpr double kInside = 0.008;  // m inside the end of an interval; there friction holds whatever it holds at all
constexpr double kMostInside = 0.25;  // of the interval
constexpr double kNever = std::numeric_limits<double>::infinity();

}  // namespace

std::vector<TippingBounds> tipping_bounds(const RefineProblem& problem, std::span<const Node> nodes,
                                          std::span<const NodeIntervals> intervals) {
    std::vector<TippingBounds> out(nodes.size());
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        const Interval& com = intervals[k].full;
        const WheelPlaces& s = nodes[k].s;
        const Interval strayed = strayed_interval(problem.path, s, problem.friction, kLeastStray);
        out[k] = {{strayed.lower - com.lower, com.upper - strayed.upper}, {kNever, kNever}};
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
            if (std::min(front, rear) < kLight * (front + rear))
                out[k].heights[end] = contacts[rear > front ? kRear : kFront].at[0].point.z;
        }
    }
    return out;
}

std::array<double, 2> least_com_margins(const RobotModel& robot, const TippingBounds& bounds, double com_z) {
    const Leg& leg = robot.legs[kFront].leg;
    const double low = kLow * (leg.thigh.length + leg.calf.length);
    std::array<double, 2> out = bounds.strayed;
    for (const std::size_t end : {0, 1}) {
        out[end] = std::max(out[end], kLean * (com_z - bounds.heights[end] - low));
        if (out[end] > 0.0) out[end] += kSpare;
    }
    return out;
}

}  // namespace stairwright::smoothing
