#include "stairwright/poses/pose_model.hpp"

#include <algorithm>

namespace stairwright::poses {

namespace {

constexpr double kStraight = 1e-6;  // m; nearer to a straight or a folded leg nothing is differentiated

Vec2 across(Vec2 v) { return {v.z, -v.x}; }  // dv / d(angle)

double thickest(const Link& link) {
    double radius = 0.0;
    for (const Capsule& c : link.shape) radius = std::max(radius, c.radius);
    return radius;
}

// Vectors of a leg in the world: hip from the trunk's point, thigh and calf from joint to joint.
struct LegVectors {
    Vec2 hip, thigh, calf;
};

void place_points(const PoseModel& model, const std::array<LegVectors, 2>& legs, PoseState& st) {
    const Vec2 origin = {st.y[0], st.y[1]};
    for (std::size_t k = 0; k < model.points.size(); ++k) {
        const auto [frame, at] = model.points[k];
        PosePoint& p = st.points[k];
        const Vec2 own = st.turns[frame] * at;
        if (frame == 0) {
            p.at = origin + own, p.arms[0] = own;
            continue;
        }
        const int leg = (frame - 1) / 2;
        const bool calf = frame % 2 == 0;
        p.arms[0] = legs[leg].hip;
        p.arms[frame] = own;
        if (calf) p.arms[frame - 1] = legs[leg].thigh;
        p.at = origin + legs[leg].hip + own + (calf ? legs[leg].thigh : Vec2{});
    }
}

void place_com(const PoseModel& model, const std::array<LegVectors, 2>& legs, PoseState& st) {
    const Robot& robot = model.robot.robot;
    const double over = 1.0 / model.robot.mass;
    PosePoint& com = st.com;
    com.arms = {};
    com.arms[0] = robot.trunk.mass * over * (st.turns[0] * robot.trunk.com);
    for (int k = 0; k < 2; ++k) {
        const Leg& leg = robot.legs[k];
        const int thigh = 1 + 2 * k, calf = thigh + 1;
        com.arms[0] += leg.pair_mass() * over * legs[k].hip;
        com.arms[thigh] = 2.0 * over * (leg.thigh.mass * (st.turns[thigh] * leg.thigh.com) +
                                        (leg.calf.mass + leg.wheel.mass) * legs[k].thigh);
        com.arms[calf] = 2.0 * over * (leg.calf.mass * (st.turns[calf] * leg.calf.com) + leg.wheel.mass * legs[k].calf);
    }
    com.at = {st.y[0], st.y[1]};
    for (const Vec2 arm : com.arms) com.at += arm;
}

// Link angles of a leg as the unknowns change: the wheel stays on the curve.
void differentiate_leg(const LegVectors& leg, int k, PoseState& st) {
    const Vec2 a = across(leg.thigh), b = across(leg.calf);
    const double det = cross(a, b);
    for (int j = 0; j < kUnknowns; ++j) {
        Vec2 r;  // what the two links together must make up for
        if (j == 0) r = {-1.0, 0.0};
        if (j == 1) r = {0.0, -1.0};
        if (j == 2) r = -across(leg.hip);
        if (j == 3 + k) r = st.tangent[k];
        st.link_turns[2 * k][j] = cross(r, b) / det;
        st.link_turns[2 * k + 1][j] = cross(a, r) / det;
    }
}

}  // namespace

Unknowns unknowns_of(const Variables& x) { return {x[0], x[1], x[2], x[7], x[8]}; }

Variables PoseState::variables() const { return {y[0], y[1], y[2], q[0], q[1], q[2], q[3], y[3], y[4]}; }

PoseModel::PoseModel(const Robot& given, const CollisionPoints& collision) : robot(given) {
    for (const Polygon& polygon : given.trunk.outline) {
        const std::vector<Vec2>& corners = polygon.corners();
        TrunkShape shape{static_cast<int>(points.size()), static_cast<int>(corners.size()), {}};
        for (std::size_t k = 0; k < corners.size(); ++k) {
            const Vec2 edge = corners[(k + 1) % corners.size()] - corners[k];
            shape.normals.push_back((1.0 / norm(edge)) * across(edge));
            add(0, corners[k]);
        }
        trunk.push_back(std::move(shape));
    }
    for (int k = 0; k < 2; ++k) {
        const Leg& leg = robot.legs[k].leg;
        const int thigh = 1 + 2 * k, calf = thigh + 1;
        hip[k] = add(0, leg.hip), knee[k] = add(thigh, leg.thigh.end), wheel[k] = add(calf, leg.calf.end);
        nodes[k] = {{wheel[k], leg.wheel.radius}, {knee[k], thickest(leg.thigh)}};
        for (const int frame : {thigh, calf}) {
            const Link& link = frame == thigh ? leg.thigh : leg.calf;
            for (const Capsule& c : link.shape) {
                const Vec2 along = c.b - c.a;
                const double length = norm(along);
                if (length < 1e-9) continue;
                const bool from_joint = norm(c.a) < 1e-9, to_joint = norm(c.b - link.end) < 1e-9;
                const int upper = frame == thigh ? hip[k] : knee[k], lower = frame == thigh ? knee[k] : wheel[k];
                const int a = from_joint ? upper : add(frame, c.a), b = to_joint ? lower : add(frame, c.b);
                links[k].push_back({a, b, frame, (1.0 / length) * across(along), c.radius, length});
                if (!to_joint) nodes[k].push_back({b, c.radius});
            }
        }
        const JointAngles q = joint_angles(leg, 0.0, knee_offset(leg, {0.0, leg.wheel.radius - given.nominal_height - leg.hip.z}),
                                           {0.0, leg.wheel.radius - given.nominal_height - leg.hip.z});
        standing[2 * k] = q.thigh, standing[2 * k + 1] = q.calf;
    }
    first_collision_point = static_cast<int>(points.size());
    for (const Vec2 at : collision.trunk) add(0, at);
    for (int k = 0; k < 2; ++k) {
        const Leg& leg = robot.legs[k].leg;
        for (const double share : collision.thigh) add(1 + 2 * k, share * leg.thigh.end);
        for (const double share : collision.calf) add(2 + 2 * k, share * leg.calf.end);
    }
    last_collision_point = static_cast<int>(points.size());
}

int PoseModel::add(int frame, Vec2 at) {
    points.push_back({frame, at});
    return static_cast<int>(points.size()) - 1;
}

bool place(const PoseModel& model, const WheelPath& path, const Unknowns& y, PoseState& st) {
    st.y = y;
    st.angles[0] = y[2];
    st.turns[0] = Turn::by(y[2]);
    std::array<LegVectors, 2> legs;
    for (int k = 0; k < 2; ++k) {
        const Leg& leg = model.robot.legs[k].leg;
        legs[k].hip = st.turns[0] * leg.hip;
        const CurvePoint on = path.at(y[3 + k]);
        const bool round = path.on_arc(y[3 + k]);
        st.tangent[k] = {on.normal.z, -on.normal.x};
        st.curvature[k] = round ? 1.0 / path.radius() : 0.0;
        if (k == kRear) {
            st.rear_contact = on.centre.x - path.radius() * on.normal.x;
            st.rear_contact_slope = round ? 0.0 : on.normal.z;
        }
        const Vec2 reach = on.centre - (Vec2{y[0], y[1]} + legs[k].hip);
        const double d = norm(reach), l1 = leg.thigh.length, l2 = leg.calf.length;
        st.reached[k] = std::abs(l1 - l2) + kStraight < d && d < l1 + l2 - kStraight;
        if (!st.reached[k]) continue;
        legs[k].thigh = knee_offset(leg, reach);
        legs[k].calf = reach - legs[k].thigh;
        const JointAngles q = joint_angles(leg, y[2], legs[k].thigh, reach);
        st.q[2 * k] = q.thigh, st.q[2 * k + 1] = q.calf;
        st.angles[1 + 2 * k] = y[2] + q.thigh;
        st.angles[2 + 2 * k] = y[2] + q.thigh + q.calf;
        st.turns[1 + 2 * k] = link_turn(leg.thigh, legs[k].thigh);
        st.turns[2 + 2 * k] = link_turn(leg.calf, legs[k].calf);
        differentiate_leg(legs[k], k, st);
    }
    if (!(st.reached[0] && st.reached[1])) return false;
    place_points(model, legs, st);
    place_com(model, legs, st);
    return true;
}

void stand_on(const PoseModel& model, const Joints& q, double rounding, PoseState& st) {
    std::array<LegVectors, 2> legs;
    for (int k = 0; k < 2; ++k) {
        const Leg& leg = model.robot.legs[k].leg;
        const std::array<Range, 2> ranges = {leg.thigh_range, leg.calf_range};
        double angle = st.y[2];
        for (int link = 0; link < 2; ++link) {
            const int j = 2 * k + link;
            const double joint = st.reached[k] ? st.q[j] : q[j];
            const double inside = std::min(std::max(joint, ranges[link].lower), ranges[link].upper);
            st.q[j] = std::abs(joint - inside) < rounding ? inside : joint;
            angle += st.q[j];
            st.angles[1 + j] = angle;
            st.turns[1 + j] = Turn::by(angle);
        }
        legs[k] = {st.turns[0] * leg.hip, st.turns[1 + 2 * k] * leg.thigh.end, st.turns[2 + 2 * k] * leg.calf.end};
    }
    place_points(model, legs, st);
    place_com(model, legs, st);
}

}  // namespace stairwright::poses
