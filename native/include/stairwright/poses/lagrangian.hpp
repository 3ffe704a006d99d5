// The cost's gradient and the Lagrangian's Hessian by the five unknowns, exact.
#pragma once

#include "stairwright/poses/constraints.hpp"

namespace stairwright::poses {

using GradientY = std::array<double, kUnknowns>;
using HessianY = std::array<GradientY, kUnknowns>;

// Rows that held the last step back, and their multipliers.
struct ActiveRows {
    std::vector<Constraint> rows;
    std::vector<double> multipliers;
};

// Gradient by y from the gradient by u.
GradientY reduce(const PoseState& state, const GradientU& gradient);

// Gradient of the cost (eq 17) and Hessian of the Lagrangian.
void lagrangian(const PoseModel& model, const PoseTask& task, const PoseState& state, const ActiveRows& active,
                GradientY& gradient, HessianY& hessian);

}  // namespace stairwright::poses
