#pragma once

#include <Eigen/Core>

#include "src/path/least_variation.h"

// One step of the linear-quadratic control problem of LeastVariationCurve.

namespace trackbed {

// Indices of the extended state. The index kMultiplier + i is the multiplier of the end condition
// on the state i.
enum CurveState : int { kOffset, kHeading, kCurvature, kSharpness, kOne, kMean, kMultiplier };
inline constexpr int kStates = 4;
inline constexpr int kSize = kMultiplier + kStates;
using StateMatrix = Eigen::Matrix<double, kSize, kSize>;
using StateRow = Eigen::Matrix<double, 1, kSize>;
using StateVector = Eigen::Matrix<double, kSize, 1>;

/// The linearized motion from a node to the next node, for a change u of the next node's sharpness.
struct CurveStep {
  Eigen::Matrix<double, 3, kSize> next;  // Offset, heading and curvature of the next node.
  Eigen::Vector3d control;               // Effect of u on offset, heading and curvature.
  StateRow length;                       // Change of the length between the nodes.
  double length_control = 0.0;
  StateRow gain;  // The optimal u.
};

/// Returns the segment between two nodes.
Segment SegmentBetween(const CurveNode& from, const CurveNode& to);

/// Returns the end of the segment that begins at `from` and has the sharpness and length of `to`.
CurveNode Follow(const CurveNode& from, const CurveNode& to);

/// Linearizes the motion from node `from`, which moves by `slide` [m] along the curve, to the node
/// `to`, which moves by `next_slide` [m].
CurveStep Linearize(const CurveNode& from, const CurveNode& to, double slide, double next_slide);

/// Adds the cost weight/2 (row * state)^2 to the matrix `cost`.
void AddSquare(StateMatrix& cost, const StateRow& row, double weight);

/// Eliminates the control: computes step.gain, and returns the cost of the state from the node
/// `from` on. `smoothing` weighs the variation of the curvature between the nodes.
StateMatrix Eliminate(CurveStep& step, const StateMatrix& next_cost, const CurveNode& from,
                      const CurveNode& to, double smoothing);

}  // namespace trackbed
