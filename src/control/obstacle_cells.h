#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "trackbed/control/surroundings.h"
#include "trackbed/geometry/pose.h"

namespace trackbed {

/// A rectangle whose heading is stored as cosine and sine.
struct Rectangle {
  double x = 0.0;  ///< Middle [m].
  double y = 0.0;
  double cosine = 1.0;
  double sine = 0.0;
  double half_length = 0.0;  ///< [m]
  double half_width = 0.0;   ///< [m]
};

/// Returns the largest gap between two rectangles along the axes of both rectangles [m]. A negative
/// gap means that the rectangles overlap. The gap of disjoint rectangles is at most their distance,
/// and at least their distance divided by sqrt(2).
double GapOf(const Rectangle& a, const Rectangle& b);

/// Stores the obstacles near a car in a grid, for fast queries of the distance. All coordinates are
/// in a frame A that is fixed in the world.
class ObstacleCells {
 public:
  /// Stores the obstacles that may come within `margin` [m] of the car during `duration` [s]. The
  /// middle of the car must stay within `reach` [m] of the origin of the frame A. The argument
  /// `radius` [m] is the radius of the circle around the car.
  void Take(const std::vector<SeenObstacle>& obstacles, const Pose2& X_WA, double reach,
            double radius, double margin, double duration);

  [[nodiscard]] bool empty() const { return still_.empty() && moving_.empty(); }
  /// Returns the smallest gap (GapOf) between the car and any obstacle at `time` [s], but at most
  /// `margin`.
  [[nodiscard]] double Gap(const Rectangle& car, double time) const;

 private:
  struct Moving {
    Rectangle at_start;
    Vec2 velocity = Vec2::Zero();
    double yaw = 0.0;
    double yaw_rate = 0.0;
  };
  void FillCells();
  [[nodiscard]] std::size_t CellOf(double x, double y) const;

  static constexpr int kCellsPerSide = 48;
  double reach_ = 0.0;
  double radius_ = 0.0;
  double margin_ = 0.0;
  std::vector<Rectangle> still_;
  std::vector<Moving> moving_;
  // The rectangles near grid cell i are still_[members_[k]] for begins_[i] <= k < begins_[i + 1].
  std::vector<std::size_t> begins_;
  std::vector<std::pair<std::size_t, std::size_t>> pairs_;  // Indices of grid cell and rectangle.
  std::vector<std::size_t> members_;
};

}  // namespace trackbed
