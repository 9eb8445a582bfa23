#include "src/control/obstacle_cells.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace trackbed {
namespace {

Rectangle RectangleIn(const Pose2& X_WA, const OrientedBox& box) {
  const Vec2 middle = ToLocal(X_WA, box.center.position());
  const double yaw = box.center.yaw - X_WA.yaw;
  return {.x = middle.x(),
          .y = middle.y(),
          .cosine = std::cos(yaw),
          .sine = std::sin(yaw),
          .half_length = 0.5 * box.length,
          .half_width = 0.5 * box.width};
}

/// Returns the larger of the gaps between two rectangles along the two axes of the rectangle `a`.
double GapAlongAxes(const Rectangle& a, const Rectangle& b) {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double along = std::abs(dx * a.cosine + dy * a.sine);
  const double across = std::abs(dy * a.cosine - dx * a.sine);
  const double c = std::abs(a.cosine * b.cosine + a.sine * b.sine);
  const double s = std::abs(a.cosine * b.sine - a.sine * b.cosine);
  return std::max(along - a.half_length - b.half_length * c - b.half_width * s,
                  across - a.half_width - b.half_length * s - b.half_width * c);
}

}  // namespace

double GapOf(const Rectangle& a, const Rectangle& b) {
  return std::max(GapAlongAxes(a, b), GapAlongAxes(b, a));
}

void ObstacleCells::Take(const std::vector<SeenObstacle>& obstacles, const Pose2& X_WA,
                         double reach, double radius, double margin, double duration) {
  reach_ = reach;
  radius_ = radius;
  margin_ = margin;
  still_.clear();
  moving_.clear();
  for (const SeenObstacle& obstacle : obstacles) {
    const OrientedBox& box = obstacle.footprint;
    const double way = obstacle.velocity.norm() * duration;
    const double size = 0.5 * std::hypot(box.length, box.width);
    const double far = reach + radius + margin + size + way;
    if ((box.center.position() - X_WA.position()).squaredNorm() > far * far) {
      continue;
    }
    const Rectangle rectangle = RectangleIn(X_WA, box);
    if (way == 0.0 && obstacle.yaw_rate == 0.0) {
      still_.push_back(rectangle);
    } else {
      moving_.push_back({.at_start = rectangle,
                         .velocity = Eigen::Rotation2Dd(-X_WA.yaw) * obstacle.velocity,
                         .yaw = box.center.yaw - X_WA.yaw,
                         .yaw_rate = obstacle.yaw_rate});
    }
  }
  FillCells();
}

std::size_t ObstacleCells::CellOf(double x, double y) const {
  const double per_meter = kCellsPerSide / (2.0 * reach_);
  const auto index = [&](double at) {
    return static_cast<std::size_t>(
        std::clamp((at + reach_) * per_meter, 0.0, kCellsPerSide - 1.0));
  };
  return index(y) * kCellsPerSide + index(x);
}

void ObstacleCells::FillCells() {
  pairs_.clear();
  for (std::size_t i = 0; i < still_.size(); ++i) {
    const Rectangle& box = still_[i];
    // Enter the rectangle in the cells from `low` to `high`. A car whose middle is in no such cell
    // is farther from the rectangle than the margin.
    const double x = box.half_length * std::abs(box.cosine) + box.half_width * std::abs(box.sine);
    const double y = box.half_length * std::abs(box.sine) + box.half_width * std::abs(box.cosine);
    const double wider = radius_ + margin_;
    const std::size_t low = CellOf(box.x - x - wider, box.y - y - wider);
    const std::size_t high = CellOf(box.x + x + wider, box.y + y + wider);
    for (std::size_t row = low / kCellsPerSide; row <= high / kCellsPerSide; ++row) {
      for (std::size_t c = low % kCellsPerSide; c <= high % kCellsPerSide; ++c) {
        pairs_.emplace_back(row * kCellsPerSide + c, i);
      }
    }
  }
  constexpr std::size_t kCells = static_cast<std::size_t>(kCellsPerSide) * kCellsPerSide;
  begins_.assign(kCells + 1, 0);
  for (const auto& [cell, box] : pairs_) {
    ++begins_[cell + 1];
  }
  for (std::size_t cell = 0; cell < kCells; ++cell) {
    begins_[cell + 1] += begins_[cell];
  }
  // Fill the list of each grid cell from its end, so that begins_[cell + 1] becomes the start of
  // the cell's list.
  members_.resize(pairs_.size());
  for (const auto& [cell, box] : pairs_) {
    members_[--begins_[cell + 1]] = box;
  }
  std::rotate(begins_.begin(), begins_.begin() + 1, begins_.end());
  begins_.back() = pairs_.size();
}

double ObstacleCells::Gap(const Rectangle& car, double time) const {
  double gap = margin_;
  const auto look_at = [&](const Rectangle& box) {
    const double far = radius_ + box.half_length + box.half_width + gap;
    const double dx = box.x - car.x;
    const double dy = box.y - car.y;
    if (dx * dx + dy * dy < far * far) {
      gap = std::min(gap, GapOf(car, box));
    }
  };
  if (!still_.empty()) {
    const std::size_t cell = CellOf(car.x, car.y);
    for (std::size_t k = begins_[cell]; k < begins_[cell + 1]; ++k) {
      look_at(still_[members_[k]]);
    }
  }
  for (const Moving& moving : moving_) {
    Rectangle box = moving.at_start;
    box.x += moving.velocity.x() * time;
    box.y += moving.velocity.y() * time;
    if (moving.yaw_rate != 0.0) {
      const double yaw = moving.yaw + moving.yaw_rate * time;
      box.cosine = std::cos(yaw);
      box.sine = std::sin(yaw);
    }
    look_at(box);
  }
  return gap;
}

}  // namespace trackbed
