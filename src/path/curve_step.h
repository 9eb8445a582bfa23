#pragma once

#include <Eigen/Core>

#include "src/path/least_variation.h"

// One step of the linear-quadratic control problem of LeastVariationCurve.

namespace trackbed {

// Indices of the extended state of a curve node. The index kMultiplier + i is the Lagrange
// multiplier of the end condition on the state i.
enum CurveState : int { kOffset, kHeading, kCurvature, kSharpness, kOne, kMean, kMultiplier };
inline constexpr int kStates = 4;
inline constexpr int kSize = kMultiplier + kStates;
using StateMatrix = Eigen::Matrix<double, kSize, kSize>;
using StateRow = Eigen::Matrix<double, 1, kSize>;
using StateVector = Eigen::Matrix<double, kSize, 1>;

/// The linearized motion from a node to the next node, for a change u of the next node's sharpness.
struct CurveStep {
  Eigen::Matrix<double, 3, kSize> next;  // Offset, heading and curvature of the next node.
  Eigen::Vector3d control;               // Effect of u on the next node's state.
  StateRow length;                       // Change of the length between the nodes.
  double length_control = 0.0;
  StateRow gain;  // The optimal u is gain * state.
};

/// Returns the segment between two nodes.
Segment SegmentBetween(const CurveNode& from, const CurveNode& to);

/// Returns the end node of the segment that begins at `from` and has the end sharpness and length
/// of `to`.
CurveNode Follow(const CurveNode& from, const CurveNode& to);

/// Linearizes the motion from node `from`, which moves by `slide` [m] along the curve, to the node
/// `to`, which moves by `next_slide` [m].
CurveStep Linearize(const CurveNode& from, const CurveNode& to, double slide, double next_slide);

/// Adds the cost weight/2 (row * state)^2 to the matrix `cost`.
void AddSquare(StateMatrix& cost, const StateRow& row, double weight);

/// Eliminates the control u (the change of the next sharpness) by computing step.gain. Returns the
/// matrix of the cost from the node `from` on. `smoothing` is the weight of the curvature's
/// variation between the nodes.
StateMatrix Eliminate(CurveStep& step, const StateMatrix& next_cost, const CurveNode& from,
                      const CurveNode& to, double smoothing);

}  // namespace trackbed
