// Errors of the map that the plan was made to stand: they are not worth another one.
#pragma once

#include <cmath>

#include "stairwright/estimation/estimator.hpp"

namespace stairwright::execution {

class MapTolerance {
  public:
    // How far each tread may be off up, and each face along [m]; less than 0 where the plan was made for no error.
    void set(double height, double place) { height_ = height, place_ = place; }

    bool covers(const estimation::MapError& error) const {
        if (error.pairs == 0) return false;  // wheels that a riser stopped before they were there by the plan
        // A face is found from the one before, which may be off the other way.
        if (error.face) return std::abs(error.off.x) <= 2.0 * place_ + kFound;
        return std::abs(error.off.z - (is_new(error) ? here_ : before_)) <= height_ + kFound;
    }
    // Told for as long as wheels are there: the next tread is compared with this one.
    void pass(const estimation::MapError& error) {
        if (error.face) return;
        if (is_new(error)) before_ = here_;
        s_ = error.s, here_ = error.off.z;
    }
    // After a correction of the map, in which no tread is off that was passed.
    void forget() { here_ = before_ = 0.0; }

    static constexpr double kSamePlace = 0.15;  // m; an error so near is the same one

  private:
    static constexpr double kFound = 0.006;  // m to which errors are found

    bool is_new(const estimation::MapError& error) const { return std::abs(error.s - s_) > kSamePlace; }

    double height_ = -1.0, place_ = -1.0;
    double s_ = 0.0, here_ = 0.0, before_ = 0.0;  // of the tread that was found off last, and of the one before it
};

}  // namespace stairwright::execution
