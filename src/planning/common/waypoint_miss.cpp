#include "trackbed/planning/common/waypoint_miss.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace trackbed {
namespace {

/// Projects points onto a whole path. The segments are divided into blocks. No point of a block is
/// farther from the block's middle than half of the block's length, so most blocks are skipped. The
/// cost of a projection is about the square root of the number of segments.
class BlockProjection {
 public:
  explicit BlockProjection(const Path& path) : path_(path) {
    const std::vector<Segment>& segments = path.segments();
    const auto per_block =
        static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(segments.size()))));
    double station = 0.0;
    for (std::size_t i = 0; i < segments.size(); ++i) {
      if (i % per_block == 0) {
        blocks_.push_back({.within = {station, station}});
      }
      station += segments[i].length;
      blocks_.back().within.to = station;
    }
    if (blocks_.empty()) {
      blocks_.push_back({.within = {0.0, 0.0}});
    }
    for (Block& block : blocks_) {
      const auto [from, to] = block.within;
      block.middle = path.At(0.5 * (from + to)).pose.position();
    }
  }

  /// Returns the station of the path's point that is nearest to `at`; the smallest of these
  /// stations if several points are equally near.
  [[nodiscard]] WaypointMiss Nearest(const Vec2& at) const {
    const auto closest =
        std::min_element(blocks_.begin(), blocks_.end(), [&](const Block& a, const Block& b) {
          return LeastDistance(a, at) < LeastDistance(b, at);
        });
    WaypointMiss nearest = In(*closest, at);
    for (const Block& block : blocks_) {
      if (&block == &*closest || LeastDistance(block, at) > nearest.distance) {
        continue;
      }
      const WaypointMiss own = In(block, at);
      if (own.distance < nearest.distance ||
          (own.distance == nearest.distance && own.station < nearest.station)) {
        nearest = own;
      }
    }
    return nearest;
  }

 private:
  struct Block {
    Stations within;
    Vec2 middle = Vec2::Zero();
  };

  /// Returns a lower bound of the distance between a block and a point [m].
  static double LeastDistance(const Block& block, const Vec2& at) {
    return (block.middle - at).norm() - 0.5 * (block.within.to - block.within.from);
  }

  [[nodiscard]] WaypointMiss In(const Block& block, const Vec2& at) const {
    const double s = path_.Project({at.x(), at.y(), 0.0}, block.within).s;
    return {0, at, (path_.At(s).pose.position() - at).norm(), s};
  }

  const Path& path_;
  std::vector<Block> blocks_;
};

}  // namespace

std::optional<WaypointMiss> LargestWaypointMiss(const Path& path,
                                                const std::vector<Vec2>& waypoints) {
  std::optional<WaypointMiss> largest;
  const BlockProjection projection(path);
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    WaypointMiss miss = projection.Nearest(waypoints[i]);
    if (!largest || miss.distance > largest->distance + kSameMiss) {
      miss.waypoint = i;
      largest = miss;
    }
  }
  return largest;
}

std::string DescribeWaypoint(std::size_t waypoint, const Vec2& at) {
  return fmt::format("waypoint {} at ({:.10g}, {:.10g})", waypoint, at.x(), at.y());
}

std::string RemedyForMiss(double distance) {
  // Unit of the last digit if the distance is written with three digits; at least a millimeter.
  const double digit = std::pow(10.0, std::max(std::floor(std::log10(distance)) - 2.0, -3.0));
  return fmt::format("set plan.max_waypoint_miss to at least {:.10g}, or move the waypoint",
                     digit * (std::floor(distance / digit) + 1.0));
}

}  // namespace trackbed
