#include "trackbed/planning/lanes/lane_route_planner.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "trackbed/core/angle.h"
#include "trackbed/planning/common/diagnostics.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/route.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/steering_reach.h"

namespace trackbed {
namespace {

/// Returns an error message if the car's pose differs from the start of the path; otherwise an
/// empty text.
std::string StartPoseError(const Pose2& car, const Pose2& path) {
  constexpr double kPlace = 1e-3;    // [m]
  constexpr double kHeading = 1e-3;  // [rad]
  const double distance = (car.position() - path.position()).norm();
  const double turn = AngleDifference(car.yaw, path.yaw);
  if (distance <= kPlace && std::abs(turn) <= kHeading) {
    return "";
  }
  return fmt::format(
      "the car starts {:.3g} m and {:.3g} rad from where the route begins, at x = {:.4g} m, y = "
      "{:.4g} m, yaw = {:.4g} rad",
      distance, turn, path.x, path.y, path.yaw);
}

/// Returns an error message about the first place of the path where the car would need more than
/// its steering limit. Returns an empty text if the car can steer through the whole path.
std::string SteeringLimitError(const VehicleParams& vehicle, const std::vector<Segment>& segments) {
  double station = 0.0;
  for (const Segment& segment : segments) {
    const double end = segment.CurvatureAt(segment.length);
    const double sharpest = std::abs(end) > std::abs(segment.curvature) ? end : segment.curvature;
    const double steering = std::abs(SteeringForCurvature(vehicle, sharpest));
    if (const double reach = SteeringReach(vehicle, sharpest); steering > reach) {
      return fmt::format(
          "the lanes' curvature of {:.4g} 1/m at s = {:.4g} m needs a steering angle of {:.3f} "
          "rad, "
          "which exceeds the limit of {:.3f} rad",
          sharpest, station, steering, reach);
    }
    station += segment.length;
  }
  return "";
}

/// Finds the mission's route; the result is not ok if the mission has no valid route.
LaneRoute FindRoute(const LaneMission& lanes) {
  LaneRoute found;
  if (!lanes.network || lanes.route.size() < 2) {
    found.failure = "needs a road network and a route of at least two places";
    return found;
  }
  for (const LanePlace& place : lanes.route) {
    found.failure = LanePlaceError(*lanes.network, place);
    if (!found.failure.empty()) {
      return found;
    }
  }
  return FindLaneRoute(*lanes.network, lanes.route);
}

Plan PlanWith(const LaneRouteOptions& options, const PlanRequest& request) {
  LaneRoute found = FindRoute(request.lanes);
  if (!found.ok()) {
    return route::Refused(PlanStatus::kNoPath, found.failure);
  }
  if (const std::string why = StartPoseError(request.start, found.path.At(0.0).pose);
      !why.empty()) {
    return route::Refused(PlanStatus::kStartBlocked, why);
  }
  if (const std::string why = SteeringLimitError(request.vehicle, found.path.segments());
      !why.empty()) {
    return route::Refused(PlanStatus::kTurnTooTight, why);
  }
  Plan plan;
  plan.roads = request.lanes.network;
  if (!found.note.empty()) {
    plan.notes.push_back(found.note);
  }
  plan.diagnostics.planner =
      LaneRouteDiagnostics{.stretches = std::move(found.stretches), .deviation = found.deviation};
  return route::AlongSegments(std::move(plan), request, found.path.segments(), options.min_speed);
}

std::optional<double> StartCurvature(const LaneRouteOptions& /*options*/, const RouteStart& route) {
  const LaneRoute found = FindRoute(route.lanes);
  return found.ok() ? std::optional(found.path.At(0.0).curvature) : std::nullopt;
}

}  // namespace

void Visit(KeyVisitor& keys, LaneRouteOptions& options) {
  keys.Field({"min_speed", "m/s", "minimum speed at curvature steps"}, options.min_speed,
             Need::kOptional, kPositive);
}

void Visit(DiagnosticsVisitor& out, const LaneStretch& stretch) {
  out.Text("road", stretch.road);
  out.Integer("lane", stretch.lane);
  out.Integer("to_lane", stretch.to_lane);
  out.Number("from_m", stretch.from);
  out.Number("to_m", stretch.to);
}

void Visit(DiagnosticsVisitor& out, const LaneRouteDiagnostics& own) {
  out.Number("deviation_max_m", own.deviation);
  out.List("lanes", own.stretches);
}

PlannerEntry LaneRoutePlanner() {
  return {.name = "lane_route",
          .summary = "lane centers of a road network, from place to place of mission.route",
          .defaults = LaneRouteOptions{},
          .plan = PlanBy<LaneRouteOptions, PlanWith>,
          .follows_lanes = true,
          .start_curvature = OnOptions<LaneRouteOptions, StartCurvature>};
}

}  // namespace trackbed
