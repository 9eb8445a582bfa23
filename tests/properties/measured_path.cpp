#include "tests/properties/measured_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "tests/audit/shapes.h"
#include "trackbed/core/angle.h"

namespace properties {
namespace {

using namespace trackbed;

class Measurement {
 public:
  Measurement(const Plan& plan, const PlanRequest& request, const PlannerEntry& entry)
      : plan_(plan),
        request_(request),
        entry_(entry),
        path_(plan.reference.path),
        sharpest_((1.0 + 1e-6) / request.vehicle.min_turning_radius()),
        step_(0.01 * request.vehicle.min_turning_radius()) {
    double reach = path_.length();
    for (const double s : Stations()) {
      const Vec2 at = path_.At(s).pose.position();
      reach = std::max({reach, std::abs(at.x()), std::abs(at.y())});
    }
    rounding_ = 16.0 * std::numeric_limits<double>::epsilon() * (reach + path_.length());
  }

  std::string Flaw() {
    if (std::string flaw = FlawInSpeeds(); !flaw.empty()) {
      return flaw;
    }
    if (std::string flaw = FlawInEnds(); !flaw.empty()) {
      return flaw;
    }
    if (4.0 * rounding_ / step_ < 0.1) {
      for (const double s : Stations()) {
        for (const double from : {s - 2.0 * step_, s - step_, s, s + 0.37 * step_}) {
          if (std::string flaw = FlawAt(from); !flaw.empty()) {
            return flaw;
          }
        }
      }
    }
    return entry_.keeps_clear ? FlawInClearance() : "";
  }

 private:
  /// Returns the stations of the joints between segments, and stations between them. On a path with
  /// more than 500 segments, uses only every n-th segment.
  [[nodiscard]] std::vector<double> Stations() const {
    const std::vector<Segment>& segments = path_.segments();
    const std::size_t stride = 1 + segments.size() / 500;
    std::vector<double> stations{0.0};
    double start = 0.0;
    for (std::size_t i = 0; i < segments.size(); ++i) {
      if (i % stride == 0) {
        for (const double share : {0.21, 0.5, 0.83, 1.0}) {
          stations.push_back(start + share * segments[i].length);
        }
      }
      start += segments[i].length;
    }
    stations.push_back(path_.length());
    return stations;
  }

  [[nodiscard]] std::string FlawInSpeeds() const {
    const std::vector<SpeedProfile::Knot>& knots = plan_.reference.speed.knots();
    constexpr double kNegligible = 2e-9;  // A speed profile omits intervals shorter than this
                                          // length [m].
    if (knots.empty() || knots.back().speed != 0.0 || knots.front().s != 0.0 ||
        !(std::abs(knots.back().s - path_.length()) <= kNegligible)) {
      return "the speeds do not end at rest at the end of the path";
    }
    if (std::abs(knots.front().speed - request_.start_speed) > 1e-9 * request_.start_speed) {
      return fmt::format("starts at {} m/s, the car at {} m/s", knots.front().speed,
                         request_.start_speed);
    }
    for (const SpeedProfile::Knot& knot : knots) {
      const double most = std::max(request_.speed.speed, request_.start_speed);
      if (!(knot.speed <= most * (1.0 + 1e-9))) {
        return fmt::format("{} m/s at s = {}, wanted are {}", knot.speed, knot.s, most);
      }
    }
    return "";
  }

  [[nodiscard]] std::string FlawInEnds() const {
    const Pose2 first = path_.At(0.0).pose;
    const double away = (first.position() - request_.start.position()).norm();
    const double turned = std::abs(AngleDifference(first.yaw, request_.start.yaw));
    // Tolerance for equal positions [m]; see feasibility.h.
    const double same = 1e-3 * std::min(1.0, request_.vehicle.wheelbase);
    if (!(away <= same + rounding_) || !(turned <= 1e-3 * (1.0 + 1e-6))) {
      return fmt::format("begins {} m and {} rad from the car", away, turned);
    }
    if (entry_.min_waypoints == 0 || !plan_.blocked.empty() || !plan_.partial.empty()) {
      return "";
    }
    const Pose2 last = path_.At(path_.length()).pose;
    const double missed = (last.position() - request_.waypoints.back()).norm();
    // Planners reach their goal to 1e-9 m, or to 1e-9 of the wheelbase of a small car. Some
    // planners treat corners below 1e-9 rad as straight; the end of a leg then deviates by 1e-9 of
    // its length.
    const double small = std::min(1.0, request_.vehicle.wheelbase) + path_.length();
    if (!(missed <= 1e-9 * small + 16.0 * rounding_)) {
      return fmt::format("ends {} m from the last waypoint", missed);
    }
    if (entry_.has_headings && !request_.headings.empty() &&
        !(std::abs(AngleDifference(last.yaw, request_.headings.back())) <= 1e-6)) {
      return fmt::format("ends {} rad off its heading",
                         AngleDifference(last.yaw, request_.headings.back()));
    }
    return "";
  }

  /// Checks two consecutive chords from the station `from`.
  [[nodiscard]] std::string FlawAt(double from) const {
    if (from < 0.0 || from + 2.0 * step_ > path_.length()) {
      return "";
    }
    const PathPoint a = path_.At(from);
    const PathPoint b = path_.At(from + step_);
    const PathPoint c = path_.At(from + 2.0 * step_);
    const double noise = 4.0 * rounding_ / step_;
    for (const auto& [p, q] : {std::pair{a, b}, std::pair{b, c}}) {
      const double chord = (q.pose.position() - p.pose.position()).norm();
      if (!(chord <= step_ * (1.0 + 1e-9) + 2.0 * rounding_)) {
        return fmt::format("jumps by {} m within {} m at s = {}", chord, step_, p.s);
      }
      if (!(std::abs(q.pose.yaw - p.pose.yaw) <= sharpest_ * step_ + noise + 1e-9)) {
        return fmt::format("its heading jumps by {} rad within {} m at s = {}",
                           q.pose.yaw - p.pose.yaw, step_, p.s);
      }
    }
    if (a.direction != b.direction || b.direction != c.direction || HasCusp(from)) {
      return "";
    }
    const double first = Heading(a, b);
    const double second = Heading(b, c);
    // If the path turns by at most K h over each chord of length h, where K is the largest
    // curvature, the directions of the chords differ by at most K h. The difference between chord
    // and arc adds K^3 h^3/24 = 4e-8 rad.
    if (!(std::abs(AngleDifference(second, first)) <= sharpest_ * step_ + noise + 1e-7)) {
      return fmt::format("turns by {} rad over {} m at s = {}, full lock is {}",
                         AngleDifference(second, first), step_, b.s, sharpest_ * step_);
    }
    if (!(std::abs(AngleDifference(first, a.pose.yaw)) <= 0.5 * sharpest_ * step_ + noise + 1e-7)) {
      return fmt::format("moves {} rad off its heading at s = {}",
                         AngleDifference(first, a.pose.yaw), a.s);
    }
    return "";
  }

  [[nodiscard]] static double Heading(const PathPoint& from, const PathPoint& to) {
    const Vec2 along = from.direction * (to.pose.position() - from.pose.position());
    return std::atan2(along.y(), along.x());
  }

  [[nodiscard]] bool HasCusp(double from) const {
    const auto legs = SplitIntoLegs(path_);
    return std::any_of(legs.begin(), legs.end(), [&](const trackbed::Stations& leg) {
      return leg.to > from - step_ && leg.to < from + 3.0 * step_ && leg.to < path_.length();
    });
  }

  /// Checks the distance between the car's footprint and every obstacle along the path. Skips paths
  /// longer than 200 car lengths.
  [[nodiscard]] std::string FlawInClearance() const {
    const VehicleParams& car = request_.vehicle;
    const double spacing = 0.1 * car.length;
    if (request_.obstacles.empty() || path_.length() > 2000.0 * spacing) {
      return "";
    }
    std::vector<audit::TimedPose> poses;
    for (const PathPoint& point : path_.Sample(spacing)) {
      poses.push_back({0.0, point.pose.x, point.pose.y, point.pose.yaw});
    }
    const audit::Rectangle footprint{-car.rear_overhang, car.length - car.rear_overhang, car.width};
    for (const OrientedBox& box : request_.obstacles) {
      const audit::Box own{
          {0.0, box.center.x, box.center.y, box.center.yaw}, box.length, box.width, {}};
      const double gap = audit::SweptGap(footprint, poses, own, 1e-3 * car.length).gap;
      if (!(gap > 0.0)) {
        return fmt::format("leads {} m deep through a box at {} {}", -gap, box.center.x,
                           box.center.y);
      }
    }
    return "";
  }

  const Plan& plan_;
  const PlanRequest& request_;
  const PlannerEntry& entry_;
  const Path& path_;
  double sharpest_;        // Largest curvature [1/m].
  double step_;            // Length of a chord [m].
  double rounding_ = 0.0;  // Rounding error of positions [m].
};

}  // namespace

std::string FlawIn(const Plan& plan, const PlanRequest& request, const PlannerEntry& entry) {
  return Measurement(plan, request, entry).Flaw();
}

}  // namespace properties
