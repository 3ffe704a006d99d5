// Which faces the wheels push on, and how hard: the gentlest way to hold the robot at rest.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "stairwright/wheel_contacts.hpp"

namespace stairwright {

// A wheel's contacts, and where it touches two faces the bisector of both: it stands for leaning on both, with a cone
// that is narrower than the true one.
struct Faces {
    std::array<Contact, 3> at;
    int count = 0;
};
Faces with_bisector(const WheelContacts& contacts, Vec2 centre, double radius);

// Forces on both wheel pairs in weights, and the faces that they push on.
struct Support {
    std::array<ContactForce, 2> forces;
    std::array<Contact, 2> faces;
    bool found = false;
};

// Of the pairs of faces the one that holds a CoM at `com_x` with the least pressure; it may use most of the friction.
Support gentlest_support(const Faces& front, const Faces& rear, double com_x, double friction);

// What the controller's resting forces come to (control/static_forces.hpp): of the pairs of single faces that hold the
// CoM the one with the smallest forces. Only where none does it leans on two faces of a corner at once.
Support resting_support(const Faces& front, const Faces& rear, double com_x, double friction);

// The ways in which both wheel pairs may touch the ground at their places: in time, and where one has just passed a
// corner also as if it were `lag` late, on the face behind.
struct Touches {
    std::array<std::array<Faces, 2>, 3> ways;
    int count = 0;
};
Touches touches(const WheelPath& path, WheelPlaces s, double friction, double lag);

// Loads of one front and one rear wheel at a pair of places by the CoM's x, linear between a few samples of it, for
// each way of touching the ground. Samples are made when they are first needed: not for several threads at once.
class WheelLoads {
  public:
    static constexpr int kSamples = 17;
    // Of one way, by sample: force and moment of the front, then of the rear wheel, and whether forces hold the robot.
    struct Samples {
        std::array<std::array<double, kSamples>, 6> values;
        std::array<double, kSamples> held;  // 1 or 0
    };

    // For CoM positions in `com`; weight of the robot [N].
    WheelLoads(const WheelPath& path, WheelPlaces s, double friction, double lag, Interval com, double weight);

    int ways() const { return touches_.count; }
    // Nothing where no forces hold the robot that way.
    std::optional<std::array<WheelLoad, 2>> at(int way, double com_x) const;

    // Where a CoM lies among the samples: `first()` + k * `step()` is sample k; a step of 0 where there is but one place.
    double first() const { return first_; }
    double step() const { return step_; }
    // Those of one way, made where CoM positions from `low` to `high` need them.
    const Samples& samples(int way, double low, double high) const;

  private:
    double place(double com_x) const { return step_ > 0.0 ? std::clamp((com_x - first_) / step_, 0.0, kSamples - 1.0) : 0.0; }
    void make(int way, int first, int last) const;

    double first_ = 0.0, step_ = 0.0, friction_ = 0.0, weight_ = 0.0;
    std::array<Vec2, 2> centres_;
    Touches touches_;
    mutable std::array<Samples, 3> samples_;
    mutable std::array<std::uint32_t, 3> made_{};  // by way: bits of the samples that are made
};

}  // namespace stairwright
