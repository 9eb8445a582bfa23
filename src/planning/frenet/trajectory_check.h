#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/planning/frenet/frenet.h"

namespace trackbed {

/// Table for fast lookup of path points; its nodes are 0.25 m apart. Between the nodes, points are
/// computed by a series expansion that assumes linear curvature. The lookup error is at most 1e-8 m
/// within clothoids; near joints of segments, it is small enough for the coarse check.
class PathTable {
 public:
  PathTable(const Path& path, Stations within);

  [[nodiscard]] PathPoint At(double s) const;

 private:
  struct Node {
    PathPoint point;
    Vec2 forward;
  };
  double from_;
  std::vector<Node> nodes_;
};

/// Checks whether motions satisfy a planning request and the limits of this request.
class TrajectoryCheck {
 public:
  /// Tabulates the path up to the station `to`, for CheckCoarsely. All arguments except `to` must
  /// outlive this object.
  TrajectoryCheck(const Path& path, const FrenetRequest& request, const FrenetLimits& limits,
                  double to);

  /// Returns the reason why no motion is possible from the start; nullopt if a motion may be
  /// possible.
  [[nodiscard]] const std::optional<std::string>& blocked() const { return blocked_; }

  /// Checks a piece of a motion that begins `time` [s] after the start, at samples every
  /// `time_step` and at additional samples near the ends of the piece.
  [[nodiscard]] std::optional<Rejection> CheckCoarsely(const FrenetPiece& piece, double time) const;

  struct Flaw {
    Rejection rejection;
    double time;  ///< [s]
  };
  /// Returns the first violation of a limit in a motion; nullopt if all points satisfy the limits.
  [[nodiscard]] std::optional<Flaw> CheckFinely(const std::vector<TrajectoryPoint>& points) const;

 private:
  struct PreviousPoint {
    double time;
    double steering;
  };
  [[nodiscard]] std::optional<Rejection> CheckPoint(double time, const PathPoint& at,
                                                    const FrenetState& frenet,
                                                    const MotionState& motion,
                                                    std::optional<PreviousPoint>& before) const;
  /// Largest offset of the footprint to each side of the path, measured from the path's circle of
  /// curvature.
  struct Reach {
    double left;
    double right;
  };
  [[nodiscard]] Reach ComputeReach(const PathPoint& at, const FrenetState& frenet) const;
  [[nodiscard]] bool Collides(double time, const Pose2& pose) const;

  const Path& path_;
  const FrenetRequest& request_;
  const FrenetLimits& limits_;
  PathTable table_;
  std::optional<std::string> blocked_;
  // Limits of motions, relaxed just enough that the start state satisfies all limits.
  double speed_ = 0.0;
  double slowest_ = 0.0;
  double acceleration_ = 0.0;
  double deceleration_ = 0.0;
  double lateral_acceleration_ = 0.0;
  double curvature_ = 0.0;
  double steering_rate_ = 0.0;
  double left_ = 0.0;
  double right_ = 0.0;
  // Distance by which the footprint at the start extends beyond the road edges [m].
  double start_excess_ = 0.0;
  struct Obstacle {
    MovingBox box;
    double margin;  // Required clearance [m].
    double reach;   // Distance between the centers of car and obstacle beyond which no collision is
                    // possible [m].
  };
  std::vector<Obstacle> obstacles_;
};

/// Throws InternalError if a limit or a weight is out of range or the start state is not finite.
void CheckRequest(const FrenetRequest& request, const FrenetLimits& limits,
                  const FrenetWeights& weights);

}  // namespace trackbed
