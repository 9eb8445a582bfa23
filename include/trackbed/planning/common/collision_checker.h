#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/path/path.h"
#include "trackbed/vehicle/params.h"

namespace trackbed {

/// Whether a car's footprint keeps a distance from boxes, asked many thousand times. Immutable.
class CollisionChecker {
 public:
  /// Clearances are told apart up to this [m] by cars that are longer.
  static constexpr double kFarthest = 4.0;

  /// `distance` [m], >= 0, is what the footprint keeps from every box. PreconditionError unless the
  /// boxes are finite. Takes no more memory the farther apart they are, from 2 km on for a car.
  CollisionChecker(const VehicleParams& vehicle, std::vector<OrientedBox> boxes, double distance);

  /// No clearance beyond this is told apart [m]: the car's length, at most kFarthest.
  [[nodiscard]] double farthest() const { return farthest_; }

  /// What is left between the footprint and the nearest box beyond the distance [m]: exact,
  /// negative when it is too near, `at_most` or farthest() when it is more. PreconditionError for
  /// a pose that is not finite. Cost: some ns for each box near by, about 50 ns for each of those
  /// that may be the nearest.
  [[nodiscard]] double Clearance(const Pose2& pose,
                                 double at_most = std::numeric_limits<double>::infinity()) const;

  [[nodiscard]] bool IsFree(const Pose2& pose) const { return Clearance(pose, 0.0) >= 0.0; }

  /// The first station at which the car is too near to a box, or none. Goes forward by as much as
  /// the clearance surely allows, and by 2 cm where there is none, a car shorter than 1 m by a
  /// fiftieth of its length: what is found free is off by half of that times the turn of the
  /// footprint's farthest corner at most.
  [[nodiscard]] std::optional<double> FirstBlocked(const Path& path) const;

  /// Whether an arc or a line is free from its start to its end; the same, without a path.
  [[nodiscard]] bool IsFree(const Pose2& start, const Segment& segment) const;

 private:
  VehicleParams vehicle_;
  std::vector<OrientedBox> boxes_;
  std::vector<Vec2> along_;  // directions of the boxes' lengths
  double distance_;
  double farthest_;
  double middle_;  // of the footprint, ahead of the rear axle
  double radius_;  // of the circle around the footprint
  double step_;    // along a path at least
  double reach_;   // from the rear axle to the footprint's farthest corner

  void FillBins();

  // Where along a path to look next after a look at `at` that found `room`: as far on as the room
  // surely allows. `moved`: by the footprint, per meter of path.
  [[nodiscard]] double NextLook(const Pose2& pose, double room, double moved, double at,
                                double length) const;

  // Which boxes matter for a car whose footprint's middle is in a bin of the plane.
  [[nodiscard]] const std::vector<int>* Near(const Vec2& middle) const;
  double bin_ = 0.0;  // side of a bin [m]
  Vec2 low_{0.0, 0.0};
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::vector<int>> bins_;
};

}  // namespace trackbed
