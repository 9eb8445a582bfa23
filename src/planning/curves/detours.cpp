// Replans routes whose paths have loops.
//
// 1. Dynamic programming finds the headings of the shortest route, among sixteen directions and the
//    default direction at each waypoint. Start and goal keep their headings.
// 2. LeaveOutCloseWaypoints removes waypoints, with the room that curves of continuous curvature
//    need at four speeds. Of the plans with a shorter path or fewer stops, the planner chooses the
//    quickest.
// The shortest path of bounded curvature through a sequence of points is the problem of Goaoc, Kim
// and Lazard 2013, who solve it by convex optimization for distant points.
#include "src/planning/curves/detours.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "trackbed/core/angle.h"
#include "trackbed/planning/common/driving_time.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/fewer_corners.h"
#include "trackbed/planning/common/plan_comparison.h"
#include "trackbed/planning/common/route.h"
#include "trackbed/planning/common/waypoint_miss.h"

namespace trackbed {
namespace {

/// Number of directions at a waypoint.
constexpr int kDirections = 16;

/// A heading at a stop, with the shortest route to the stop that ends in this heading.
struct HeadingChoice {
  double yaw = 0.0;        // Heading [rad].
  double length = 0.0;     // Length of the route up to the stop [m].
  std::size_t before = 0;  // Index of the heading at the previous stop.
};

/// Returns the headings to try at stop `i`, beginning with the heading of the stop.
std::vector<HeadingChoice> HeadingsAt(const std::vector<Pose2>& stops, std::size_t i) {
  std::vector<HeadingChoice> choices{{.yaw = stops[i].yaw}};
  if (i > 0 && i + 1 < stops.size()) {
    for (int k = 0; k < kDirections; ++k) {
      choices.push_back({.yaw = WrapAngle(2.0 * kPi * k / kDirections)});
    }
  }
  return choices;
}

/// Returns the length of the shortest route through stops with these headings [m].
double RouteLength(const std::vector<Pose2>& stops, double radius, const CurveLength& length) {
  double sum = 0.0;
  for (std::size_t i = 1; i < stops.size(); ++i) {
    sum += length(stops[i - 1], stops[i], radius);
  }
  return sum;
}

/// Returns the stops with the headings of the shortest route.
std::vector<Pose2> WithShortestHeadings(std::vector<Pose2> stops, double radius,
                                        const CurveLength& length) {
  std::vector<std::vector<HeadingChoice>> choices;
  for (std::size_t i = 0; i < stops.size(); ++i) {
    choices.push_back(HeadingsAt(stops, i));
    for (HeadingChoice& own : choices.back()) {
      if (i == 0) {
        continue;
      }
      own.length = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < choices[i - 1].size(); ++k) {
        const HeadingChoice& before = choices[i - 1][k];
        const double total = before.length + length({stops[i - 1].x, stops[i - 1].y, before.yaw},
                                                    {stops[i].x, stops[i].y, own.yaw}, radius);
        if (total < own.length) {
          own.length = total;
          own.before = k;
        }
      }
    }
  }
  for (std::size_t i = stops.size(), k = 0; i-- > 0;) {
    stops[i].yaw = choices[i][k].yaw;
    k = choices[i][k].before;
  }
  return stops;
}

/// Returns the number of places between start and goal at which the car stops.
std::size_t Stops(const Plan& plan) {
  std::size_t count = plan.stops.size();
  const std::vector<Segment>& segments = plan.reference.path.segments();
  for (std::size_t i = 1; i < segments.size(); ++i) {
    count += segments[i].direction != segments[i - 1].direction ? std::size_t{1} : std::size_t{0};
  }
  return count;
}

class DetourPlanner {
 public:
  DetourPlanner(const PlanRequest& request, const CurveLength& length,
                const CurvePlanning& planning)
      : request_(request),
        length_(length),
        planning_(planning),
        radius_(request.vehicle.min_turning_radius()) {}

  [[nodiscard]] Plan Make() {
    TriedPlan tried = Try(request_);
    if (request_.waypoints.size() < 2 || tried.plan.status == PlanStatus::kDuplicateWaypoints ||
        !HasDetour(tried)) {
      return Faster(request_, std::move(tried.plan));
    }
    std::optional<LeftOut> left_out;
    if (request_.headings.empty() && request_.waypoints.size() > 2) {
      TryOtherHeadings(tried, request_, tried);
      left_out = TryFewerWaypoints(tried);
    }
    Plan best = Faster(request_, std::move(tried.plan));
    if (left_out) {
      const auto miss = LargestWaypointMiss(best.reference.path, request_.waypoints);
      best.notes.push_back(
          DescribeLeftOut(left_out->count, left_out->why, miss.value_or(WaypointMiss{})));
    }
    NoteDetourOfHeadings(best);
    NoteDetourOfRollingStart(request_, best,
                             [&](const PlanRequest& request) { return PlanFaster(request); });
    return best;
  }

 private:
  /// A plan, and whether the car can drive it.
  struct TriedPlan {
    Plan plan;
    bool is_drivable = false;
  };

  /// The waypoints that a plan leaves out.
  struct LeftOut {
    std::size_t count = 0;
    std::string why;
  };

  [[nodiscard]] Plan Faster(const PlanRequest& request, Plan plan) const {
    return planning_.faster ? planning_.faster(request, std::move(plan)) : plan;
  }

  [[nodiscard]] Plan PlanFaster(const PlanRequest& request) const {
    return Faster(request, planning_.plan(request));
  }

  [[nodiscard]] TriedPlan Try(const PlanRequest& request) const {
    TriedPlan tried{.plan = planning_.plan(request)};
    tried.is_drivable = IsDrivable(tried.plan);
    return tried;
  }

  [[nodiscard]] bool HasDetour(const TriedPlan& tried) const {
    return IsDetour(tried.plan, request_) || Stops(tried.plan) > 0 || !tried.is_drivable;
  }

  /// Returns whether the car can drive a plan from its start speed. After the start, the plan may
  /// slow the car down.
  [[nodiscard]] bool IsDrivable(const Plan& plan) const {
    PlanRequest request = request_;
    request.infeasible = InfeasiblePolicy::kSlowDown;
    return plan.ok() && MakeFeasible(plan, request).ok();
  }

  /// Returns whether `own` is a better plan than `other`. If only one of the two plans is drivable,
  /// the drivable plan is better. If both are drivable, `own` is better if it takes no longer to
  /// drive, and is shorter by the smallest turning radius or has fewer stops.
  [[nodiscard]] bool IsBetter(const TriedPlan& own, const TriedPlan& other) const {
    if (own.is_drivable != other.is_drivable) {
      return own.is_drivable;
    }
    const Plan& plan = own.plan;
    const Plan& best = other.plan;
    return IsShorterAndNotSlower(plan, best, request_.vehicle) ||
           (plan.ok() && best.ok() && Stops(plan) < Stops(best) &&
            DrivingTime(plan, request_.vehicle) <= DrivingTime(best, request_.vehicle));
  }

  /// Returns whether a plan through the given stops may be better than `best`. No path is shorter
  /// than the shortest curves of the smallest radius, so a plan is made only if the shortest curves
  /// are short enough.
  [[nodiscard]] bool MayBeBetter(const std::vector<Pose2>& stops, const TriedPlan& best) const {
    return !best.is_drivable || Stops(best.plan) > 0 ||
           RouteLength(stops, radius_, length_) + radius_ <= PlanLength(best.plan);
  }

  /// Replaces the plan `own` by a shorter plan with other headings, if the shorter plan may also be
  /// better than the plan `best`. The tried headings are those of the shortest route whose arcs
  /// have a given radius. Steering ramps need more room than arcs, so larger radii are tried as
  /// long as the plan has a detour.
  void TryOtherHeadings(TriedPlan& own, const PlanRequest& request, const TriedPlan& best) const {
    const std::vector<Pose2> stops = PlannedStops(request);
    std::vector<double> tried;
    for (const double share : {1.0, 1.5, 2.25}) {
      const double radius = share * radius_;
      const std::vector<Pose2> shortest = WithShortestHeadings(stops, radius, length_);
      PlanRequest turned = request;
      for (const Pose2& stop : shortest) {
        turned.headings.push_back(stop.yaw);
      }
      if (turned.headings == tried ||
          RouteLength(shortest, radius, length_) + radius_ > RouteLength(stops, radius, length_) ||
          !MayBeBetter(shortest, own) || !MayBeBetter(shortest, best)) {
        continue;
      }
      tried = turned.headings;
      TriedPlan other = Try(turned);
      if (IsBetter(other, own)) {
        own = std::move(other);
      }
      if (!HasDetour(own)) {
        return;
      }
    }
  }

  /// Replaces the plan `best` by a better plan that leaves out waypoints. Returns the waypoints
  /// left out; nullopt if no such plan is better.
  [[nodiscard]] std::optional<LeftOut> TryFewerWaypoints(TriedPlan& best) const {
    std::vector<Vec2> tried = request_.waypoints;
    std::optional<TriedPlan> fewest;
    std::optional<LeftOut> left_out;
    const double fastest = std::max(request_.speed.speed, request_.start_speed);
    for (const double share : {0.25, 0.5, 1.0, 2.0}) {
      const double near = kUnnoticedShareOfWidth * request_.vehicle.width;
      std::vector<Vec2> fewer = LeaveOutCloseWaypoints(
          request_.waypoints, {.waypoints = request_.waypoints,
                               .max_gap = near,
                               .room = [&](double turn) { return RoomOf(turn, share * fastest); },
                               .end_share = 0.5,
                               .keeps_first_direction = false,
                               .start_yaw = request_.start.yaw});
      if (fewer == tried || fewer == request_.waypoints) {
        continue;
      }
      tried = fewer;
      PlanRequest request = request_;
      request.waypoints = std::move(fewer);
      TriedPlan own =
          MayBeBetter(PlannedStops(request), best)
              ? Try(request)
              : TriedPlan{route::Refused(PlanStatus::kNoPath, "longer than another path")};
      TryOtherHeadings(own, request, best);
      const Plan& plan = own.plan;
      const auto miss =
          plan.ok() ? LargestWaypointMiss(plan.reference.path, request_.waypoints) : std::nullopt;
      if (miss && miss->distance <= near && IsBetter(own, best) &&
          (!fewest ||
           DrivingTime(plan, request_.vehicle) < DrivingTime(fewest->plan, request_.vehicle))) {
        left_out = {request_.waypoints.size() - request.waypoints.size(), WhyLeftOut(best, plan)};
        fewest = std::move(own);
      }
    }
    if (fewest) {
      best = *std::move(fewest);
    }
    return left_out;
  }

  /// Returns the room that a corner needs at a speed [m/s]. The room is the tangent of an arc, or
  /// half of a leg on which the car corrects a heading error e without leaving the leg at its ends.
  /// The car corrects a heading error by two triangular curvature pulses of opposite signs. The
  /// ratio of the pulses' lengths is the golden ratio phi. With the sharpness sigma and the heading
  /// error e, both pulses need a leg of length sqrt(4 phi^3 e/sigma).
  [[nodiscard]] CornerRoom RoomOf(double turn, double speed) const {
    const VehicleParams& car = request_.vehicle;
    const double sharpness = car.steering_rate / (car.wheelbase * speed);
    const double phi = std::numbers::phi;
    return {.tangent = std::max(radius_ * std::tan(0.5 * turn),
                                std::sqrt(phi * phi * phi * turn / sharpness)),
            .gap = 0.0};
  }

  [[nodiscard]] std::string WhyLeftOut(const TriedPlan& tried, const Plan& plan) const {
    const Plan& all = tried.plan;
    if (!tried.is_drivable) {
      return all.ok() ? "the car cannot drive the path through all waypoints at its start speed"
                      : "no path leads through all waypoints";
    }
    const double length = PlanLength(plan);
    if (length + radius_ <= PlanLength(all)) {
      return fmt::format(
          "the path through all waypoints would be {:.4g} m long instead of {:.4g} m",
          PlanLength(all), length);
    }
    return fmt::format(
        "the path through all waypoints would stop {} instead of {} times between "
        "start and goal",
        Stops(all), Stops(plan));
  }

  /// Adds a note if the path is a detour only because of the mission's headings. Around obstacles,
  /// detours are common and another search takes time, so no note is added.
  void NoteDetourOfHeadings(Plan& best) const {
    if (!best.ok() || request_.headings.empty() || !request_.obstacles.empty() ||
        !IsDetour(best, request_)) {
      return;
    }
    PlanRequest request = request_;
    request.headings.clear();
    const Plan along_legs = PlanFaster(request);
    if (IsShorterAndNotSlower(along_legs, best, request_.vehicle)) {
      best.notes.push_back(
          fmt::format("the path is {:.4g} m long, because mission.headings demands it; without "
                      "mission.headings, it is {:.4g} m long",
                      PlanLength(best), PlanLength(along_legs)));
    }
  }

  const PlanRequest& request_;
  const CurveLength& length_;
  const CurvePlanning& planning_;
  double radius_;  // smallest of the car [m]
};

}  // namespace

Plan WithoutDetours(const PlanRequest& request, const CurveLength& length,
                    const CurvePlanning& planning) {
  return DetourPlanner(request, length, planning).Make();
}

std::string DescribeLeftOut(std::size_t count, const std::string& why, const WaypointMiss& miss) {
  return fmt::format(
      "{} left out, because {}; the path passes {} at {:.3g} m; to drive through every waypoint, "
      "set mission.headings",
      count == 1 ? "1 waypoint is" : fmt::format("{} waypoints are", count), why,
      DescribeWaypoint(miss.waypoint, miss.at), miss.distance);
}

}  // namespace trackbed
