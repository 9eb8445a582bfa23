#include "trackbed/planning/common/collision_checker.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "trackbed/core/error.h"
#include "trackbed/world/world.h"

namespace trackbed {
namespace {

/// Largest number of bins into which the checker sorts the obstacle boxes. If the boxes cover a
/// large area, the checker makes the bins larger instead of using more bins.
constexpr double kMaxBins = 250000.0;
/// Shortest step along a path, as a fraction of the car's length.
constexpr double kStep = 0.02;
/// Number of boxes up to which computing the distances to all boxes is faster than taking many
/// small steps along the path.
constexpr std::size_t kFullScanLimit = 16;

bool IsBox(const OrientedBox& box) {
  return box.center.position().allFinite() && std::isfinite(box.center.yaw) && box.length >= 0.0 &&
         std::isfinite(box.length) && box.width >= 0.0 && std::isfinite(box.width);
}

/// Returns the squared distance from a point to a box. The unit vector `along` is the direction of
/// the box's length axis.
double SquareTo(const OrientedBox& box, const Vec2& along, const Vec2& point) {
  const Vec2 offset = point - box.center.position();
  const double x = std::max(std::abs(along.dot(offset)) - 0.5 * box.length, 0.0);
  const double y = std::max(std::abs(Cross(along, offset)) - 0.5 * box.width, 0.0);
  return x * x + y * y;
}

}  // namespace

CollisionChecker::CollisionChecker(const VehicleParams& vehicle, std::vector<OrientedBox> boxes,
                                   double distance)
    : vehicle_(vehicle),
      boxes_(std::move(boxes)),
      distance_(distance),
      distances_(boxes_.size(), distance),
      farthest_(std::min(kMaxClearance, vehicle.length)),
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
    along_.push_back(Direction(box.center.yaw));
  }
  if (!boxes_.empty()) {
    FillBins();
  }
}

CollisionChecker::CollisionChecker(const VehicleParams& vehicle, std::vector<OrientedBox> boxes,
                                   double distance, const Pose2& start)
    : CollisionChecker(vehicle, std::move(boxes), distance) {
  const OrientedBox footprint = FootprintAt(vehicle, start);
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const double here = Separation(footprint, boxes_[i]);
    distances_[i] = here < distance ? kShareOfStart * std::max(here, 0.0) : distance;
  }
}

double CollisionChecker::inner_radius() const {
  return std::max(std::min({0.5 * vehicle_.width, vehicle_.rear_overhang,
                            vehicle_.length - vehicle_.rear_overhang}),
                  0.0);
}

bool CollisionChecker::MayBeFree(const Vec2& position) const {
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const double within = inner_radius() + distances_[i];
    if (SquareTo(boxes_[i], along_[i], position) < within * within) {
      return false;
    }
  }
  return true;
}

void CollisionChecker::FillBins() {
  // A box is irrelevant for all footprints whose center is farther than `near` from the box.
  const double near = radius_ + distance_ + farthest_;
  const auto reach_of = [&](std::size_t i) {
    const Vec2 along = 0.5 * boxes_[i].length * along_[i];
    const Vec2 across = 0.5 * boxes_[i].width * LeftNormal(along_[i]);
    return Vec2((along.cwiseAbs() + across.cwiseAbs()).array() + near);
  };
  low_ = boxes_.front().center.position();
  Vec2 high = low_;
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    low_ = low_.cwiseMin(boxes_[i].center.position() - reach_of(i));
    high = high.cwiseMax(boxes_[i].center.position() + reach_of(i));
  }
  const Vec2 size = high - low_;
  // The bin size is about the length of a car; it is larger if the area of the boxes would
  // otherwise need more than kMaxBins bins.
  bin_ = std::max({farthest_, size.maxCoeff() / kMaxBins, std::sqrt(size.prod() / kMaxBins)});
  TRACKBED_REQUIRE(std::isfinite(bin_), "CollisionChecker: boxes over {} x {} m; must be less",
                   size.x(), size.y());
  columns_ = static_cast<int>(size.x() / bin_) + 1;
  rows_ = static_cast<int>(size.y() / bin_) + 1;
  bins_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  // Distance from a bin's center up to which a box may be close to a footprint centered in the bin,
  // with a margin for rounding errors.
  const double far = (near + bin_ * std::sqrt(0.5)) * (1.0 + 1e-9);
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const Vec2 reach = reach_of(i);
    const Vec2 from = (boxes_[i].center.position() - reach - low_) / bin_;
    const Vec2 to = (boxes_[i].center.position() + reach - low_) / bin_;
    const int last_row = std::min(static_cast<int>(to.y()), rows_ - 1);
    const int last_column = std::min(static_cast<int>(to.x()), columns_ - 1);
    for (int row = static_cast<int>(from.y()); row <= last_row; ++row) {
      for (int column = static_cast<int>(from.x()); column <= last_column; ++column) {
        const Vec2 center = low_ + bin_ * Vec2{column + 0.5, row + 0.5};
        if (SquareTo(boxes_[i], along_[i], center) <= far * far) {
          bins_[static_cast<std::size_t>(row * columns_ + column)].push_back(static_cast<int>(i));
        }
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

double CollisionChecker::Clearance(const Pose2& pose, double at_most) const {
  const Vec2 middle = pose.position() + middle_ * Direction(pose.yaw);
  const std::vector<int>* near = Near(middle);
  double clearance = std::min(farthest_, at_most);
  if (near == nullptr) {
    // Without a list of near boxes, either no box is near the footprint, or the pose is not finite.
    TRACKBED_REQUIRE(middle.allFinite(), "CollisionChecker: the pose {}, {}, yaw {} is not finite",
                     pose.x, pose.y, pose.yaw);
    return clearance;
  }
  const OrientedBox footprint{{middle.x(), middle.y(), pose.yaw}, vehicle_.length, vehicle_.width};
  for (const int i : *near) {
    const auto index = static_cast<std::size_t>(i);
    // Skip boxes that are so far from the footprint's center that they neither overlap the
    // footprint nor reduce the clearance.
    const double within = radius_ + std::max(distances_[index] + clearance, 0.0);
    if (SquareTo(boxes_[index], along_[index], middle) < within * within) {
      clearance = std::min(clearance, Separation(footprint, boxes_[index]) - distances_[index]);
    }
  }
  return clearance;
}

double CollisionChecker::NextCheck(const Pose2& pose, double room, double moved, double at,
                                   double length) const {
  if (boxes_.empty()) {
    return length;
  }
  if (room == farthest_ && boxes_.size() <= kFullScanLimit) {
    const Vec2 middle = pose.position() + middle_ * Direction(pose.yaw);
    double square = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      square = std::min(square, SquareTo(boxes_[i], along_[i], middle));
    }
    // In each step of the following loop, the distance between footprint and boxes falls by at most
    // `farthest_`. No check is needed while the footprint cannot be close to a box.
    for (double left = std::sqrt(square) - radius_ - distance_ - farthest_;
         left > (1.0 + 1e-9) * farthest_ && farthest_ < moved * (length - at); left -= farthest_) {
      at += farthest_ / moved;
    }
  }
  return std::min(at + std::max(room / moved, step_), length);
}

std::optional<double> CollisionChecker::FirstBlocked(const Path& path) const {
  double sharpest = 0.0;
  for (const Segment& segment : path.segments()) {
    sharpest = std::max({sharpest, std::abs(segment.curvature),
                         std::abs(segment.CurvatureAt(segment.length)),
                         std::abs(segment.CurvatureAt(0.5 * segment.length))});
  }
  // Largest distance that any point of the footprint moves per meter of path.
  const double moved = 1.0 + sharpest * reach_;
  for (double s = 0.0;;) {
    const Pose2 pose = path.At(s).pose;
    const double room = Clearance(pose, moved * (path.length() - s));
    if (room < 0.0) {
      return s;
    }
    if (s == path.length()) {
      return std::nullopt;
    }
    s = NextCheck(pose, room, moved, s, path.length());
  }
}

bool CollisionChecker::IsFree(const Pose2& start, const Segment& segment) const {
  const double moved = 1.0 + std::abs(segment.curvature) * reach_;
  for (double d = 0.0;;) {
    const double along = segment.direction * d;
    const Pose2 pose = MoveOnArc(start, along, segment.curvature * along);
    const double room = Clearance(pose, moved * (segment.length - d));
    if (room < 0.0) {
      return false;
    }
    if (d == segment.length) {
      return true;
    }
    d = NextCheck(pose, room, moved, d, segment.length);
  }
}

}  // namespace trackbed
