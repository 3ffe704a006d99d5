// What a robot believes of itself and of the ground at one control step.
#pragma once

#include <optional>

#include "stairwright/control/face_search.hpp"
#include "stairwright/estimation/estimator.hpp"

namespace stairwright::execution {

struct Perceived {
    control::RobotState state;
    std::optional<std::array<double, 4>> places;  // of the wheels on the map, where they are known by themselves
    std::array<Vec2, 2> ground{};                 // how the pairs' ground differs, see estimation::Estimate
    std::array<bool, 2> feels_ground{};           // of each pair, a wheel; none where nothing is felt
    control::Ahead ahead{};
    std::optional<std::array<Vec2, 4>> felt;      // forces of the ground on the wheels, see estimation::Estimate
    std::array<double, 4> used_grip{};            // of the wheels, see estimation::Estimate
    bool lost = false;                            // its place on the map
    std::optional<estimation::MapError> map_error;
    std::array<double, 12> joints{}, joint_rates{};  // what the drives read now
};

// Of an estimate that is `late` [s]: a robot knows how late its loop is, so the state is that of now, by constant rates.
// The drives' own loops are not late: they close on their own encoders, whose readings are `now`.
Perceived perceived(const estimation::Estimate& estimate, const estimation::Readings& now, double late = 0.0);

}  // namespace stairwright::execution
