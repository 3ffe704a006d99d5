// Sequential quadratic programming for one pose: five unknowns, exact derivatives.
//
// Unknown are y = (x, z, pitch, s_front, s_rear); joints follow in closed form, so that every iterate has its wheels on
// the terrain. Hessians are exact, made positive by lifting eigenvalues; steps are judged by cost plus penalty times
// the largest violation.
#pragma once

#include <optional>

#include "stairwright/poses/constraints.hpp"

namespace stairwright::poses {

struct PoseSolution {
    Variables x{};  // NaN where no pose reaches
    double cost = std::numeric_limits<double>::infinity();
    double violation = std::numeric_limits<double>::infinity();  // the largest [m or rad]
    int iterations = 0;
};

// Robot and terrain of pose problems.
struct PoseWorld {
    const PoseModel& robot;
    const WheelPath& path;
    const std::vector<Cell>& cells;
    const Terrain& terrain;
};

// Minimise the cost of eq 17 under eqs 18-22 from one first guess.
PoseSolution solve_pose(const PoseWorld& world, const PoseTask& task, const Unknowns& start);

// Eq 17.
double cost(const PoseTask& task, const PoseState& state);

}  // namespace stairwright::poses
