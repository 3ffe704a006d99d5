// What the robot carries that nobody has told of, found out before it starts: while it stands, the ground's forces on the
// wheels, felt by the torques of the legs, add up to its weight, and what front and rear carry of it tells above which
// place its mass centre is. They do not tell how high that is.
#pragma once

#include <optional>

#include "stairwright/control/controller.hpp"

namespace stairwright::control {

struct Load {
    double mass = 0.0;  // beyond that of the robot as it is believed to be [kg]
    double ahead = 0.0; // of the trunk point, horizontally [m]
};

class Weighing {
  public:
    explicit Weighing(Robot robot) : robot_(std::move(robot)) {}

    // One control step of a robot that stands with its wheels at `places` of `path`. `felt` are the forces of the ground on
    // the wheels, in the world [N], if all legs tell theirs. Ends at once where they do not, or where the robot does not
    // stand on level ground on all wheels.
    void step(const RobotState& state, const WheelPath& path, const std::array<double, 4>& places,
              const std::optional<std::array<Vec2, 4>>& felt, bool level, double dt);

    bool over() const { return over_; }
    // What it carries, once that is found; empty where it may as well be nothing, see kDoubt.
    const std::optional<Load>& load() const { return load_; }

  private:
    void conclude();

    Robot robot_;
    bool over_ = false;
    double time_ = 0.0;    // since it began to stand [s]
    double steps_ = 0.0;   // that count
    double weight_ = 0.0;  // sums over these: the vertical forces [N],
    double moment_ = 0.0;  // their moment about the trunk point's place along [Nm],
    double own_ = 0.0;     // the believed mass centre, ahead of that place [m]
    std::optional<Load> load_;
};

}  // namespace stairwright::control
