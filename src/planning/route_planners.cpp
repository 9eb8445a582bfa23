#include "src/planning/route_planners.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/planning/lead_in.h"
#include "trackbed/planning/clear_way.h"
#include "trackbed/planning/curvature_steps.h"
#include "trackbed/planning/dubins.h"
#include "trackbed/planning/feasibility.h"
#include "trackbed/planning/reeds_shepp.h"

namespace trackbed {
namespace {

std::string FirstCorner(const std::vector<Vec2>& points) {
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Vec2 in = points[i] - points[i - 1];
    const Vec2 out = points[i + 1] - points[i];
    const double turn = std::atan2(Cross(in, out), in.dot(out));
    if (std::abs(turn) > 1e-6) {
      return fmt::format("the heading jumps by {:.3g} rad at ({:.4g}, {:.4g}); no car drives that",
                         turn, points[i].x(), points[i].y());
    }
  }
  return "";
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
        fmt::format("{} waypoints; a start and a goal are needed", request.waypoints.size()));
  }
  for (std::size_t i = 1; i < request.waypoints.size(); ++i) {
    if (request.waypoints[i] == request.waypoints[i - 1]) {
      return Refused(PlanStatus::kDuplicateWaypoints,
                     fmt::format("waypoint {} is the one before it", i));
    }
  }
  if (request.waypoints[1] == request.start.position()) {
    return Refused(PlanStatus::kDuplicateWaypoints, "the car stands at waypoint 1");
  }
  return {};
}

void Complete(Plan& plan, const PlanRequest& request) {
  const Path& path = plan.reference.path;
  SetSpeeds(plan, request.start_speed, request.speed);
  plan.schedule =
      CourseSchedule(request.vehicle, path.segments(), request.speed.speed, plan.caps, plan.stops);
  plan.goal = path.At(path.length()).pose;
  plan.diagnostics["turns"] = nlohmann::json::array();
  plan.diagnostics["changes_of_direction"] = LegsOf(path).size() - 1;
}

Plan AlongPolyline(Plan plan, const PlanRequest& request, const std::vector<Vec2>& points,
                   Corners corners, double safe_distance, double min_speed) {
  if (corners == Corners::kRefuse) {
    if (const std::string corner = FirstCorner(points); !corner.empty()) {
      return Refused(PlanStatus::kTurnTooTight, corner);
    }
  }
  RoundedCorners rounded =
      RoundCorners(request.vehicle, points,
                   {.speed = request.speed.speed,
                    .min_speed = std::min(min_speed, request.speed.speed),
                    .max_curvature = 1.0 / request.vehicle.min_turning_radius(),
                    .start_speed = request.start_speed,
                    .deceleration = request.speed.deceleration},
                   ClearWay(request.vehicle, request.obstacles, safe_distance));
  if (rounded.status != PlanStatus::kOk) {
    return Refused(rounded.status, rounded.reason);
  }
  plan.diagnostics["corners"] = nlohmann::json::array();
  for (const RoundCorner& corner : rounded.corners) {
    plan.diagnostics["corners"].push_back({{"at_m", {corner.at.x(), corner.at.y()}},
                                           {"heading_change_rad", corner.heading_change},
                                           {"speed_mps", corner.speed},
                                           {"curvature_radpm", corner.curvature},
                                           {"tangent_length_m", corner.tangent_length},
                                           {"from_s_m", corner.from},
                                           {"to_s_m", corner.to}});
  }
  plan.reference.path = std::move(rounded.path);
  plan.caps = std::move(rounded.caps);
  Complete(plan, request);
  return plan;
}

nlohmann::json ToJson(const std::vector<Vec2>& points) {
  nlohmann::json list = nlohmann::json::array();
  for (const Vec2& point : points) {
    list.push_back({point.x(), point.y()});
  }
  return list;
}

}  // namespace route

namespace {

using route::CheckRoute;
using route::Complete;
using route::Refused;

/// The radius to plan with, or why there is none.
Plan CheckRadius(const VehicleParams& vehicle, const std::optional<double>& radius) {
  if (radius && *radius < vehicle.min_turning_radius()) {
    return Refused(PlanStatus::kTurnTooTight,
                   fmt::format("a radius of {:.4g} m; the car turns on {:.4g} m or more", *radius,
                               vehicle.min_turning_radius()));
  }
  return {};
}

double RadiusFor(const VehicleParams& vehicle, const std::optional<double>& radius) {
  return radius.value_or(1.1 * vehicle.min_turning_radius());
}

/// Whether the car can stand at every stop.
Plan CheckStops(const std::vector<Pose2>& stops, const ClearWay& clear) {
  for (std::size_t i = 0; i < stops.size(); ++i) {
    if (!clear.IsFree(stops[i])) {
      const std::string place = fmt::format("({:.4g}, {:.4g})", stops[i].x, stops[i].y);
      return i == 0
                 ? Refused(PlanStatus::kStartBlocked,
                           "the car stands too near to an obstacle at " + place)
                 : Refused(PlanStatus::kGoalBlocked,
                           fmt::format("an obstacle is too near to waypoint {} at {}", i, place));
    }
  }
  return {};
}

/// A plan along arcs and straights.
Plan AlongSegments(Plan plan, const PlanRequest& request, std::vector<Segment> segments,
                   double min_speed) {
  StepSpeeds steps = PlanSteps(request.vehicle, segments, min_speed);
  plan.caps = std::move(steps.caps);
  plan.stops = std::move(steps.stops);
  plan.reference.path = Path(request.start, std::move(segments));
  Complete(plan, request);
  if (!plan.stops.empty()) {
    plan.diagnostics["stops_m"] = plan.stops;
  }
  return plan;
}

bool IsFree(const ClearWay& clear, Pose2 pose, const std::vector<Segment>& segments) {
  return !clear.FirstBlocked(Path(pose, segments));
}

/// One way from a pose to a stop, and where it begins.
struct FoundCurve {
  std::vector<Segment> segments;
  ShortestCurve curve;
  std::ptrdiff_t shorter_ones_blocked = 0;
  double cost = 0.0;  // [m]
};

/// The shortest of `words` that is free and begins as it may, a stop counting as so many meters.
template <typename MayBegin>
std::optional<FoundCurve> FirstFree(const PlanRequest& request, const ClearWay& clear,
                                    const Pose2& from, const std::vector<ShortestCurve>& words,
                                    double min_speed, const MayBegin& may_begin) {
  constexpr double kStop = 5.0;  // [m]; as changes of direction cost hybrid A*
  std::vector<FoundCurve> candidates;
  for (std::size_t i = 0; i < words.size(); ++i) {
    std::vector<Segment> own = SegmentsOf(words[i]);
    if (may_begin(own)) {
      const auto stops =
          static_cast<double>(PlanSteps(request.vehicle, own, min_speed).stops.size());
      candidates.push_back({std::move(own), words[i], static_cast<std::ptrdiff_t>(i),
                            words[i].length + kStop * stops});
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const FoundCurve& a, const FoundCurve& b) { return a.cost < b.cost; });
  const auto free =
      std::find_if(candidates.begin(), candidates.end(),
                   [&](const FoundCurve& curve) { return IsFree(clear, from, curve.segments); });
  return free == candidates.end() ? std::nullopt : std::optional(std::move(*free));
}

/// Where a rolling car's curves begin: after it has slowed down for the first step of curvature.
LeadIn LeadInForCurves(const PlanRequest& request, double radius, double min_speed) {
  const double curvature = 1.0 / radius;
  const double speed = std::max(StepSpeed(request.vehicle, 0.0, curvature), min_speed);
  return LeadInOf(request, std::min(speed, request.start_speed),
                  0.5 * SteeringDistance(request.vehicle,
                                         SteeringForCurvature(request.vehicle, curvature), speed));
}

/// Plans from stop to stop by the first of `words` that is free.
template <typename Options, typename Words>
Plan PlanCurves(const Options& options, const PlanRequest& request, const Words& words) {
  for (Plan refused : {CheckRoute(request), CheckRadius(request.vehicle, options.radius)}) {
    if (!refused.ok()) {
      return refused;
    }
  }
  const double radius = RadiusFor(request.vehicle, options.radius);
  const ClearWay clear(request.vehicle, request.obstacles, options.safe_distance);
  const std::vector<Pose2> stops = StopsOf(request);
  if (Plan refused = CheckStops(stops, clear); !refused.ok()) {
    return refused;
  }
  Plan plan;
  plan.diagnostics["curves"] = nlohmann::json::array();
  std::vector<Segment> segments;
  const auto any = [](const std::vector<Segment>&) { return true; };
  for (std::size_t i = 1; i < stops.size(); ++i) {
    const bool rolls = i == 1 && request.start_speed > 0.0;
    std::vector<ShortestCurve> all = words(stops[i - 1], stops[i], radius);
    std::optional<FoundCurve> found;
    if (rolls) {
      // At once, if the wheels stand right for it, or after a lead-in; whichever is shorter.
      const double bend = CurvatureForSteering(request.vehicle, request.start_steering);
      found = FirstFree(request, clear, stops[0], all, options.min_speed, [&](const auto& own) {
        constexpr double kSame = 1e-6;  // [1/m]
        return !own.empty() && own.front().direction > 0 &&
               std::abs(own.front().curvature - bend) < kSame;
      });
      const LeadIn lead = LeadInForCurves(request, radius, options.min_speed);
      const auto forwards = [](const std::vector<Segment>& own) {
        return own.empty() || own.front().direction > 0;
      };
      std::optional<FoundCurve> later;
      if (IsFree(clear, stops[0], lead.segments)) {
        later = FirstFree(request, clear, lead.end, words(lead.end, stops[1], radius),
                          options.min_speed, forwards);
      }
      if (later && (!found || lead.length + later->cost < found->cost)) {
        later->segments.insert(later->segments.begin(), lead.segments.begin(), lead.segments.end());
        found = std::move(later);
      }
    } else {
      found = FirstFree(request, clear, stops[i - 1], all, options.min_speed, any);
    }
    if (!found) {
      return Refused(
          PlanStatus::kNoPath,
          fmt::format("none of the {} curves to waypoint {} is free of obstacles{}", all.size(), i,
                      rolls ? " and begins as the car rolls; a car at rest "
                              "(mission.start.speed: 0) has more"
                            : ""));
    }
    segments.insert(segments.end(), found->segments.begin(), found->segments.end());
    plan.diagnostics["curves"].push_back({{"word", WordOf(found->curve)},
                                          {"length_m", found->curve.length},
                                          {"radius_m", radius},
                                          {"shorter_ones_blocked", found->shorter_ones_blocked}});
  }
  return AlongSegments(std::move(plan), request, std::move(segments), options.min_speed);
}

}  // namespace

std::vector<Pose2> StopsOf(const PlanRequest& request) {
  const std::vector<Vec2>& points = request.waypoints;
  std::vector<Pose2> stops{request.start};
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Vec2 before = stops.back().position();
    const Vec2 along = points[std::min(i + 1, points.size() - 1)] - before;
    stops.push_back(
        {points[i].x(), points[i].y(),
         request.headings.empty() ? std::atan2(along.y(), along.x()) : request.headings[i]});
  }
  return stops;
}

Plan PlanWith(const DubinsOptions& options, const PlanRequest& request) {
  return PlanCurves(options, request, DubinsWords);
}

Plan PlanWith(const ReedsSheppOptions& options, const PlanRequest& request) {
  // Every word to a pose may begin backwards, which a car that rolls cannot; Dubins' do not.
  return PlanCurves(options, request, [](const Pose2& from, const Pose2& to, double radius) {
    std::vector<ShortestCurve> words = ReedsSheppWords(from, to, radius);
    const std::vector<ShortestCurve> forwards = DubinsWords(from, to, radius);
    words.insert(words.end(), forwards.begin(), forwards.end());
    std::stable_sort(
        words.begin(), words.end(),
        [](const ShortestCurve& a, const ShortestCurve& b) { return a.length < b.length; });
    return words;
  });
}

Plan PlanWith(const HybridAStarOptions& options, const PlanRequest& request) {
  for (Plan refused : {CheckRoute(request), CheckRadius(request.vehicle, options.radius)}) {
    if (!refused.ok()) {
      return refused;
    }
  }
  std::vector<Pose2> stops = StopsOf(request);
  Plan plan;
  plan.diagnostics["legs"] = nlohmann::json::array();
  const bool rolls = request.start_speed > 0.0;
  std::vector<Segment> segments;
  if (rolls) {
    const LeadIn lead =
        LeadInForCurves(request, RadiusFor(request.vehicle, options.radius), options.min_speed);
    const ClearWay clear(request.vehicle, request.obstacles, options.safe_distance);
    if (!IsFree(clear, stops[0], lead.segments)) {
      return Refused(PlanStatus::kStartBlocked,
                     fmt::format("an obstacle is too near to the first {:.3g} m, in which the "
                                 "rolling car slows down for its first bend",
                                 lead.length));
    }
    segments = lead.segments;
    stops[0] = lead.end;
  }
  for (std::size_t i = 1; i < stops.size(); ++i) {
    const HybridAStarResult found = SearchHybridAStar(request.vehicle,
                                                      {.start = stops[i - 1],
                                                       .goal = stops[i],
                                                       .obstacles = request.obstacles,
                                                       .rolls = i == 1 && rolls},
                                                      options);
    if (!found.ok()) {
      return Refused(found.status,
                     fmt::format("from waypoint {} to {}: {}", i - 1, i, found.reason));
    }
    segments.insert(segments.end(), found.segments.begin(), found.segments.end());
    plan.diagnostics["legs"].push_back(
        {{"cost_m", found.cost}, {"expansions", found.expansions}, {"cells", found.cells}});
  }
  return AlongSegments(std::move(plan), request, std::move(segments), options.min_speed);
}

}  // namespace trackbed
