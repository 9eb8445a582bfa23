#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/path/path.h"
#include "trackbed/vehicle/params.h"

namespace trackbed {

/// Tests whether a car's footprint keeps a required distance from boxes. A CollisionChecker is
/// immutable and designed for many queries.
class CollisionChecker {
 public:
  /// Upper bound of the result of farthest(), which applies to long cars [m].
  static constexpr double kMaxClearance = 4.0;

  /// A car that starts near a box must keep this fraction of its start distance while it leaves the
  /// box. A car that turns away from a wall beside it cannot keep the whole distance: its rear
  /// swings toward the wall.
  static constexpr double kShareOfStart = 0.5;

  /// `distance` [m], >= 0, is the required distance of the footprint from every box. Throws
  /// PreconditionError if a box has a number that is not finite. The required memory grows with the
  /// area over which the boxes are spread, up to an extent of about 2 km for a car.
  CollisionChecker(const VehicleParams& vehicle, std::vector<OrientedBox> boxes, double distance);

  /// Same as the constructor without `start`, but for a car that may leave the pose `start`. If a
  /// box is nearer than `distance` to the footprint at `start`, the car need only keep the fraction
  /// kShareOfStart of its distance at `start` from the box. The pose `start` is free unless a box
  /// overlaps the footprint at `start`.
  CollisionChecker(const VehicleParams& vehicle, std::vector<OrientedBox> boxes, double distance,
                   const Pose2& start);

  /// Returns the required distance of the footprint from each box [m], >= 0.
  [[nodiscard]] const std::vector<double>& distances() const { return distances_; }

  /// Returns the radius of the largest circle around the middle of the rear axle inside the
  /// footprint [m]; 0 if the rear axle is not inside the footprint.
  [[nodiscard]] double inner_radius() const;

  /// Returns whether the circle of the radius inner_radius() around `position` is clear of all
  /// boxes. If the circle around `position` is not clear, a car with the middle of its rear axle
  /// there collides at every heading.
  [[nodiscard]] bool MayBeFree(const Vec2& position) const;

  /// Returns the largest value that Clearance can return [m]: the car's length, but at most
  /// kMaxClearance.
  [[nodiscard]] double farthest() const { return farthest_; }

  /// Returns the clearance of the footprint from the nearest box minus the required distance [m].
  /// The returned clearance is exact, not an estimate. The clearance is negative if the footprint
  /// is too near to a box, and never exceeds `at_most` and farthest(). Throws PreconditionError if
  /// the pose is not finite. Computing time of a clearance: a few ns for each nearby box, about 50
  /// ns for each box that may be the nearest one.
  [[nodiscard]] double Clearance(const Pose2& pose,
                                 double at_most = std::numeric_limits<double>::infinity()) const;

  [[nodiscard]] bool IsFree(const Pose2& pose) const { return Clearance(pose, 0.0) >= 0.0; }

  /// Returns the first tested station at which the car is too near to a box; nullopt if the car is
  /// clear at all tested stations. The search for a blocked station advances along the path by the
  /// distance that the clearance guarantees to be free. Each step of the search along the path is
  /// at least 2 cm long (for a car shorter than 1 m, a fiftieth of its length). Between two tested
  /// stations, the clearance may be negative, by at most half of the smallest step times the motion
  /// of the footprint's fastest corner per meter of path.
  [[nodiscard]] std::optional<double> FirstBlocked(const Path& path) const;

  /// Returns whether the car is clear of all boxes along an arc or a line, tested as in
  /// FirstBlocked.
  [[nodiscard]] bool IsFree(const Pose2& start, const Segment& segment) const;

 private:
  VehicleParams vehicle_;
  std::vector<OrientedBox> boxes_;
  std::vector<Vec2> along_;        // Unit vectors along the lengths of the boxes.
  double distance_;                // Largest of the required distances from the boxes.
  std::vector<double> distances_;  // Required distance from each box.
  double farthest_;
  double middle_;  // Distance from the rear axle forward to the middle of the footprint.
  double radius_;  // Radius of the circle that encloses the footprint.
  double step_;    // Smallest step between tested stations of a path.
  double reach_;   // Distance from the rear axle to the footprint's farthest corner.

  void FillBins();

  // Returns the next station to test after station `at`, where the clearance was `room`. The
  // clearance `room` guarantees that the path is free up to the returned station, unless the step
  // is the smallest one. The argument `moved` is the largest motion of a point of the footprint per
  // meter of path.
  [[nodiscard]] double NextCheck(const Pose2& pose, double room, double moved, double at,
                                 double length) const;

  // Returns the boxes that can be the nearest one for a car with the middle of its footprint at
  // `middle`.
  [[nodiscard]] const std::vector<int>* Near(const Vec2& middle) const;
  double bin_ = 0.0;  // Side length of a square bin of boxes [m].
  Vec2 low_{0.0, 0.0};
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::vector<int>> bins_;
};

}  // namespace trackbed
