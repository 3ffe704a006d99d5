// Which constraints are near: joint limits, places, eq 20, balance, ground (eq 21), other leg.
#include <algorithm>
#include <cmath>

#include "stairwright/poses/constraints.hpp"

namespace stairwright::poses {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNear = 0.15;            // m; rows with more slack do not guide a step
constexpr std::size_t kMostRows = 1000;   // rows kept; what lies beyond is still measured

class Collector {
  public:
    Collector(const PoseModel& model, const std::vector<Cell>& cells, const PoseTask& task, const PoseState& state,
              Constraints& out)
        : model_(model), cells_(cells), task_(task), st_(state), out_(out) {
        out_.rows.clear();
        out_.least = kInfinity;
    }

    void run() {
        joints();
        places();
        balance();
        if (task_.exact_links)
            shapes();
        else
            for (int i = model_.first_collision_point; i < model_.last_collision_point; ++i) collision_point(i);
        legs();
    }

  private:
    void measured(double slack) { out_.least = std::min(out_.least, slack); }

    void add(const Constraint& row) {
        if (!(row.value > kNear) && out_.rows.size() < kMostRows) out_.rows.push_back(row);
    }

    void add_measured(const Constraint& row) {
        measured(row.value);
        add(row);
    }

    void joints() {
        for (int k = 0; k < 4; ++k) {
            const int i = 1 + k, j = k % 2 == 0 ? 0 : k;  // angle of the joint's link, and of the one that it turns against
            add_measured({Constraint::kJoint, i, j, -1, {}, {}, 1.0, st_.q[k] - task_.lower[3 + k]});
            add_measured({Constraint::kJoint, i, j, -1, {}, {}, -1.0, task_.upper[3 + k] - st_.q[k]});
        }
    }

    void places() {
        for (int k = 0; k < 2; ++k) {
            if (task_.upper[7 + k] <= task_.lower[7 + k]) continue;  // fixed: not among the unknowns
            add_measured({Constraint::kPlace, k, -1, -1, {}, {}, 1.0, st_.y[3 + k] - task_.lower[7 + k]});
            add_measured({Constraint::kPlace, k, -1, -1, {}, {}, -1.0, task_.upper[7 + k] - st_.y[3 + k]});
        }
    }

    void balance() {
        if (task_.behind > -kInfinity) {
            const int hip = model_.hip[kRear];
            add_measured({Constraint::kBehind, hip, -1, -1, {1.0, 0.0}, {}, 1.0,
                          st_.points[hip].at.x - st_.rear_contact - task_.behind});
        }
        if (std::isfinite(task_.com.lower))
            add_measured({Constraint::kCom, -1, -1, -1, {}, {}, 1.0, st_.com.at.x - task_.com.lower});
        if (std::isfinite(task_.com.upper))
            add_measured({Constraint::kCom, -1, -1, -1, {}, {}, -1.0, task_.com.upper - st_.com.at.x});
    }

    // Call `visit` with the cells that may be near a shape.
    template <typename Visit>
    void cells_near(double left, double right, double low, Visit visit) {
        const double far = kNear + task_.clearance;
        for (const Cell& cell : cells_) {
            if (cell.left > right + far) break;
            if (cell.right >= left - far && cell.top >= low - far) visit(cell);
        }
    }

    void collision_point(int i) {
        const Vec2 p = st_.points[i].at;
        cells_near(p.x, p.x, p.z, [&](const Cell& cell) {
            const Face* best = nullptr;
            double gap = -kInfinity;
            for (const Face& face : cell.faces)
                if (face.distance(p) > gap) gap = face.distance(p), best = &face;
            add_measured({Constraint::kPlane, i, -1, -1, best->normal, {}, 1.0, gap - task_.clearance});
        });
    }

    void shapes() {
        for (const TrunkShape& shape : model_.trunk) {
            double left = kInfinity, right = -kInfinity, low = kInfinity;
            for (int i = shape.first; i < shape.first + shape.count; ++i) {
                const Vec2 p = st_.points[i].at;
                left = std::min(left, p.x), right = std::max(right, p.x), low = std::min(low, p.z);
            }
            cells_near(left, right, low, [&](const Cell& cell) { trunk_from_cell(shape, cell); });
        }
        for (int leg = 0; leg < 2; ++leg) {
            for (const LinkShape& link : model_.links[leg]) {
                const Vec2 a = st_.points[link.a].at, b = st_.points[link.b].at;
                cells_near(std::min(a.x, b.x) - link.radius, std::max(a.x, b.x) + link.radius,
                           std::min(a.z, b.z) - link.radius, [&](const Cell& cell) { link_from_cell(link, cell); });
            }
        }
    }

    // Faces of the cell, sides of the trunk.
    void trunk_from_cell(const TrunkShape& shape, const Cell& cell) {
        const int last = shape.first + shape.count;
        double best = -kInfinity;
        const Face* face = nullptr;
        int side = -1;
        for (const Face& one : cell.faces) {
            double low = kInfinity;
            for (int i = shape.first; i < last; ++i) low = std::min(low, dot(one.normal, st_.points[i].at));
            if (low - one.offset > best) best = low - one.offset, face = &one;
        }
        for (int k = 0; k < shape.count; ++k) {
            const Vec2 normal = st_.turns[0] * shape.normals[k], from = st_.points[shape.first + k].at;
            double low = kInfinity;
            for (const Vec2 corner : cell.corners) low = std::min(low, dot(normal, corner - from));
            if (low > best) best = low, side = k;
        }
        measured(best - task_.clearance);
        if (side < 0) {
            for (int i = shape.first; i < last; ++i)
                add({Constraint::kPlane, i, -1, -1, face->normal, {}, 1.0, face->distance(st_.points[i].at) - task_.clearance});
            return;
        }
        const Vec2 normal = st_.turns[0] * shape.normals[side];
        const int from = shape.first + side;
        for (const Vec2 corner : cell.corners)
            add({Constraint::kAcross, -1, 0, from, normal, corner, 1.0,
                 dot(normal, corner - st_.points[from].at) - task_.clearance});
    }

    // Faces of the cell, sides of the link.
    void link_from_cell(const LinkShape& link, const Cell& cell) {
        const Vec2 a = st_.points[link.a].at, b = st_.points[link.b].at, normal = st_.turns[link.frame] * link.normal;
        const double bound = link.radius + task_.clearance;
        double best = -kInfinity, sign = 0.0;
        const Face* face = nullptr;
        for (const Face& one : cell.faces) {
            const double low = std::min(dot(one.normal, a), dot(one.normal, b));
            if (low - one.offset > best) best = low - one.offset, face = &one;
        }
        double low = kInfinity, high = -kInfinity;
        for (const Vec2 corner : cell.corners) {
            const double h = dot(normal, corner - a);
            low = std::min(low, h), high = std::max(high, h);
        }
        if (low > best) best = low, sign = 1.0;
        if (-high > best) best = -high, sign = -1.0;
        measured(best - bound);
        if (sign == 0.0) {
            for (const int i : {link.a, link.b})
                add({Constraint::kPlane, i, -1, -1, face->normal, {}, 1.0, face->distance(st_.points[i].at) - bound});
            return;
        }
        for (const Vec2 corner : cell.corners)
            add({Constraint::kAcross, -1, link.frame, link.a, normal, corner, sign, sign * dot(normal, corner - a) - bound});
    }

    // Front leg from rear leg: wheels, and wheels and knees from the other leg's links.
    void legs() {
        const int front = model_.wheel[kFront], rear = model_.wheel[kRear];
        const double wheels = model_.nodes[kFront][0].radius + model_.nodes[kRear][0].radius + task_.legs_distance;
        add_apart(front, rear, wheels);
        for (int leg = 0; leg < 2; ++leg)
            for (const LegNode& node : model_.nodes[leg])
                for (const LinkShape& link : model_.links[1 - leg])
                    node_from_link(node.point, link, node.radius + link.radius + task_.legs_distance);
    }

    void add_apart(int i, int k, double bound) {
        add_measured({Constraint::kApart, i, -1, k, {}, {}, 1.0, norm(st_.points[i].at - st_.points[k].at) - bound});
    }

    void node_from_link(int node, const LinkShape& link, double bound) {
        const Vec2 a = st_.points[link.a].at, d = st_.points[node].at - a;
        const double along = dot(d, st_.points[link.b].at - a) / link.length;
        if (along < 0.0 || along > link.length) {
            add_apart(node, along < 0.0 ? link.a : link.b, bound);
            return;
        }
        const Vec2 normal = st_.turns[link.frame] * link.normal;
        const double height = dot(normal, d), sign = height >= 0.0 ? 1.0 : -1.0;
        add_measured({Constraint::kAcross, node, link.frame, link.a, normal, {}, sign, sign * height - bound});
    }

    const PoseModel& model_;
    const std::vector<Cell>& cells_;
    const PoseTask& task_;
    const PoseState& st_;
    Constraints& out_;
};

}  // namespace

void collect(const PoseModel& model, const std::vector<Cell>& cells, const PoseTask& task, const PoseState& state,
             Constraints& out) {
    Collector(model, cells, task, state, out).run();
}

}  // namespace stairwright::poses
