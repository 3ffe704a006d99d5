// What the certificate knows of a robot, and postures of it: kinematics and distances, none of them the planner's.
#pragma once

#include <array>
#include <vector>

#include "stairwright/certificate/ground.hpp"

namespace stairwright::certificate {

// Between two joints. Its frame: origin at the upper one, z away from the lower one, x ahead.
struct Link {
    struct Capsule {
        Vec2 begin, end;
        double radius = 0.0;
    };

    double length = 0.0, mass = 0.0;
    Vec2 com;
    std::vector<Capsule> capsules;
};

// A pair of legs, which are alike; masses are those of one.
struct Leg {
    Vec2 hip;
    Link thigh, calf;
    double wheel_mass = 0.0;
};

struct Robot {
    std::vector<std::vector<Vec2>> trunk;  // corners of convex pieces
    double trunk_mass = 0.0;
    Vec2 trunk_com;
    std::array<Leg, 2> legs;  // front, rear
    double wheel_radius = 0.0;
};

struct Posture {
    struct Joints {
        Vec2 hip, knee, wheel;
    };

    Vec2 trunk;
    Turn turn;
    std::array<Joints, 2> legs;
};

// Postures of a robot in the world.
class Postures {
  public:
    explicit Postures(Robot robot) : robot_(std::move(robot)) {}
    // Trunk and pitch, then angles of front thigh, front calf, rear thigh and rear calf.
    void add(Vec2 trunk, double pitch, const std::array<double, 4>& joints);

    const std::vector<Posture>& all() const { return postures_; }
    Vec2 com(const Posture& posture) const;
    // Distance from the ground; -1 where the trunk, or where a link begins, is below it. Links less their radius.
    double trunk(const Posture& posture, const Ground& ground) const;
    double links(const Posture& posture, const Ground& ground) const;
    // Of the rims of the front or the rear wheels from the ground; negative where sunk.
    double rim(const Posture& posture, std::size_t leg, const Ground& ground) const;
    // Between links and wheels of the front and of the rear leg; negative where they overlap.
    double between_legs(const Posture& posture) const;

  private:
    Robot robot_;
    std::vector<Posture> postures_;
};

}  // namespace stairwright::certificate
