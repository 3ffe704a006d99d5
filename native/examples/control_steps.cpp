// The controller without Python and without a simulator: a robot that stands on a step's tread is told to stay.
//
// It prints the torques of some control steps and fails unless the wheels' forces carry the weight.
#include <cmath>
#include <cstdio>

#include "stairwright/control/controller.hpp"
#include "stairwright/control/static_forces.hpp"
#include "stairwright/kinematics.hpp"

using namespace stairwright;

namespace {

Link link(double length, double mass) {
    return {{0.0, -length}, {0.0, -0.5 * length}, mass, mass * length * length / 12.0, {}};
}

Leg leg(Vec2 hip) {
    const Range thigh = {-2.0, 3.0}, calf = {-2.7, -0.8};
    return {hip, link(0.2, 0.9), link(0.2, 0.2), {0.06, 0.4, 7e-4}, thigh, calf, {33.5, 21.0}, {33.5, 21.0}, {10.0, 40.0}, -1.0};
}

}  // namespace

int main() {
    const Polygon box({{-0.13, -0.06}, {0.13, -0.06}, {0.13, 0.06}, {-0.13, 0.06}});
    const Robot robot = {{5.0, 0.06, {0.01, 0.0}, {box}}, {leg({0.18, 0.0}), leg({-0.18, 0.0})}, 0.13, 0.34};
    const WheelPath path({{-1.0, 0.0}, {0.0, 0.0}, {0.0, 0.1}, {2.0, 0.1}}, 0.06);
    control::Gains gains;
    gains.joint_stiffness = 60.0, gains.joint_damping = 2.0, gains.wheel_damping = 0.3;
    gains.com_stiffness = 40.0, gains.com_damping = 8.0, gains.pitch_stiffness = 200.0, gains.pitch_damping = 14.0;
    gains.moment_weight = 20.0, gains.force_limit = 1.3 * robot.mass() * kGravity;

    // Standing with bent knees, wheels under the hips.
    const double thigh = 0.7, calf = -1.4;
    control::RobotState state;
    state.position = {1.0, 0.0, 0.1 + 0.06 + 0.4 * std::cos(thigh)};
    for (int i = 0; i < 4; ++i) state.joints[3 * i] = thigh, state.joints[3 * i + 1] = calf;
    const Body body = {state.position[0], state.position[2], 0.0};
    const std::array<LegPoints, 2> legs = {forward(robot.legs[0], body, {thigh, calf}), forward(robot.legs[1], body, {thigh, calf})};

    control::Reference target;
    for (int pair = 0; pair < 2; ++pair) {
        target.value.wheels[pair] = path.project(legs[pair].wheel);
        target.value.joints[2 * pair] = thigh, target.value.joints[2 * pair + 1] = calf;
    }
    target.value.trunk = {body.x, body.z};
    target.value.com = centre_of_mass(robot, body, Turn::by(0.0), legs);
    const double weight = robot.mass() * kGravity;
    target.forces = control::static_forces(path, weight, 0.6, target.value.wheels, target.value.com).force;

    control::Controller controller(robot, path, 0.6, gains);
    for (int k = 0; k < 5; ++k) {
        const control::Torques torques = controller.step(state, target);
        const control::Torques given = control::limit_torques(robot, std::span<const double, 12>(state.joint_rates), torques);
        double carried = 0.0;
        for (int i = 0; i < 4; ++i) carried += controller.forces()[2 * i + 1];
        std::printf("step %d: front left thigh %.2f calf %.2f wheel %.2f Nm; the wheels carry %.1f of %.1f N\n", k, given[0], given[1],
                    given[2], carried, weight);
        if (!(std::abs(carried - weight) < 0.01 * weight)) return 1;
    }
    return 0;
}
