#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/path/path.h"
#include "trackbed/vehicle/params.h"

namespace trackbed {

/// Tests whether a car's footprint keeps a distance from boxes; fast for many queries. The checker
/// is immutable.
class CollisionChecker {
 public:
  /// Upper bound on the cap of clearances, for long cars [m].
  static constexpr double kMaxClearance = 4.0;

  /// `distance` [m], >= 0, is the required distance of the footprint from every box.
  /// PreconditionError unless the boxes are finite. Memory stops growing with the extent of the
  /// boxes, from about 2 km for a car.
  CollisionChecker(const VehicleParams& vehicle, std::vector<OrientedBox> boxes, double distance);

  /// The cap on clearances [m]: the car's length, at most kMaxClearance.
  [[nodiscard]] double farthest() const { return farthest_; }

  /// The clearance of the footprint from the nearest box minus the required distance [m]. The
  /// result is exact, negative if the footprint is too near, and at most `at_most` and farthest().
  /// PreconditionError for a pose that is not finite. Cost: a few ns for each nearby box, about 50
  /// ns for each box that may be the nearest.
  [[nodiscard]] double Clearance(const Pose2& pose,
                                 double at_most = std::numeric_limits<double>::infinity()) const;

  [[nodiscard]] bool IsFree(const Pose2& pose) const { return Clearance(pose, 0.0) >= 0.0; }

  /// The first station at which the car is too near to a box; nullopt if there is none. Advances by
  /// the distance that the clearance guarantees to be free, and at least by 2 cm (for a car shorter
  /// than 1 m, a fiftieth of its length). The clearance may therefore be violated by at most half
  /// that step times the rotation of the footprint's farthest corner.
  [[nodiscard]] std::optional<double> FirstBlocked(const Path& path) const;

  /// Whether an arc or a line is free from its start to its end, tested as in FirstBlocked.
  [[nodiscard]] bool IsFree(const Pose2& start, const Segment& segment) const;

 private:
  VehicleParams vehicle_;
  std::vector<OrientedBox> boxes_;
  std::vector<Vec2> along_;  // Directions along the boxes' lengths.
  double distance_;
  double farthest_;
  double middle_;  // Middle of the footprint, ahead of the rear axle.
  double radius_;  // Radius of the circle around the footprint.
  double step_;    // Smallest step along a path.
  double reach_;   // Distance from the rear axle to the footprint's farthest corner.

  void FillBins();

  // The next station to test after station `at`, where the clearance was `room`. The clearance
  // guarantees that the path is free up to that station. `moved` is the motion of the footprint per
  // meter of path.
  [[nodiscard]] double NextCheck(const Pose2& pose, double room, double moved, double at,
                                 double length) const;

  // The boxes that matter for a car whose footprint's middle is in a given bin of the plane.
  [[nodiscard]] const std::vector<int>* Near(const Vec2& middle) const;
  double bin_ = 0.0;  // Side of a bin [m].
  Vec2 low_{0.0, 0.0};
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::vector<int>> bins_;
};

}  // namespace trackbed
