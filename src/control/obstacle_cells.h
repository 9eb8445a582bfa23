#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "trackbed/control/surroundings.h"
#include "trackbed/geometry/pose.h"

namespace trackbed {

/// A rectangle whose direction is given by its cosine and sine.
struct Rectangle {
  double x = 0.0;  ///< Middle [m].
  double y = 0.0;
  double cosine = 1.0;
  double sine = 0.0;
  double half_length = 0.0;  ///< [m]
  double half_width = 0.0;   ///< [m]
};

/// Returns the largest gap between two rectangles along the axes of both: negative exactly if they
/// overlap, otherwise at most their distance [m], and at least their distance divided by sqrt(2).
double GapOf(const Rectangle& a, const Rectangle& b);

/// The obstacles near a car, in cells of a grid for fast queries. All coordinates are in a frame A
/// of the world.
class ObstacleCells {
 public:
  /// Stores the obstacles whose distance from the car may be below `margin` [m] within `duration`
  /// [s], while the middle of the car stays within `reach` [m] of the origin of A. The argument
  /// `radius` [m] is the radius of the circle around the car.
  void Take(const std::vector<SeenObstacle>& obstacles, const Pose2& X_WA, double reach,
            double radius, double margin, double duration);

  [[nodiscard]] bool empty() const { return still_.empty() && moving_.empty(); }
  /// Returns the smallest GapOf the car and any obstacle at `time` [s], but at most `margin`.
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
  // The rectangles of cell i are still_[members_[k]] for begins_[i] <= k < begins_[i + 1].
  std::vector<std::size_t> begins_;
  std::vector<std::pair<std::size_t, std::size_t>> pairs_;  // Cell and rectangle.
  std::vector<std::size_t> members_;
};

}  // namespace trackbed
