#include "trackbed/planning/common/collision_checker.h"

#include <algorithm>
#include <cmath>

#include "trackbed/core/error.h"
#include "trackbed/world/world.h"

namespace trackbed {
namespace {

/// Side of a bin [m]: about a car, or more where the boxes are so far apart that there would be
/// more bins than this.
constexpr double kBin = 4.0;
constexpr double kMostBins = 250000.0;
/// Shortest step along a path, per meter of the car's length, and at most [m].
constexpr double kStep = 0.02;

bool IsBox(const OrientedBox& box) {
  return box.center.position().allFinite() && std::isfinite(box.center.yaw) && box.length >= 0.0 &&
         std::isfinite(box.length) && box.width >= 0.0 && std::isfinite(box.width);
}

double CircleAround(const OrientedBox& box) {
  return 0.5 * std::hypot(box.length, box.width);
}

}  // namespace

CollisionChecker::CollisionChecker(const VehicleParams& vehicle, std::vector<OrientedBox> boxes,
                                   double distance)
    : vehicle_(vehicle),
      boxes_(std::move(boxes)),
      distance_(distance),
      middle_(0.5 * vehicle.length - vehicle.rear_overhang),
      radius_(0.5 * std::hypot(vehicle.length, vehicle.width)),
      step_(kStep * std::min(1.0, vehicle.length)),
      reach_(std::hypot(vehicle.length - vehicle.rear_overhang, 0.5 * vehicle.width)) {
  TRACKBED_CHECK(distance >= 0.0 && std::isfinite(distance), "distance {}", distance);
  for (const OrientedBox& box : boxes_) {
    TRACKBED_REQUIRE(IsBox(box),
                     "CollisionChecker: a box of {} x {} m at {}, {}, yaw {}; must be "
                     "finite, not smaller than 0",
                     box.length, box.width, box.center.x, box.center.y, box.center.yaw);
  }
  if (boxes_.empty()) {
    return;
  }
  low_ = boxes_.front().center.position();
  Vec2 high = low_;
  const auto reach_of = [&](std::size_t i) { return radii_[i] + radius_ + distance_ + kFarthest; };
  for (const OrientedBox& box : boxes_) {
    radii_.push_back(CircleAround(box));
    const Vec2 reach = Vec2::Constant(reach_of(radii_.size() - 1));
    low_ = low_.cwiseMin(box.center.position() - reach);
    high = high.cwiseMax(box.center.position() + reach);
  }
  const Vec2 size = high - low_;
  // The longer of the two alone, for boxes in a row; their area, for others.
  bin_ = std::max({kBin, size.maxCoeff() / kMostBins, std::sqrt(size.prod() / kMostBins)});
  TRACKBED_REQUIRE(std::isfinite(bin_), "CollisionChecker: boxes over {} x {} m; must be less",
                   size.x(), size.y());
  columns_ = static_cast<int>(size.x() / bin_) + 1;
  rows_ = static_cast<int>(size.y() / bin_) + 1;
  bins_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const Vec2 center = boxes_[i].center.position();
    const auto first = [&](int axis) {
      return static_cast<int>((center[axis] - reach_of(i) - low_[axis]) / bin_);
    };
    const auto last = [&](int axis) {
      return static_cast<int>((center[axis] + reach_of(i) - low_[axis]) / bin_);
    };
    for (int row = first(1); row <= std::min(last(1), rows_ - 1); ++row) {
      for (int column = first(0); column <= std::min(last(0), columns_ - 1); ++column) {
        bins_[static_cast<std::size_t>(row * columns_ + column)].push_back(static_cast<int>(i));
      }
    }
  }
}

const std::vector<int>* CollisionChecker::Near(const Vec2& middle) const {
  const Vec2 bin = (middle - low_) / bin_;
  if (!(bin.x() >= 0.0 && bin.y() >= 0.0 && bin.x() < columns_ && bin.y() < rows_)) {
    return nullptr;
  }
  return &bins_[static_cast<std::size_t>(static_cast<int>(bin.y()) * columns_ +
                                         static_cast<int>(bin.x()))];
}

double CollisionChecker::Clearance(const Pose2& pose) const {
  const Vec2 middle = pose.position() + middle_ * Direction(pose.yaw);
  const std::vector<int>* near = Near(middle);
  double room = kFarthest;
  if (near == nullptr) {
    // Far from every box, or nowhere.
    TRACKBED_REQUIRE(middle.allFinite(), "CollisionChecker: the pose {}, {}, yaw {} is not finite",
                     pose.x, pose.y, pose.yaw);
    return room;
  }
  const OrientedBox footprint{{middle.x(), middle.y(), pose.yaw}, vehicle_.length, vehicle_.width};
  for (const int i : *near) {
    const OrientedBox& box = boxes_[static_cast<std::size_t>(i)];
    const double circles = radii_[static_cast<std::size_t>(i)] + radius_ + distance_ + room;
    if ((box.center.position() - middle).squaredNorm() < circles * circles) {
      room = std::min(room, Separation(footprint, box) - distance_);
    }
  }
  return room;
}

std::optional<double> CollisionChecker::FirstBlocked(const Path& path) const {
  double sharpest = 0.0;
  for (const Segment& segment : path.segments()) {
    sharpest = std::max({sharpest, std::abs(segment.curvature),
                         std::abs(segment.CurvatureAt(segment.length)),
                         std::abs(segment.CurvatureAt(0.5 * segment.length))});
  }
  const double moved = 1.0 + sharpest * reach_;  // by the footprint, per meter of path
  for (double s = 0.0;;) {
    const double room = Clearance(path.At(s).pose);
    if (room < 0.0) {
      return s;
    }
    if (s == path.length()) {
      return std::nullopt;
    }
    s = std::min(s + std::max(room / moved, step_), path.length());
  }
}

bool CollisionChecker::IsFree(const Pose2& start, const Segment& segment) const {
  const double moved = 1.0 + std::abs(segment.curvature) * reach_;
  for (double d = 0.0;;) {
    const double along = segment.direction * d;
    const double room = Clearance(MoveOnArc(start, along, segment.curvature * along));
    if (room < 0.0) {
      return false;
    }
    if (d == segment.length) {
      return true;
    }
    d = std::min(d + std::max(room / moved, step_), segment.length);
  }
}

}  // namespace trackbed
