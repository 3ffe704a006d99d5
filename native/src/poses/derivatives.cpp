#include <algorithm>
#include <cmath>

#include "stairwright/poses/constraints.hpp"

namespace stairwright::poses {

namespace {

constexpr double kCoincident = 1e-9;  // m; points that are nearer have no direction between them

// Add the gradient of n . point.
void pull(const PosePoint& p, Vec2 n, GradientU& out) {
    out[0] += n.x;
    out[1] += n.z;
    for (int a = 0; a < kAngles; ++a) out[2 + a] += n.x * p.arms[a].z - n.z * p.arms[a].x;
}

// Add the second derivative of n . point.
void bend(const PosePoint& p, Vec2 n, HessianU& hessian) {
    for (int a = 0; a < kAngles; ++a) hessian[2 + a][2 + a] -= dot(n, p.arms[a]);
}

Vec2 between(const PoseState& st, const Constraint& row) {
    const Vec2 to = row.i < 0 ? row.fixed : st.points[row.i].at;
    return to - st.points[row.k].at;
}

struct Direction {
    Vec2 unit;
    double length = 0.0;
};

Direction direction(Vec2 d) {
    const double length = std::max(norm(d), kCoincident);
    return {{d.x / length, d.z / length}, length};
}

}  // namespace

GradientU gradient(const PoseState& st, const Constraint& row) {
    GradientU out{};
    switch (row.kind) {
        case Constraint::kJoint:
            out[2 + row.i] = row.sign, out[2 + row.j] = -row.sign;
            break;
        case Constraint::kPlace:
            out[7 + row.i] = row.sign;
            break;
        case Constraint::kBehind:
            pull(st.points[row.i], row.normal, out);
            out[8] -= st.rear_contact_slope;
            break;
        case Constraint::kPlane:
            pull(st.points[row.i], row.normal, out);
            break;
        case Constraint::kCom:
            pull(st.com, {row.sign, 0.0}, out);
            break;
        case Constraint::kAcross: {
            const Vec2 n = row.sign * row.normal, d = between(st, row);
            if (row.i >= 0) pull(st.points[row.i], n, out);
            pull(st.points[row.k], -n, out);
            out[2 + row.j] += n.z * d.x - n.x * d.z;
            break;
        }
        case Constraint::kApart: {
            const Direction d = direction(between(st, row));
            pull(st.points[row.i], d.unit, out);
            pull(st.points[row.k], -d.unit, out);
            break;
        }
    }
    return out;
}

void add_curvature(const PoseState& st, const Constraint& row, double factor, HessianU& hessian) {
    switch (row.kind) {
        case Constraint::kJoint:
        case Constraint::kPlace:
            break;
        case Constraint::kBehind:
        case Constraint::kPlane:
            bend(st.points[row.i], factor * row.normal, hessian);
            break;
        case Constraint::kCom:
            bend(st.com, {factor * row.sign, 0.0}, hessian);
            break;
        case Constraint::kAcross: {
            const Vec2 n = factor * row.sign * row.normal, d = between(st, row);
            const int angle = 2 + row.j;
            if (row.i >= 0) bend(st.points[row.i], n, hessian);
            bend(st.points[row.k], -n, hessian);
            hessian[angle][angle] -= dot(n, d);
            GradientU across{};
            if (row.i >= 0) pull(st.points[row.i], {n.z, -n.x}, across);
            pull(st.points[row.k], {-n.z, n.x}, across);
            for (int a = 0; a < kU; ++a) hessian[angle][a] += across[a];
            for (int a = 0; a < kU; ++a) hessian[a][angle] += across[a];
            break;
        }
        case Constraint::kApart: {
            const Direction d = direction(between(st, row));
            bend(st.points[row.i], factor * d.unit, hessian);
            bend(st.points[row.k], -factor * d.unit, hessian);
            GradientU across{};  // |d|'' = (across the line)(across the line)' / |d|
            pull(st.points[row.i], {-d.unit.z, d.unit.x}, across);
            pull(st.points[row.k], {d.unit.z, -d.unit.x}, across);
            for (int a = 0; a < kU; ++a)
                for (int b = 0; b < kU; ++b) hessian[a][b] += factor * across[a] * across[b] / d.length;
            break;
        }
    }
}

}  // namespace stairwright::poses
