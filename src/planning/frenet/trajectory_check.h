#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/planning/frenet/frenet.h"

namespace trackbed {

/// Table for fast lookup of path points, with nodes every quarter meter. Around each node, a series
/// continues the curvature of the path linearly. Within clothoids, the lookup is accurate to 1e-8
/// m. Near joints, the lookup is accurate enough for the coarse check.
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

/// Checks motions against a request and the limits of the request.
class TrajectoryCheck {
 public:
  /// Tabulates the path up to the station `to`, for CheckCoarsely. Keeps references to all
  /// arguments except `to`.
  TrajectoryCheck(const Path& path, const FrenetRequest& request, const FrenetLimits& limits,
                  double to);

  /// Reason why no motion is possible from the start; none if a motion may be possible.
  [[nodiscard]] const std::optional<std::string>& blocked() const { return blocked_; }

  /// Checks a piece that begins `time` after the start. The check samples the piece every
  /// `time_step`, and more closely near the ends of the piece.
  [[nodiscard]] std::optional<Rejection> CheckCoarsely(const FrenetPiece& piece, double time) const;

  struct Flaw {
    Rejection rejection;
    double time;  ///< [s]
  };
  /// The first point of a motion that violates a limit.
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
  /// Extent of the footprint to either side of the path, measured from the path's circle of
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
  // Limits, relaxed so that the start does not violate the limits.
  double speed_ = 0.0;
  double slowest_ = 0.0;
  double acceleration_ = 0.0;
  double deceleration_ = 0.0;
  double lateral_acceleration_ = 0.0;
  double curvature_ = 0.0;
  double steering_rate_ = 0.0;
  double left_ = 0.0;
  double right_ = 0.0;
  double start_excess_ = 0.0;  // Distance of the start beyond the edges [m].
  struct Obstacle {
    MovingBox box;
    double margin;  // Required clearance.
    double reach;   // Distance between the centers beyond which no collision is possible.
  };
  std::vector<Obstacle> obstacles_;
};

/// Throws InternalError for limits out of range or a start that is not finite.
void CheckRequest(const FrenetRequest& request, const FrenetLimits& limits,
                  const FrenetWeights& weights);

}  // namespace trackbed
