// What the certificate knows of a robot, and postures of it: kinematics and distances, none of them the planner's.
#pragma once

#include <array>
#include <span>
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

inline constexpr std::size_t kHip = 0, kKnee = 1, kWheel = 2;

// A robot's trunk, pitch and angles of front thigh, front calf, rear thigh and rear calf.
struct Pose {
    Vec2 trunk;
    double pitch = 0.0;
    std::array<double, 4> joints{};
};

struct Posture {
    Vec2 trunk;
    Turn turn;
    std::array<std::array<Vec2, 2>, 3> joints;  // hips, knees and wheels; front, rear
};

// Postures of a robot in the world, and distances at each of them [m]. Those with `slack` [m] are exact where they are
// less than that or may be the least after it is taken off, and elsewhere bounds.
class Postures {
  public:
    Postures(Robot robot, std::span<const Pose> poses);

    const std::vector<Posture>& all() const { return postures_; }
    // From the first to each posture; from one to the next no joint and no point of the trunk moves farther.
    const std::vector<double>& way() const { return way_; }
    std::vector<Vec2> com() const;
    // From the ground; -1 where the trunk, or where a link begins, is below it. Links less their radius.
    std::vector<double> trunk(const Ground& ground, std::span<const double> slack) const;
    std::vector<double> links(const Ground& ground, std::span<const double> slack) const;
    // Of the rims of the front or the rear wheels from the ground; negative where sunk.
    std::vector<double> rims(std::size_t pair, const Ground& ground) const;
    // Between links and wheels of the front and of the rear leg; negative where they overlap. Exact where least.
    std::vector<double> between_legs() const;

  private:
    Robot robot_;
    std::vector<Posture> postures_;
    std::vector<double> way_;
};

}  // namespace stairwright::certificate
