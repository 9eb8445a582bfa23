#include "trackbed/planning/lane_change.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "trackbed/core/error.h"
#include "trackbed/path/bezier.h"
#include "trackbed/world/world.h"

namespace trackbed {
namespace {

/// Lengths of the five sections, widths of the three gates, and the middles of the second and third
/// gate from that of the first.
struct Course {
  std::array<double, 5> lengths;
  std::array<double, 3> widths;
  std::array<double, 3> offsets;
};

Course CourseOf(LaneChangeStandard standard, double width) {
  const double first = 1.1 * width + 0.25;
  if (standard == LaneChangeStandard::kIso3888_1) {
    const double second = 1.2 * width + 0.25;
    const double third = 1.3 * width + 0.25;
    return {{15.0, 30.0, 25.0, 25.0, 30.0},
            {first, second, third},
            {0.0, 3.5 + 0.5 * (second - first), 0.5 * (third - first)}};
  }
  const double second = width + 1.0;
  const double third = std::max(1.3 * width + 0.25, 3.0);
  return {{12.0, 13.5, 11.0, 12.5, 12.0},
          {first, second, third},
          {0.0, 0.5 * first + 1.0 + 0.5 * second, 0.5 * (third - first)}};
}

void AddStraight(double length, std::vector<Segment>& path) {
  if (length > 0.0) {
    path.push_back({length, 0.0});
  }
}

/// From a straight line to one `offset` to its left over `length`.
void AddChange(double length, double offset, std::vector<Segment>& path) {
  constexpr double kSpacing = 0.1;  // [m]
  std::vector<Vec2> control;
  for (int i = 0; i <= 5; ++i) {
    control.emplace_back(length * i / 5.0, i < 3 ? 0.0 : offset);
  }
  const auto segments = SegmentsThrough(BezierCurve(control).Points(kSpacing, 0.0));
  path.insert(path.end(), segments.begin(), segments.end());
}

}  // namespace

std::vector<Gate> LaneChangeGates(LaneChangeStandard standard, Side first, double vehicle_width,
                                  const Pose2& start) {
  const Course course = CourseOf(standard, vehicle_width);
  const double side = first == Side::kLeft ? 1.0 : -1.0;
  std::vector<Gate> gates;
  double x = 0.0;
  for (std::size_t section = 0; section < 5; ++section) {
    const double length = course.lengths[section];
    if (section % 2 == 0) {
      const std::size_t gate = section / 2;
      const Vec2 centre = ToWorld(start, Vec2(x + 0.5 * length, side * course.offsets[gate]));
      gates.push_back({static_cast<int>(section) + 1,
                       {{centre.x(), centre.y(), start.yaw}, length, course.widths[gate]}});
    }
    x += length;
  }
  return gates;
}

std::vector<Vec2> ConesOf(const Gate& gate) {
  constexpr int kPairs = 5;
  constexpr double kRadius = 0.15;  // [m]
  const OrientedBox& lane = gate.lane;
  std::vector<Vec2> cones;
  for (int i = 0; i < kPairs; ++i) {
    const double x = lane.length * (static_cast<double>(i) / (kPairs - 1) - 0.5);
    const double y = 0.5 * lane.width + kRadius;
    cones.push_back(ToWorld(lane.centre, Vec2(x, y)));
    cones.push_back(ToWorld(lane.centre, Vec2(x, -y)));
  }
  return cones;
}

std::vector<Segment> LaneChangePath(const LaneChangePlannerOptions& options,
                                    const std::vector<Gate>& gates, const Pose2& start,
                                    double stop) {
  std::vector<Segment> path;
  double x = 0.0;
  double y = 0.0;
  for (std::size_t i = 0; i < gates.size(); ++i) {
    const OrientedBox& lane = gates[i].lane;
    const Vec2 middle = ToLocal(start, lane.centre.position());
    const double begin = middle.x() - 0.5 * lane.length;
    const double end = middle.x() + 0.5 * lane.length;
    if (i > 0) {
      const double joined = begin + options.join;
      TRACKBED_CHECK(joined > x, "gate {} is joined before the one before it is left", i);
      AddChange(joined - x, middle.y() - y, path);
      x = joined;
      y = middle.y();
    }
    const double left = i + 1 < gates.size() ? end - options.leave : end + options.lead_out + stop;
    AddStraight(left - x, path);
    x = std::max(x, left);
  }
  return path;
}

std::vector<double> GateMargins(const std::vector<Gate>& gates, const VehicleParams& vehicle,
                                const std::vector<Pose2>& poses) {
  std::vector<double> margins(gates.size(), std::numeric_limits<double>::infinity());
  for (std::size_t g = 0; g < gates.size(); ++g) {
    const OrientedBox& lane = gates[g].lane;
    const auto take = [&](const Vec2& corner) {
      margins[g] = std::min(margins[g], 0.5 * lane.width - std::abs(corner.y()));
    };
    std::array<Vec2, 4> before{};
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const std::array<Vec2, 4> corners = OutlineAt(vehicle, poses[i]).Corners();
      for (std::size_t c = 0; c < corners.size(); ++c) {
        const Vec2 corner = ToLocal(lane.centre, corners[c]);
        if (std::abs(corner.x()) <= 0.5 * lane.length) {
          take(corner);
        }
        // The cones at either end may stand between two poses.
        for (const double end : {-0.5 * lane.length, 0.5 * lane.length}) {
          if (i > 0 && (before[c].x() - end) * (corner.x() - end) < 0.0) {
            take(before[c] +
                 (end - before[c].x()) / (corner.x() - before[c].x()) * (corner - before[c]));
          }
        }
        before[c] = corner;
      }
    }
  }
  return margins;
}

}  // namespace trackbed
