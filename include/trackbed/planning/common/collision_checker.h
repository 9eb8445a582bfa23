#pragma once

#include <optional>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/path/path.h"
#include "trackbed/vehicle/params.h"

namespace trackbed {

/// Whether a car's footprint keeps a distance from boxes, asked many thousand times. Immutable.
class CollisionChecker {
 public:
  /// No room beyond this is told apart [m].
  static constexpr double kFarthest = 4.0;

  /// `distance` [m], >= 0, is what the footprint keeps from every box. PreconditionError unless the
  /// boxes are finite. Takes no more memory the farther apart they are, from 2 km on.
  CollisionChecker(const VehicleParams& vehicle, std::vector<OrientedBox> boxes, double distance);

  /// What is left between the footprint and the nearest box beyond the distance [m]: exact,
  /// negative when it is too near, kFarthest when it is more. PreconditionError for a pose that is
  /// not finite. Cost: the boxes near by, about 50 ns each.
  [[nodiscard]] double Clearance(const Pose2& pose) const;

  [[nodiscard]] bool IsFree(const Pose2& pose) const { return Clearance(pose) >= 0.0; }

  /// The first station at which the car is too near to a box, or none. Goes forward by as much as
  /// the room surely allows, and by 2 cm where there is none, a car shorter than 1 m by a
  /// fiftieth of its length: what is found free is off by half of that times the turn of the
  /// footprint's farthest corner at most.
  [[nodiscard]] std::optional<double> FirstBlocked(const Path& path) const;

  /// Whether an arc or a line is free from its start to its end; the same, without a path.
  [[nodiscard]] bool IsFree(const Pose2& start, const Segment& segment) const;

 private:
  VehicleParams vehicle_;
  std::vector<OrientedBox> boxes_;
  std::vector<double> radii_;  // of circles around the boxes
  double distance_;
  double middle_;  // of the footprint, ahead of the rear axle
  double radius_;  // of the circle around the footprint
  double step_;    // along a path at least
  double reach_;   // from the rear axle to the footprint's farthest corner

  // Which boxes matter for a car whose footprint's middle is in a bin of the plane.
  [[nodiscard]] const std::vector<int>* Near(const Vec2& middle) const;
  double bin_ = 0.0;  // side of a bin [m]
  Vec2 low_{0.0, 0.0};
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::vector<int>> bins_;
};

}  // namespace trackbed
