// Residuals of one node, and their derivatives by finite differences.
#pragma once

#include "surprises.hpp"
#include "stairwright/smoothing/smoothing.hpp"

namespace stairwright::smoothing {

// Order of a node's residuals; the first ones, up to kHinges, are never negative.
enum Residual {
    kComLow, kComHigh, kReserveLow, kReserveHigh, kLaggedLow, kLaggedHigh,
    kTrunk, kLinks, kLegs, kJoints, kReach, kTrunkRoom, kLinksRoom,
    kSurprisedFrontThigh, kSurprisedFrontCalf, kSurprisedFrontTrunk, kSurprisedRearThigh, kSurprisedRearCalf, kSurprisedRearTrunk,
    kFrontThighLimit, kFrontCalfLimit, kFrontWheelLimit, kRearThighLimit, kRearCalfLimit, kRearWheelLimit,
    kPitch, kHeight, kFrontThigh, kFrontCalf, kRearThigh, kRearCalf, kResiduals,
};
inline constexpr int kHinges = kPitch;

using Residuals = std::array<double, kResiduals>;
using NodeJacobian = std::array<Residuals, 3>;  // by x, z, pitch

QueryRadii query_radii(const Objective& objective);  // nothing farther away pulls [m]

Residuals residuals(const SmoothingProblem& problem, std::size_t node, const Body& body, const PoseGeometry& geometry,
                    const SurpriseClearances& surprised);
NodeJacobian differentiate(const SmoothingProblem& problem, std::size_t node, const Body& body,
                           const PoseGeometry& geometry, const Residuals& at);
// Residuals of a node that has moved a little from where `at` and `jacobian` were computed.
Residuals extrapolate(const Residuals& at, const NodeJacobian& jacobian, const Body& from, const Body& to);

}  // namespace stairwright::smoothing
