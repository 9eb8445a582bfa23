#pragma once

#include "trackbed/geometry/pose.h"
#include "trackbed/planning/curves/shortest_curve.h"

namespace trackbed {

/// Returns the end pose of a curve from `start`, computed by driving the arcs of its pieces one
/// after the other.
inline Pose2 EndPose(const Pose2& start, const ShortestCurve& curve) {
  Pose2 pose = start;
  for (int i = 0; i < curve.count; ++i) {
    const CurvePiece& piece = curve.pieces[static_cast<std::size_t>(i)];
    pose =
        MoveOnArc(pose, piece.sweep * curve.radius, piece.sweep * static_cast<double>(piece.bend));
  }
  return pose;
}

}  // namespace trackbed
