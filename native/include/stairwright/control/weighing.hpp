// What the robot carries that nobody has told of, or where its mass centre is instead, found out before it starts: while it
// stands, the ground's forces on the wheels, felt by the torques of the legs, add up to its weight, and what front and rear
// carry of it tells above which place its mass centre is. How high that is they tell while it nods.
#pragma once

#include <optional>

#include "stairwright/control/nod.hpp"

namespace stairwright::control {

// In the trunk's frame.
struct Load {
    double mass = 0.0;  // beyond that of the robot as it is believed to be [kg]; 0 where that may be an error
    Vec2 place;         // of that mass [m]; z is not a number if it did not nod
    Vec2 shift;         // without such a mass: of the robot's mass centre from where it is believed to be [m]
};

class Weighing {
  public:
    explicit Weighing(const Robot& robot) : robot_(robot) {}

    // One control step of a robot that stands as `planned` with its wheels at `places` of `path`: what is asked for. `felt`
    // are the forces of the ground on the wheels, in the world [N], if all legs tell theirs. It finds nothing where they do
    // not, or where the robot does not stand on level ground on all wheels.
    Reference step(const Reference& planned, const RobotState& state, const WheelPath& path, const std::array<double, 4>& places,
                   const std::optional<std::array<Vec2, 4>>& felt, bool level, double dt);

    bool over() const { return over_; }
    // What it carries or how it is shifted, once that is found; empty where it may as well be nothing, see kDoubt, kShifted.
    const std::optional<Load>& load() const { return load_; }

  private:
    // What a place along depends on: cosine and sine of the pitch, and its acceleration, for what turns the robot has a moment
    // too. By the first two a mass centre (x, z) in the trunk's frame is at x cos + z sin.
    using Terms = std::array<double, 3>;

    void weigh(const Reference& asked, const RobotState& state, const WheelPath& path, const std::array<double, 4>& places,
               const std::array<Vec2, 4>& felt);
    // The (x, z) that fits the summed places best; z is 0 if the robot did not nod.
    Vec2 fitted(Terms summed) const;
    void conclude();

    RobotModel robot_;
    std::optional<Nod> nod_;
    bool over_ = false, told_ = true;
    double time_ = 0.0;    // since it began to stand [s]
    double steps_ = 0.0;   // that count
    double weight_ = 0.0;  // sum of the vertical forces [N]
    // Sums of terms times terms, times the moment about the trunk point's place along [Nm], and times the believed mass centre
    // ahead of that [m].
    std::array<Terms, 3> normal_{};
    Terms moment_{}, own_{};
    std::optional<Load> load_;
};

}  // namespace stairwright::control
