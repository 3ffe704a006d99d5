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

// One robot on one terrain.
struct PoseProblem {
    PoseProblem(const Terrain& terrain, const WheelPath& path, const Robot& robot, const CollisionPoints& points)
        : terrain(terrain), path(path), robot(robot, points), cells(terrain_cells(terrain.vertices())) {}

    const Terrain& terrain;
    const WheelPath& path;
    PoseModel robot;
    std::vector<Cell> cells;
};

// Minimise the cost of eq 17 under eqs 18-22 from one first guess.
PoseSolution solve_pose(const PoseProblem& problem, const PoseTask& task, const Unknowns& start);

// Eq 17.
double cost(const PoseTask& task, const PoseState& state);

}  // namespace stairwright::poses
