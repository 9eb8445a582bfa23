#pragma once

#include <vector>

#include "tests/geometry/random.h"
#include "trackbed/core/angle.h"
#include "trackbed/geometry/pose.h"

namespace trackbed {

inline Pose2 RandomPose(Random& random, double reach) {
  return {random.Uniform(-reach, reach), random.Uniform(-reach, reach),
          random.Uniform(-2.0 * kPi, 2.0 * kPi)};
}

/// Returns poses at which tangents touch, circles coincide and arcs vanish. For curves with a
/// radius of 1 m, the coordinates are whole meters, and the headings are multiples of an eighth of
/// a turn.
inline std::vector<Pose2> DegeneratePoses() {
  std::vector<Pose2> poses;
  for (int x = -5; x <= 5; ++x) {
    for (int y = -5; y <= 5; ++y) {
      for (int turn = -4; turn <= 4; ++turn) {
        poses.push_back({1.0 * x, 1.0 * y, 0.25 * kPi * turn});
      }
    }
  }
  return poses;
}

inline Pose2 Mirror(const Pose2& pose) {
  return {pose.x, -pose.y, -pose.yaw};
}

/// Returns the pose rotated by half a turn in place.
inline Pose2 TurnedRound(const Pose2& pose) {
  return {pose.x, pose.y, pose.yaw + kPi};
}

/// Returns the distance between two poses, in which a heading difference of 1 rad counts as 1 m.
inline double Apart(const Pose2& a, const Pose2& b) {
  return (a.position() - b.position()).norm() + std::abs(AngleDifference(a.yaw, b.yaw));
}

}  // namespace trackbed
