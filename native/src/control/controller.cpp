#include "stairwright/control/controller.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "inertial_loads.hpp"
#include "lift_off.hpp"
#include "measurement.hpp"
#include "motor_limits.hpp"
#include "stairwright/control/static_forces.hpp"

#include "stairwright/whole.hpp"

namespace stairwright::control {

namespace {

constexpr double kMaxAcceleration = 3.5;  // m/s^2 along x: a far-away reference must not throw the robot
constexpr double kMaxPitchIntegral = 15.0;  // rad/s^2
// Weights of the differences between left and right forces, along x and z: where grip runs out the QP would rather carry all
// with one wheel of a pair, and nothing else keeps the robot from rolling over. Yaw has the wheels' rates and tyres, too: on
// upright faces, where a wheel lifts by its grip alone, the side that is to lift more may push more.
constexpr Vec2 kEven = {0.002, 0.02};
constexpr double kTippingPlace = 0.05;  // of the weight of forces along x, of a robot that tips
constexpr double kMostUneven = 0.8;  // of what a pair carries: left less right

using Supports = std::array<WheelSupport, 4>;

struct Wrench {
    double x, z, moment;
};

// Columns: the wrench on the body of each unit force (eqs 3-7).
std::array<Wrench, 8> force_map(const Measurement& m, const Supports& supports) {
    std::array<Wrench, 8> A;
    for (int i = 0; i < 4; ++i) {
        const Vec2 n = supports[i].normal, t = supports[i].tangent();
        const Vec2 lever = {m.legs[i].wheel.x - supports[i].reach * n.x - m.com.x,
                            m.legs[i].wheel.z - supports[i].reach * n.z - m.com.z};
        A[2 * i] = {t.x, t.z, lever.z * t.x - lever.x * t.z};
        A[2 * i + 1] = {n.x, n.z, lever.z * n.x - lever.x * n.z};
    }
    return A;
}

// What gives the body the wanted accelerations (eqs 8-9). `moment` is what the planned motion takes.
Wrench desired_wrench(const Gains& g, double mass, const Measurement& m, const Reference& target, double moment,
                      double integral) {
    double ax = target.acceleration.com.x + g.com_stiffness * (target.value.com.x - m.com.x);
    ax += g.com_damping * (target.rate.com.x - m.com_velocity.x);
    ax = std::clamp(ax, -kMaxAcceleration, kMaxAcceleration);
    double az = target.acceleration.com.z + g.com_stiffness * (target.value.com.z - m.com.z);
    az += g.com_damping * (target.rate.com.z - m.com_velocity.z);
    double spin = integral + g.pitch_stiffness * (target.value.pitch - m.pitch);
    spin += g.pitch_damping * (target.rate.pitch - m.pitch_rate);
    return {mass * ax, mass * (az + kGravity), moment + m.inertia * spin};
}

// Left less right vertical force, as a share of what each pair carries, that keeps the robot from rolling over.
// Against gravity its stiffness must be above g / h.
double uneven_share(const Gains& g, double mass, const Robot& robot, const Measurement& m, const Reference& target,
                    double radius) {
    const double wheels = m.legs[0].wheel.z + m.legs[1].wheel.z + m.legs[2].wheel.z + m.legs[3].wheel.z;
    const double height = m.com.z - 0.25 * wheels + radius;
    const double roll = g.roll_stiffness * m.roll + g.roll_damping * m.roll_rate;
    const double carried = std::max(target.forces[0].z, 0.0) + std::max(target.forces[1].z, 0.0);
    const double share = -mass * height * height * roll / robot.half_track / std::max(carried, 1e-9);
    return std::clamp(share, -kMostUneven, kMostUneven);
}

// Adds weight (axis . (f_left - f_right) - difference)^2 to twice the cost; the QP has a wheel's force along and out of its face.
void ask_difference(BalanceQp& qp, int pair, double weight, Vec2 axis, const Supports& supports, double difference) {
    std::array<double, 4> row;
    for (int side = 0; side < 2; ++side) {
        const WheelSupport& s = supports[2 * pair + side];
        const double sign = side == 0 ? 1.0 : -1.0;
        row[2 * side] = sign * dot(axis, s.tangent()), row[2 * side + 1] = sign * dot(axis, s.normal);
    }
    const int first = 4 * pair;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) qp.H[first + i][first + j] += weight * row[i] * row[j];
        qp.g[first + i] -= weight * row[i] * difference;
    }
}

// Cost of eq 11: wrench error, distance from the plan's static forces, change, unevenness of left and right. Of forces along x
// `share` of the weight counts.
BalanceQp balance_qp(const Gains& gains, const std::array<Wrench, 8>& A, const Wrench& wanted, const Supports& supports,
                     const Reference& target, const Forces& last, double uneven, double share) {
    BalanceQp qp;
    const double S = gains.force_weight, Sx = share * S, M = gains.moment_weight;
    const Wrench b = {Sx * wanted.x, S * wanted.z, M * wanted.moment};
    for (int i = 0; i < 8; ++i) {
        for (int j = 0; j <= i; ++j)
            qp.H[i][j] = qp.H[j][i] = Sx * A[i].x * A[j].x + S * A[i].z * A[j].z + M * A[i].moment * A[j].moment;
        qp.H[i][i] += gains.alpha + gains.beta;
        const Vec2 f = 0.5 * target.forces[i / 4];
        const Vec2 n = supports[i / 2].normal;
        const double resting = i % 2 == 0 ? f.x * n.z - f.z * n.x : f.x * n.x + f.z * n.z;
        qp.g[i] = -A[i].x * b.x - A[i].z * b.z - A[i].moment * b.moment;
        qp.g[i] -= gains.alpha * resting + gains.beta * last[i];
    }
    for (int pair = 0; pair < 2; ++pair) {
        ask_difference(qp, pair, kEven.x, {1.0, 0.0}, supports, 0.0);
        ask_difference(qp, pair, kEven.z, {0.0, 1.0}, supports, uneven * std::max(target.forces[pair].z, 0.0));
    }
    for (int i = 0; i < 4; ++i) qp.friction[i] = supports[i].friction;
    qp.load_limit = gains.force_limit;
    return qp;
}

}  // namespace

Controller::Controller(Robot robot, WheelPath path, double friction, const Gains& gains)
    : robot_(std::move(robot)), path_(std::move(path)), friction_(friction), mass_(robot_.mass()), gains_(gains) {
    for (int i = 0; i < 4; ++i) forces_[2 * i + 1] = mass_ * kGravity / 4;
    places_.fill(std::numeric_limits<double>::quiet_NaN());
}

Torques drive(const Command& c, const std::array<double, 12>& joints, const std::array<double, 12>& joint_rates) {
    Torques out;
    for (std::size_t j = 0; j < out.size(); ++j)
        out[j] = c.torques[j] + c.stiffness[j] * (c.joints[j] - joints[j]) + c.damping[j] * (c.rates[j] - joint_rates[j]);
    return out;
}

Torques Controller::step(const RobotState& state, const Reference& target) {
    return drive(command(state, target), state.joints, state.joint_rates);
}

Command Controller::command(const RobotState& state, const Reference& target,
                            const std::optional<std::array<double, 4>>& places, const std::array<bool, 2>& feels_ground) {
    const Gains& g = gains_;
    const Measurement m = measure(robot_, mass_, state);
    const double usable = std::max(g.friction_share, target.friction_share) * friction_;
    Supports supports;
    for (int i = 0; i < 4; ++i) {
        places_[i] = places ? (*places)[i] : locate(path_, m.legs[i].wheel, places_[i]);
        const auto lean = static_cast<Lean>(whole_part(target.lean[i / 2], 2));
        supports[i] = wheel_support(path_, places_[i], target.value.wheels[i / 2], usable, lean);
    }
    pitch_integral_ += kPeriod * g.pitch_integral * (target.value.pitch - m.pitch);
    pitch_integral_ = std::clamp(pitch_integral_, -kMaxPitchIntegral, kMaxPitchIntegral);
    const InertialLoads inertial = inertial_loads(robot_, target);
    const Wrench wanted = desired_wrench(g, mass_, m, target, inertial.moment, pitch_integral_);
    const double uneven = uneven_share(g, mass_, robot_, m, target, path_.radius());
    std::array<LegMotors, 4> motors;
    for (int i = 0; i < 4; ++i) {
        motors[i] = leg_torques(robot_.legs[i / 2], m.legs[i], supports[i]);
        const LegLoads &moved = inertial.legs[i / 2], rubbed = friction_loads(robot_.legs[i / 2], i / 2, target.rate);
        for (const LegLoads& load : {moved, rubbed})
            motors[i].thigh.rest += load.thigh, motors[i].calf.rest += load.calf, motors[i].wheel.rest += load.wheel;
        moving_[3 * i] = moved.thigh, moving_[3 * i + 1] = moved.calf, moving_[3 * i + 2] = moved.wheel;
    }
    lift_off_ = lift_off(m, path_, places_, feels_ground, target.value);
    const double place_counts = std::lerp(1.0, kTippingPlace, lift_off_);
    const BalanceQp qp = balance_qp(g, force_map(m, supports), wanted, supports, target, forces_, uneven, place_counts);
    solve_within_motors(qp, motors, robot_, state.joint_rates, g.force_weight, forces_);

    // Torques: forces, weight and inertia, tracking (eq 27), rolling (eqs 14-16) with the traction fed forward.
    const double turn = -g.heading_stiffness * m.heading;
    const int lifting = lifting_pair(m, target.value.pitch);
    const double difference = robot_.half_track / path_.radius() * (turn + g.yaw_damping * (turn - m.yaw_rate));
    Command out;
    for (int i = 0; i < 4; ++i) {
        const int pair = i / 2, j = 3 * i;
        const Leg& leg = robot_.legs[pair];
        const WheelSupport& s = supports[i];
        const double t = forces_[2 * i], n = forces_[2 * i + 1];
        out.torques[j] = motors[i].thigh.at(t, n), out.torques[j + 1] = motors[i].calf.at(t, n);
        for (int k = 0; k < 2; ++k) {
            out.joints[j + k] = target.value.joints[2 * pair + k], out.rates[j + k] = target.rate.joints[2 * pair + k];
            out.stiffness[j + k] = g.joint_stiffness, out.damping[j + k] = g.joint_damping;
        }
        const double traction = s.traction(t * s.tangent() + n * s.normal);
        // Held by its place alone, a wheel that waits on an edge would hang back by some millimetres, and slip.
        const double crept = creep_ * traction / (0.25 * mass_ * kGravity);
        const double speed = target.rate.wheels[pair] + g.wheel_sync * (target.value.wheels[pair] - places_[i]) + crept;
        const double rate = speed / leg.wheel.radius + (i % 2 == 0 ? -difference : difference);
        // A wheel turns against its calf.
        out.torques[j + 2] = leg.wheel.radius * traction + motors[i].wheel.rest;
        // Held in its place, the pair that a robot which tips stands on could not roll back under it.
        out.damping[j + 2] = pair == lifting ? g.wheel_damping : (1.0 - lift_off_) * g.wheel_damping;
        out.rates[j + 2] = rate - state.joint_rates[j] - state.joint_rates[j + 1] - m.pitch_rate;
    }
    return out;
}

Reference Controller::standing(const RobotState& state, const std::array<double, 4>& places) const {
    const Measurement m = measure(robot_, mass_, state);
    Reference out;
    for (int pair = 0; pair < 2; ++pair) {
        const int left = 2 * pair, right = left + 1;
        out.value.wheels[pair] = 0.5 * (places[left] + places[right]);
        for (int k = 0; k < 2; ++k)
            out.value.joints[2 * pair + k] = 0.5 * (state.joints[3 * left + k] + state.joints[3 * right + k]);
    }
    out.value.pitch = m.pitch, out.value.com = m.com;
    out.value.trunk = {state.position[0], state.position[2]};
    const StaticForces rest = static_forces(path_, mass_ * kGravity, friction_, out.value.wheels, m.com);
    out.forces = rest.force, out.friction_share = rest.friction_share;
    for (int pair = 0; pair < 2; ++pair) out.lean[pair] = static_cast<double>(rest.lean[pair]);
    return out;
}

double available_torque(const Motor& motor, double torque, double speed) {
    double limit = motor.torque;
    if (torque * speed > 0.0) limit = motor.torque * std::max(0.0, 1.0 - std::abs(speed) / motor.speed);
    return std::min(std::max(torque, -limit), limit);
}

Torques limit_torques(const Robot& robot, std::span<const double, 12> joint_rates, const Torques& wanted) {
    Torques out;
    for (int i = 0; i < 4; ++i) {
        const Leg& leg = robot.legs[i / 2];
        const Motor* motors[] = {&leg.thigh_motor, &leg.calf_motor, &leg.wheel_motor};
        for (int k = 0; k < 3; ++k)
            out[3 * i + k] = available_torque(*motors[k], wanted[3 * i + k], joint_rates[3 * i + k]);
    }
    return out;
}

}  // namespace stairwright::control
