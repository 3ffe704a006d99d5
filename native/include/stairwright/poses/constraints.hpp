// Constraints of one pose as rows "value >= 0": value, gradient and curvature by u = (x, z, angles, s_front, s_rear).
//
// A distance between convex shapes is the best separating axis (a hard maximum); each corner that supports the shape
// on that axis is a row of its own, so that rows are smooth.
#pragma once

#include <limits>
#include <vector>

#include "stairwright/poses/pose_model.hpp"
#include "stairwright/statics.hpp"

namespace stairwright::poses {

using GradientU = std::array<double, kU>;
using HessianU = std::array<GradientU, kU>;

// What is asked of a pose. SI units.
struct PoseTask {
    std::array<double, 7> reference{}, weights{};  // of eq 17: x, z, pitch, joints
    Variables lower{}, upper{};                    // x, z, pitch are free
    double clearance = 0.0;                        // least distance of trunk and links (or points) from the ground
    double legs_distance = 0.0;                    // least distance of the front leg from the rear one
    double behind = -std::numeric_limits<double>::infinity();  // least distance of the rear contact behind the rear hip (eq 20)
    bool exact_links = true;                       // keep whole links clear instead of the collision points (eq 21)
    Interval com{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};  // of the CoM's x
};

struct Constraint {
    enum Kind {
        kJoint,   // sign * (angle i - angle j) >= bound: a joint's limit
        kPlace,   // sign * s_i >= bound: a wheel's place
        kBehind,  // x of point i - x of the rear contact >= bound (eq 20)
        kPlane,   // normal . point i >= bound: clear of a face of the ground
        kAcross,  // sign * (normal that turns with angle j) . (fixed or point i - point k) >= bound
        kApart,   // |point i - point k| >= bound
        kCom,     // sign * x of the centre of mass >= bound
    };

    Kind kind = kJoint;
    int i = -1, j = -1, k = -1;  // points or angles; kAcross with i < 0: the fixed point
    Vec2 normal, fixed;
    double sign = 1.0;
    double value = 0.0;  // slack [m or rad]
};

// Constraints near their bounds, and the least slack of all.
struct Constraints {
    std::vector<Constraint> rows;
    double least = 0.0;
};

void collect(const PoseModel& model, const std::vector<Cell>& cells, const PoseTask& task, const PoseState& state,
             Constraints& out);

GradientU gradient(const PoseState& state, const Constraint& row);
// Add `factor` times the second derivative of a row.
void add_curvature(const PoseState& state, const Constraint& row, double factor, HessianU& hessian);

}  // namespace stairwright::poses
