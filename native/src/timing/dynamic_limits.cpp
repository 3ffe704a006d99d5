#include "stairwright/timing/dynamic_limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "../control/inertial_loads.hpp"
#include "stairwright/control/static_forces.hpp"
#include "stairwright/kinematics.hpp"

namespace stairwright::timing {

namespace {

using control::InertialLoads;
using control::Planned;
using control::Reference;

constexpr double kNoSqueeze = 1e-9;  // of a constraint that pushing against each other does not change
constexpr double kMostKept = 0.8;    // of a CoM margin: a robot that may not accelerate at all does not get anywhere
constexpr int kTorques = 6;          // thigh, calf, wheel of a front and of a rear leg

// What is linear in x and u, and in a moment by which the mass centre's place may be wrong.
struct Affine {
    double rest = 0.0, x = 0.0, u = 0.0, shift = 0.0;

    Affine operator+(const Affine& o) const { return {rest + o.rest, x + o.x, u + o.u, shift + o.shift}; }
    friend Affine operator*(double k, const Affine& a) { return {k * a.rest, k * a.x, k * a.u, k * a.shift}; }
};

using Wrench = std::array<Affine, 3>;  // in weights, and weights times metres about the mass centre
using Vec3 = std::array<double, 3>;

// Kept at 0 or above; `squeeze` is how it grows as the pairs push against each other.
struct Constraint {
    Affine value;
    double squeeze = 0.0;
    bool motor = false;
};

// Force of the ground on one pair: along its face and out of it; and what they do.
struct PairForce {
    Vec2 tangent, normal, point;  // unit vectors, and where it acts
    double friction = 0.0;

    Vec3 wrench(Vec2 direction, Vec2 about) const {
        const Vec2 lever = point - about;
        return {direction.x, direction.z, lever.z * direction.x - lever.x * direction.z};
    }
};

double determinant(const Vec3& a, const Vec3& b, const Vec3& c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1]) + c[0] * (a[1] * b[2] - a[2] * b[1]);
}

// Forces (tangential and normal of front and rear) that give a wrench, plus any multiple of `squeeze`.
struct Forces {
    std::array<Affine, 4> given{};
    std::array<double, 4> squeeze{};
};

Forces forces_for(const std::array<Vec3, 4>& A, const Wrench& wrench) {
    Forces out;
    for (int k = 0; k < 4; ++k) {
        std::array<Vec3, 3> others;
        for (int i = 0, j = 0; i < 4; ++i)
            if (i != k) others[j++] = A[i];
        out.squeeze[k] = (k % 2 ? -1.0 : 1.0) * determinant(others[0], others[1], others[2]);
    }
    // The force that squeezing changes most is left at 0; Cramer's rule gives the others.
    const auto largest = std::max_element(out.squeeze.begin(), out.squeeze.end(),
                                          [](double a, double b) { return std::abs(a) < std::abs(b); });
    const int left_out = static_cast<int>(largest - out.squeeze.begin());
    std::array<int, 3> kept;
    for (int i = 0, j = 0; i < 4; ++i)
        if (i != left_out) kept[j++] = i;
    const std::array<Vec3, 3> columns = {A[kept[0]], A[kept[1]], A[kept[2]]};
    const double whole = determinant(columns[0], columns[1], columns[2]);
    const auto solved = [&](double Affine::* part) {
        const Vec3 b = {wrench[0].*part, wrench[1].*part, wrench[2].*part};
        for (int j = 0; j < 3; ++j) {
            std::array<Vec3, 3> replaced = columns;
            replaced[j] = b;
            out.given[kept[j]].*part = determinant(replaced[0], replaced[1], replaced[2]) / whole;
        }
    };
    for (double Affine::* part : {&Affine::rest, &Affine::x, &Affine::u, &Affine::shift}) solved(part);
    const double size = *largest;
    for (double& share : out.squeeze) share /= size;
    return out;
}

std::array<double, kTorques> torques_of(const InertialLoads& loads) {
    const auto &f = loads.legs[0], &r = loads.legs[1];
    return {f.thigh, f.calf, f.wheel, r.thigh, r.calf, r.wheel};
}

// Moment about +y with which a leg's own weight turns what hangs on `joint` [Nm]: links below it.
double weight_below(Vec2 joint, std::initializer_list<std::pair<double, Vec2>> bodies) {
    double moment = 0.0;
    for (const auto& [mass, place] : bodies) moment += mass * (place.x - joint.x);
    return -kGravity * moment;
}

class Sample {
  public:
    Sample(const Robot& robot, const WheelPath& path, double friction, const PathPoint& at, const Reserve& reserve)
        : robot_(robot), at_(at), weight_(robot.mass() * kGravity) {
        const Planned& v = at.value;
        const control::StaticForces rest = control::static_forces(path, weight_, friction, v.wheels, v.com);
        const double usable = std::max(reserve.friction, rest.friction_share) * friction;
        for (int pair = 0; pair < 2; ++pair) {
            const double s = v.wheels[pair];
            const control::WheelSupport support = control::wheel_support(path, s, s, usable, rest.lean[pair]);
            rolls_[pair] = support.reach > 0.0;
            pairs_[pair] = {support.tangent(), support.normal, path.centre(s) - support.reach * support.normal, support.friction};
        }
        add_cones_and_motors(reserve.torque);
    }

    // Limits without the number by which pairs push against each other: of every constraint that wants it larger
    // with every one that wants it smaller.
    DynamicLimits limits(const Reserve& reserve) const {
        std::vector<Constraint> free;
        for (const Constraint& c : constraints_) {
            if (std::abs(c.squeeze) <= kNoSqueeze) free.push_back({c.value, 0.0, c.motor});
            if (c.squeeze <= kNoSqueeze) continue;
            for (const Constraint& d : constraints_)
                if (d.squeeze < -kNoSqueeze)
                    free.push_back({(1.0 / c.squeeze) * c.value + (-1.0 / d.squeeze) * d.value, 0.0, c.motor || d.motor});
        }
        double margin = std::numeric_limits<double>::infinity();  // of the mass centre's place [m]
        for (const Constraint& c : free)
            if (!c.motor && std::abs(c.value.shift) > kNoSqueeze) margin = std::min(margin, c.value.rest / std::abs(c.value.shift));
        margin = std::isfinite(margin) ? std::max(margin, 0.0) : 0.0;
        const double kept = std::max((1.0 - reserve.sway) * margin, std::min(reserve.com, kMostKept * margin));
        DynamicLimits out;
        for (const Constraint& c : free) {
            const double room = c.value.rest - (c.motor ? 0.0 : kept * std::abs(c.value.shift));
            (c.motor ? out.torque : out.balance).push_back({c.value.x, c.value.u, std::max(room, 0.0)});
        }
        return out;
    }

  private:
    void add_cones_and_motors(double torque_share) {
        Reference by_speed, by_acceleration;
        by_speed.value = by_acceleration.value = at_.value;
        by_speed.rate = at_.first, by_speed.acceleration = at_.second;
        by_acceleration.acceleration = at_.first;
        const InertialLoads x = control::inertial_loads(robot_, by_speed), u = control::inertial_loads(robot_, by_acceleration);
        const Vec2 com = at_.value.com;
        const Wrench wrench = {{
            {0.0, at_.second.com.x / kGravity, at_.first.com.x / kGravity, 0.0},
            {1.0, at_.second.com.z / kGravity, at_.first.com.z / kGravity, 0.0},
            {0.0, x.moment / weight_, u.moment / weight_, 1.0},
        }};
        std::array<Vec3, 4> A;
        for (int pair = 0; pair < 2; ++pair) {
            A[2 * pair] = pairs_[pair].wrench(pairs_[pair].tangent, com);
            A[2 * pair + 1] = pairs_[pair].wrench(pairs_[pair].normal, com);
        }
        const Forces forces = forces_for(A, wrench);
        const auto add = [&](const Affine& offset, const std::array<double, 4>& shares, bool motor) {
            Constraint c = {offset, 0.0, motor};
            for (int k = 0; k < 4; ++k) {
                c.value = c.value + shares[k] * forces.given[k];
                c.squeeze += shares[k] * forces.squeeze[k];
            }
            constraints_.push_back(c);
        };
        for (int pair = 0; pair < 2; ++pair) {
            for (const double side : {1.0, -1.0}) {
                std::array<double, 4> shares{};
                shares[2 * pair] = side, shares[2 * pair + 1] = pairs_[pair].friction;
                add({}, shares, false);
            }
            std::array<double, 4> pushes{};
            pushes[2 * pair + 1] = 1.0;
            add({}, pushes, false);
        }
        const auto tx = torques_of(x), tu = torques_of(u);
        for (int pair = 0; pair < 2; ++pair) add_motors(pair, torque_share, &tx[3 * pair], &tu[3 * pair], add);
    }

    // Torques of one leg of a pair, which carries half of the pair's force, below `share` of what its motors have.
    template <typename Add>
    void add_motors(int pair, double share, const double* x, const double* u, const Add& add) {
        const Leg& leg = robot_.legs[pair];
        const Planned& v = at_.value;
        const LegPoints at = forward(leg, {v.trunk.x, v.trunk.z, v.pitch}, {v.joints[2 * pair], v.joints[2 * pair + 1]});
        const Turn upper = Turn::by(v.pitch + v.joints[2 * pair]), lower = Turn::by(v.pitch + v.joints[2 * pair] + v.joints[2 * pair + 1]);
        const Vec2 thigh = at.hip + upper * leg.thigh.com, calf = at.knee + lower * leg.calf.com;
        const double hanging[] = {
            weight_below(at.hip, {{leg.thigh.mass, thigh}, {leg.calf.mass, calf}, {leg.wheel.mass, at.wheel}}),
            weight_below(at.knee, {{leg.calf.mass, calf}, {leg.wheel.mass, at.wheel}}), 0.0};
        const PairForce& force = pairs_[pair];
        const auto moment = [&](Vec2 joint, Vec2 along) {
            return (force.point.x - joint.x) * along.z - (force.point.z - joint.z) * along.x;
        };
        const Vec2 joints[] = {at.hip, at.knee, at.wheel};
        const Motor* motors[] = {&leg.thigh_motor, &leg.calf_motor, &leg.wheel_motor};
        for (int j = 0; j < 3; ++j) {
            // Of a wheel that leans on both faces of a corner the normal forces carry, and no motor turns it.
            const double carries = j == 2 && !rolls_[pair] ? 0.0 : 0.5 * weight_;
            const double tangential = j == 2 ? leg.wheel.radius : moment(joints[j], force.tangent);
            const double normal = j == 2 ? 0.0 : moment(joints[j], force.normal);
            const double most = motors[j]->torque;
            for (const double side : {1.0, -1.0}) {
                std::array<double, 4> shares{};
                shares[2 * pair] = -side * carries * tangential / most, shares[2 * pair + 1] = -side * carries * normal / most;
                add({share - side * hanging[j] / most, -side * x[j] / most, -side * u[j] / most, 0.0}, shares, true);
            }
        }
    }

    const Robot& robot_;
    const PathPoint& at_;
    double weight_;
    std::array<PairForce, 2> pairs_;
    std::array<bool, 2> rolls_{};
    std::vector<Constraint> constraints_;
};

}  // namespace

DynamicLimits dynamic_limits(const Robot& robot, const WheelPath& path, double friction, const PathPoint& point,
                             const Reserve& reserve) {
    return Sample(robot, path, friction, point, reserve).limits(reserve);
}

}  // namespace stairwright::timing
