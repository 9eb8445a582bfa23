#include "trackbed/planning/common/route.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/planning/common/start_excess.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/course_schedule.h"
#include "trackbed/planning/common/curvature_steps.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/turn_behind.h"
#include "trackbed/world/world.h"

// Functions that the planners of routes share: checks of requests, stops at waypoints, and option
// keys. A stop without a given heading faces along the circle through the previous stop, the
// waypoint and the next waypoint. A goal without a given heading faces away from the last stop.

namespace trackbed {
namespace {

constexpr Key kCurveRadius{"radius", "m",
                           "radius of the arcs; default: 1.1 times the minimum turning radius"};
constexpr Key kStepSpeed{"min_speed", "m/s", "minimum speed at curvature steps"};

std::string FirstCorner(const std::vector<Vec2>& points) {
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Vec2 in = points[i] - points[i - 1];
    const Vec2 out = points[i + 1] - points[i];
    const double turn = std::atan2(Cross(in, out), in.dot(out));
    if (std::abs(turn) > 1e-6) {
      return fmt::format("the heading jumps by {:.3g} rad at ({:.4g}, {:.4g})", turn, points[i].x(),
                         points[i].y());
    }
  }
  return "";
}

/// Returns the direction at `at` of the circle from `before` through `at` to `after`, of any
/// length. An inversion about `at` maps the circle to a line, so the direction is that of the line
/// through the images of `before` and `after`. If `after` equals `before`, the direction is the
/// left normal of the line from `before` to `at`.
Vec2 CircleTangent(const Vec2& before, const Vec2& at, const Vec2& after) {
  const Vec2 in = at - before;
  const Vec2 out = after - at;
  const Vec2 tangent = in * out.squaredNorm() + out * in.squaredNorm();
  return tangent == Vec2::Zero() ? LeftNormal(in) : tangent;
}

}  // namespace

namespace route {

Plan Refused(PlanStatus status, std::string reason) {
  Plan plan;
  plan.status = status;
  plan.reason = std::move(reason);
  return plan;
}

Plan CheckRoute(const PlanRequest& request) {
  if (request.waypoints.size() < 2) {
    return Refused(
        PlanStatus::kTooFewWaypoints,
        fmt::format("{} waypoints; must be at least a start and a goal", request.waypoints.size()));
  }
  if (request.waypoints[1] == request.start.position()) {
    return Refused(PlanStatus::kDuplicateWaypoints, "the car starts at waypoint 1");
  }
  for (std::size_t i = 2; i < request.waypoints.size(); ++i) {
    if (request.waypoints[i] == request.waypoints[i - 1]) {
      return Refused(PlanStatus::kDuplicateWaypoints,
                     fmt::format("waypoint {} equals the previous one", i));
    }
  }
  return {};
}

Plan CheckPoses(const PlanRequest& request) {
  if (request.headings.empty() || request.waypoints.size() < 2) {
    return CheckRoute(request);
  }
  // Largest difference of two poses, in turning radii and radians, that counts as rounding: the
  // curve between such poses has no pieces.
  constexpr double kSame = 1e-12;
  const std::vector<Pose2> stops = PlannedStops(request);
  for (std::size_t i = 1; i < stops.size(); ++i) {
    const double moved = (stops[i].position() - stops[i - 1].position()).norm();
    const double turned = AngleDifference(stops[i].yaw, stops[i - 1].yaw);
    if (moved <= kSame * request.vehicle.min_turning_radius() && std::abs(turned) <= kSame) {
      return Refused(
          PlanStatus::kDuplicateWaypoints,
          fmt::format("nothing to drive to waypoint {}: {} is there already, at ({:.10g}, "
                      "{:.10g}) with the heading {:.6g} rad; remove the waypoint, or "
                      "give it another heading",
                      i, i == 1 ? "the car" : fmt::format("waypoint {}", i - 1), stops[i].x,
                      stops[i].y, stops[i].yaw));
    }
  }
  return {};
}

void Complete(Plan& plan, const PlanRequest& request) {
  const Path& path = plan.reference.path;
  SetSpeeds(plan, request.start_speed, request.speed);
  // A car that starts faster than the mission passes the first steps of curvature while it slows
  // down.
  const double fastest = std::max(request.speed.speed, request.start_speed);
  plan.schedule = CourseSchedule(request.vehicle, path.segments(), fastest, plan.caps, plan.stops);
  plan.goal = path.At(path.length()).pose;
  plan.diagnostics.direction_changes = SplitIntoLegs(path).size() - 1;
}

Plan AlongPolyline(Plan plan, const PlanRequest& request, const std::vector<Vec2>& points,
                   Corners corners, double safe_distance, double min_speed) {
  if (corners == Corners::kRefuse) {
    if (const std::string corner = FirstCorner(points); !corner.empty()) {
      return Refused(PlanStatus::kTurnTooTight, corner);
    }
  }
  CornerLimits limits{.speed = request.speed.speed,
                      .min_speed = std::min(min_speed, request.speed.speed),
                      .max_curvature = 1.0 / request.vehicle.min_turning_radius(),
                      .start_speed = request.start_speed,
                      .deceleration = request.speed.deceleration};
  if (request.max_waypoint_miss) {
    limits.waypoints = request.waypoints;
    limits.max_gap = *request.max_waypoint_miss;
  }
  RoundedCorners rounded = RoundCornersOrTurnBehind(request.vehicle, points, limits,
                                                    CheckerFromStart(request, safe_distance));
  if (rounded.status != PlanStatus::kOk) {
    return Refused(rounded.status, rounded.reason);
  }
  plan.diagnostics.corners = std::move(rounded.corners);
  plan.reference.path = std::move(rounded.path);
  plan.caps = std::move(rounded.caps);
  Complete(plan, request);
  return plan;
}

Plan CheckRadius(const VehicleParams& vehicle, const std::optional<double>& radius) {
  if (radius && *radius < vehicle.min_turning_radius()) {
    return Refused(PlanStatus::kTurnTooTight,
                   fmt::format("radius {:.4g} m is below the minimum turning radius of {:.4g} m",
                               *radius, vehicle.min_turning_radius()));
  }
  return {};
}

double RadiusFor(const VehicleParams& vehicle, const std::optional<double>& radius) {
  return radius.value_or(1.1 * vehicle.min_turning_radius());
}

std::string NearestObstacle(const VehicleParams& vehicle, const Pose2& pose,
                            const std::vector<OrientedBox>& obstacles, double distance) {
  TRACKBED_CHECK(!obstacles.empty(), "no obstacles");
  const OrientedBox footprint = FootprintAt(vehicle, pose);
  const auto nearest = std::min_element(
      obstacles.begin(), obstacles.end(), [&](const OrientedBox& a, const OrientedBox& b) {
        return Separation(footprint, a) < Separation(footprint, b);
      });
  const double apart = Separation(footprint, *nearest);
  return fmt::format("the obstacle at ({:.4g}, {:.4g}) {}; safe_distance is {:.4g} m",
                     nearest->center.x, nearest->center.y,
                     apart < 0.0 ? fmt::format("overlaps the car's footprint by {:.3g} m", -apart)
                                 : fmt::format("is {:.3g} m from the car's footprint", apart),
                     distance);
}

CollisionChecker CheckerFromStart(const PlanRequest& request, double safe_distance) {
  return {request.vehicle, request.obstacles, safe_distance, request.start};
}

std::vector<Vec2> GoalsOutsideObstacles(const PlanRequest& request, const CollisionChecker& clear) {
  std::vector<Vec2> goals;
  std::copy_if(request.waypoints.begin() + 1, request.waypoints.end(), std::back_inserter(goals),
               [&](const Vec2& waypoint) { return clear.MayBeFree(waypoint); });
  return goals;
}

std::string WrongStart(const Plan& plan, const PlanRequest& request) {
  const std::vector<Excess> excesses = start_excess::At(plan, request);
  return excesses.empty() ? "" : ToString(excesses.front());
}

Plan GoalBlocked(const PlanRequest& request, std::size_t index, double safe_distance) {
  TRACKBED_CHECK(!request.obstacles.empty(), "no obstacles");
  const Vec2& waypoint = request.waypoints.at(index);
  const CollisionChecker clear = CheckerFromStart(request, safe_distance);
  const OrientedBox* nearest = nullptr;
  double distance = 0.0;
  double lack = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < request.obstacles.size(); ++i) {
    const double away =
        Separation({{waypoint.x(), waypoint.y(), 0.0}, 0.0, 0.0}, request.obstacles[i]);
    const double own = clear.inner_radius() + clear.distances()[i] - away;
    if (own > lack) {
      nearest = &request.obstacles[i];
      distance = away;
      lack = own;
    }
  }
  const auto millimeters_down = [](double length) { return 1e-3 * std::floor(1e3 * length); };
  const double room = millimeters_down(distance - clear.inner_radius());
  return Refused(
      PlanStatus::kGoalBlocked,
      fmt::format(
          "waypoint {} is blocked: the obstacle at ({:.4g}, {:.4g}) {}; the rear axle's center "
          "must be at least {:.4g} m away, {:.4g} m of them for the car; {}move the waypoint away "
          "from the obstacle by {:.4g} m",
          index, nearest->center.x, nearest->center.y,
          distance > 0.0 ? fmt::format("is {:.3g} m away", distance)
                         : fmt::format("covers it, {:.3g} m from the edge", -distance),
          distance + lack, clear.inner_radius(),
          room >= 0.0 ? fmt::format("set safe_distance to at most {:.4g} m, or ", room) : "",
          -millimeters_down(-lack)));
}

Plan CheckStart(const PlanRequest& request, double safe_distance) {
  return CheckStops({request.start}, request, safe_distance);
}

Plan CheckStops(const std::vector<Pose2>& stops, const PlanRequest& request, double safe_distance) {
  const CollisionChecker clear = CheckerFromStart(request, safe_distance);
  for (std::size_t i = 0; i < stops.size(); ++i) {
    if (!clear.IsFree(stops[i])) {
      const std::string why =
          NearestObstacle(request.vehicle, stops[i], request.obstacles, safe_distance);
      return i == 0 ? Refused(PlanStatus::kStartBlocked, "the start is blocked: " + why)
                    : Refused(PlanStatus::kGoalBlocked,
                              fmt::format("waypoint {} is blocked: {}", i, why));
    }
  }
  return {};
}

Plan AlongSegments(Plan plan, const PlanRequest& request, std::vector<Segment> segments,
                   double min_speed) {
  StepSpeeds steps = PlanSteps(request.vehicle, segments, min_speed);
  plan.caps = std::move(steps.caps);
  plan.stops = std::move(steps.stops);
  plan.reference.path = Path(request.start, std::move(segments));
  Complete(plan, request);
  return plan;
}

bool IsFree(const CollisionChecker& clear, const Pose2& pose,
            const std::vector<Segment>& segments) {
  return !clear.FirstBlocked(Path(pose, segments));
}

LeadIn LeadInForCurves(const PlanRequest& request, double radius, double min_speed) {
  const double curvature = 1.0 / radius;
  const double speed = std::max(StepSpeed(request.vehicle, 0.0, curvature), min_speed);
  return ComputeLeadIn(
      request, std::min(speed, request.start_speed),
      0.5 * SteeringDistance(request.vehicle, SteeringForCurvature(request.vehicle, curvature),
                             speed));
}

void VisitCurves(KeyVisitor& keys, std::optional<double>& radius, double& safe_distance,
                 double& min_speed) {
  keys.Field(kCurveRadius, radius, kPositive);
  keys.Field(kFootprintDistance, safe_distance, Need::kOptional, kNonNegative);
  keys.Field(kStepSpeed, min_speed, Need::kOptional, kPositive);
}

void VisitCorners(KeyVisitor& keys, Corners& corners, double& safe_distance, double& corner_room) {
  static const EnumNames<Corners> names{{Corners::kRound, "round"}, {Corners::kRefuse, "refuse"}};
  keys.Field({"corners", "",
              "handling of corners: rounded by clothoids and arcs that the steering can follow, or "
              "refused"},
             corners, Need::kOptional, names);
  keys.Field(kFootprintDistance, safe_distance, Need::kOptional, kNonNegative);
  keys.Field({"corner_room", "m", "additional clearance in the search, for rounded corners"},
             corner_room, Need::kOptional, kNonNegative);
}

}  // namespace route

std::vector<Pose2> PlannedStops(const PlanRequest& request) {
  const std::vector<Vec2>& points = request.waypoints;
  std::vector<Pose2> stops{request.start};
  for (std::size_t i = 1; i < points.size(); ++i) {
    const bool is_goal = i + 1 == points.size();
    const Vec2 before = stops.back().position();
    const Vec2 along =
        is_goal ? Vec2(points[i] - before) : CircleTangent(before, points[i], points[i + 1]);
    stops.push_back(
        {points[i].x(), points[i].y(),
         request.headings.empty() ? std::atan2(along.y(), along.x()) : request.headings[i]});
  }
  return stops;
}

}  // namespace trackbed
