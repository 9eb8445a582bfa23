#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/planning/frenet/frenet.h"

namespace trackbed {

/// Fast lookup of a path: nodes every quarter meter, and a series around each that continues its
/// curvature linearly. Accurate to 1e-8 m within clothoids; near joints accurate enough for the
/// coarse check.
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

/// Checks motions against a request and its limits.
class TrajectoryCheck {
 public:
  /// Tabulates the path up to the station `to`, for CheckCoarsely. Keeps references to all
  /// arguments but `to`.
  TrajectoryCheck(const Path& path, const FrenetRequest& request, const FrenetLimits& limits,
                  double to);

  /// Why no motion is possible from this start; none if one may be.
  [[nodiscard]] const std::optional<std::string>& blocked() const { return blocked_; }

  /// Checks a piece that begins `time` after the start, every `time_step` and more closely near its
  /// ends.
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
  /// How far the footprint extends to either side of the path, measured from the path's circle of
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
  // Limits, relaxed to include the start.
  double speed_ = 0.0;
  double slowest_ = 0.0;
  double acceleration_ = 0.0;
  double deceleration_ = 0.0;
  double lateral_acceleration_ = 0.0;
  double curvature_ = 0.0;
  double steering_rate_ = 0.0;
  double left_ = 0.0;
  double right_ = 0.0;
  double start_excess_ = 0.0;  // how far the start is beyond the edges [m]
  struct Obstacle {
    MovingBox box;
    double margin;  // required clearance
    double reach;   // no collision if the centers are farther apart
  };
  std::vector<Obstacle> obstacles_;
};

/// InternalError for limits out of range or a start that is not finite.
void CheckRequest(const FrenetRequest& request, const FrenetLimits& limits,
                  const FrenetWeights& weights);

}  // namespace trackbed
