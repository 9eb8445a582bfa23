#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/planning/frenet/frenet.h"

namespace trackbed {

/// A path looked up by the thousand: points every quarter meter, and a series around each, as if
/// the curvature went on evenly. Good to 1e-8 m within clothoids; near joints good enough for a
/// first look.
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

/// Whether motions keep to what a request and its limits allow.
class TrajectoryCheck {
 public:
  /// Knows the path up to the station `to`, for Coarse. Keeps references to all.
  TrajectoryCheck(const Path& path, const FrenetRequest& request, const FrenetLimits& limits,
                  double to);

  /// Why there is no motion from this start; none where there may be.
  [[nodiscard]] const std::optional<std::string>& blocked() const { return blocked_; }

  /// A piece that begins `time` after the start, looked at every `time_step` and near its ends.
  [[nodiscard]] std::optional<Rejection> Coarse(const FrenetPiece& piece, double time) const;

  struct Flaw {
    Rejection rejection;
    double time;  ///< [s]
  };
  /// The first point of a motion that does not do.
  [[nodiscard]] std::optional<Flaw> Fine(const std::vector<TrajectoryPoint>& points) const;

 private:
  struct Before {
    double time;
    double steering;
  };
  [[nodiscard]] std::optional<Rejection> CheckPoint(double time, const PathPoint& at,
                                                    const FrenetState& frenet,
                                                    const MotionState& motion,
                                                    std::optional<Before>& before) const;
  /// How far the footprint reaches to either side of the path, as seen along the circle that the
  /// path follows there.
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
  // What holds, loosened to where the start is.
  double speed_ = 0.0;
  double slowest_ = 0.0;
  double acceleration_ = 0.0;
  double deceleration_ = 0.0;
  double lateral_acceleration_ = 0.0;
  double curvature_ = 0.0;
  double steering_rate_ = 0.0;
  double left_ = 0.0;
  double right_ = 0.0;
  double beyond_ = 0.0;  // the edges
  struct Obstacle {
    MovingBox box;
    double margin;  // keep more than this
    double reach;   // centers further apart than this are clear
  };
  std::vector<Obstacle> obstacles_;
};

/// InternalError for limits out of range or a start that is not finite.
void CheckRequest(const FrenetRequest& request, const FrenetLimits& limits,
                  const FrenetWeights& weights);

}  // namespace trackbed
