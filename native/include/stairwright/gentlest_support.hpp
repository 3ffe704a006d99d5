// Which faces the wheels push on, and how hard: the gentlest way to hold the robot at rest.
#pragma once

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
// each way of touching the ground.
class WheelLoads {
  public:
    // For CoM positions in `com`; weight of the robot [N].
    WheelLoads(const WheelPath& path, WheelPlaces s, double friction, double lag, Interval com, double weight);

    int ways() const { return count_; }
    // Nothing where no forces hold the robot that way.
    std::optional<std::array<WheelLoad, 2>> at(int way, double com_x) const;

  private:
    static constexpr int kSamples = 17;
    struct Sample {
        std::array<WheelLoad, 2> loads;
        bool held = false;
    };

    double first_ = 0.0, step_ = 0.0;  // m
    int count_ = 0;
    std::array<std::array<Sample, kSamples>, 3> samples_;
};

}  // namespace stairwright
