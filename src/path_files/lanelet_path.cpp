#include "src/path_files/lanelet_path.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "trackbed/core/angle.h"

// Makes the path of a route along lanelets. In each lane, the path is the center line c(s) with the
// left normal n(s) plus a lateral offset: p = c(s) + d(s - s_0) n(s). At s_0, the offset and its
// slope are those of the start pose or, after a lane change, of the path in the lane before. Over
// the length L, the offset falls to 0 along the quintic polynomial whose second derivative is 0 at
// both ends. For an offset d_0 that vanishes over the length L, the largest second derivative is
// 10/sqrt(3) d_0/L^2. At the speed v, the lateral acceleration is at most a if L >= v sqrt(5.77
// d_0/a).
namespace trackbed {
namespace {

constexpr double kSpacing = 1.0;              // Distance between points of the path [m].
constexpr double kLateralAcceleration = 1.5;  // Lateral acceleration of a lane change [m/s^2].

/// The center line of a lane, with normals that are continuous along the line.
class CenterLine {
 public:
  explicit CenterLine(const std::vector<Vec2>& points) {
    for (const Vec2& point : points) {
      Add(point);
    }
  }

  /// Adds a point. Skips a point at the place of the last point.
  void Add(const Vec2& point) {
    if (points_.empty()) {
      points_.push_back(point);
      stations_.push_back(0.0);
    } else if (const double step = (point - points_.back()).norm(); step > 1e-3) {
      points_.push_back(point);
      stations_.push_back(stations_.back() + step);
    }
  }

  [[nodiscard]] double length() const { return stations_.back(); }
  [[nodiscard]] const std::vector<Vec2>& points() const { return points_; }

  /// Returns the point with a lateral offset at a station.
  [[nodiscard]] Vec2 At(double station, double offset) const {
    const auto after = std::upper_bound(stations_.begin() + 1, stations_.end() - 1, station);
    const auto i = static_cast<std::size_t>(after - stations_.begin());
    const double share = (station - stations_[i - 1]) / (stations_[i] - stations_[i - 1]);
    const Vec2 point = points_[i - 1] + share * (points_[i] - points_[i - 1]);
    const Vec2 tangent = (1.0 - share) * TangentAt(i - 1) + share * TangentAt(i);
    return point + offset * LeftNormal(tangent.normalized());
  }

 private:
  /// Returns the mean direction of the edges that meet at a point.
  [[nodiscard]] Vec2 TangentAt(std::size_t i) const {
    Vec2 sum = Vec2::Zero();
    if (i > 0) {
      sum += (points_[i] - points_[i - 1]).normalized();
    }
    if (i + 1 < points_.size()) {
      sum += (points_[i + 1] - points_[i]).normalized();
    }
    return sum.norm() > 1e-6 ? Vec2(sum.normalized())
                             : Vec2((points_[i] - points_[i - 1]).normalized());
  }

  std::vector<Vec2> points_;
  std::vector<double> stations_;
};

CenterLine CenterOf(const LaneletLane& lane) {
  std::vector<Vec2> points;
  for (const Lanelet* lanelet : lane) {
    points.insert(points.end(), lanelet->center.begin(), lanelet->center.end());
  }
  return CenterLine(points);
}

/// Makes a line longer by `beyond` [m]. Appends the centers of the straightest successors, and then
/// a straight line if there are no more successors.
void Extend(CenterLine& line, const Lanelets& lanelets, const Lanelet& last, double beyond) {
  const double end = line.length() + beyond;
  const Lanelet* at = &last;
  while (line.length() < end && !at->successors.empty()) {
    const Vec2 before = at->center.back() - at->center[at->center.size() - 2];
    const auto turn = [&](const std::string& id) {
      const std::vector<Vec2>& next = lanelets.at(id).center;
      const Vec2 after = next.back() - next.front();
      return std::abs(std::atan2(Cross(before, after), before.dot(after)));
    };
    at = &lanelets.at(*std::min_element(
        at->successors.begin(), at->successors.end(),
        [&](const std::string& a, const std::string& b) { return turn(a) < turn(b); }));
    const double length = line.length();
    for (const Vec2& point : at->center) {
      line.Add(point);
    }
    if (line.length() == length) {
      break;
    }
  }
  if (line.length() < end) {
    const std::vector<Vec2>& points = line.points();
    const Vec2 ahead = (points.back() - points[points.size() - 2]).normalized();
    line.Add(points.back() + (end - line.length()) * ahead);
  }
}

/// Returns the length over which a car changes its lateral position by `offset` at a speed.
double ChangeLength(double offset, double speed) {
  return std::max({speed * std::sqrt(5.77 * std::abs(offset) / kLateralAcceleration),
                   4.0 * std::abs(offset), 5.0 * kSpacing});
}

/// The lateral offset from a center line as a function of the distance.
struct Offset {
  double start = 0.0;   // Offset at the start [m].
  double slope = 0.0;   // Slope of the offset at the start.
  double length = 1.0;  // Length over which the offset falls to 0 [m].

  [[nodiscard]] double At(double x) const {
    const double u = std::min(x / length, 1.0);
    return start * (1.0 + u * u * u * (-10.0 + u * (15.0 - 6.0 * u))) +
           slope * length * (u + u * u * u * (-6.0 + u * (8.0 - 3.0 * u)));
  }
};

}  // namespace

std::vector<Vec2> LaneletPath(const Lanelets& lanelets, const std::vector<LaneletLane>& lanes,
                              const Pose2& start, const std::optional<Vec2>& aim, double speed,
                              double beyond) {
  constexpr double kMaxTurn = 1.0;  // Largest angle between path and lane that is continued [rad].
  std::vector<Vec2> path{start.position()};
  double yaw = start.yaw;
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    CenterLine line = CenterOf(lanes[k]);
    double end = line.length();
    if (k + 1 < lanes.size()) {
      // The lane change may begin where the last lanelet of this lane begins.
      end -= lanes[k].back()->Length();
    } else {
      Extend(line, lanelets, *lanes[k].back(), beyond);
      end = line.length();
    }
    const PolylinePlace from = PlaceOn(line.points(), path.back());
    const double turn = std::clamp(AngleDifference(yaw, from.yaw), -kMaxTurn, kMaxTurn);
    const Offset offset{from.offset, std::tan(turn),
                        std::min(ChangeLength(from.offset, speed),
                                 std::max(line.length() - from.station, kSpacing))};
    // At the distance `change` before the aim, the path begins to move from the center line to the
    // aim's lateral offset.
    double aim_offset = 0.0;
    double aim_at = 0.0;
    double change = 1.0;
    if (aim && k + 1 == lanes.size()) {
      const PolylinePlace place = PlaceOn(line.points(), *aim);
      aim_offset = place.offset;
      aim_at = std::max(place.station - from.station, kSpacing);
      change = std::min(ChangeLength(aim_offset, speed), aim_at);
    }
    const auto offset_at = [&](double x) {
      const double u = std::clamp((x - (aim_at - change)) / change, 0.0, 1.0);
      return offset.At(x) + aim_offset * u * u * u * (10.0 + u * (-15.0 + 6.0 * u));
    };
    for (double x = kSpacing; from.station + x < end; x += kSpacing) {
      const Vec2 point = line.At(from.station + x, offset_at(x));
      const Vec2 step = point - path.back();
      if (step.norm() > 0.3 * kSpacing) {
        path.push_back(point);
        yaw = std::atan2(step.y(), step.x());
      }
    }
  }
  return path;
}

}  // namespace trackbed
