// Which faces the wheels push on, and how hard: the gentlest way to hold the robot at rest.
#pragma once

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

// Loads of one front and one rear wheel at a pair of places by the CoM's x, linear between a few samples of it.
class WheelLoads {
  public:
    // For CoM positions in `com`; weight of the robot [N].
    WheelLoads(const WheelPath& path, WheelPlaces s, double friction, Interval com, double weight);

    std::array<WheelLoad, 2> at(double com_x) const;

  private:
    static constexpr int kSamples = 9;

    double first_ = 0.0, step_ = 0.0;  // m
    std::array<std::array<WheelLoad, 2>, kSamples> samples_;
};

}  // namespace stairwright
