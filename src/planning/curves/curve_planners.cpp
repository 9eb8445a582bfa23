#include "trackbed/planning/curves/curve_planners.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "trackbed/planning/common/curvature_steps.h"
#include "trackbed/planning/common/route.h"
#include "trackbed/planning/curves/dubins.h"
#include "trackbed/planning/curves/reeds_shepp.h"

namespace trackbed {
namespace {

using route::CheckRadius;
using route::CheckRoute;
using route::CheckStops;
using route::IsFree;
using route::LeadInForCurves;
using route::RadiusFor;
using route::Refused;

/// A candidate curve between two stops, with its cost.
struct FoundCurve {
  std::vector<Segment> segments;
  ShortestCurve curve;
  std::ptrdiff_t shorter_ones_blocked = 0;
  double cost = 0.0;  // [m]
};

/// Returns the cheapest collision-free curve among `words` that `may_begin` accepts, judging by the
/// first segments. The cost of a curve is the length plus kStopPenalty per stop.
template <typename MayBegin>
std::optional<FoundCurve> FirstFree(const PlanRequest& request, const CollisionChecker& clear,
                                    const Pose2& from, const std::vector<ShortestCurve>& words,
                                    double min_speed, const MayBegin& may_begin) {
  // Cost of a stop [m], equal to the penalty of hybrid A* for a change of direction.
  constexpr double kStopPenalty = 5.0;
  std::vector<FoundCurve> candidates;
  for (std::size_t i = 0; i < words.size(); ++i) {
    std::vector<Segment> own = ToSegments(words[i]);
    if (may_begin(own)) {
      const auto stops =
          static_cast<double>(PlanSteps(request.vehicle, own, min_speed).stops.size());
      candidates.push_back({std::move(own), words[i], static_cast<std::ptrdiff_t>(i),
                            words[i].length + kStopPenalty * stops});
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const FoundCurve& a, const FoundCurve& b) { return a.cost < b.cost; });
  const auto free =
      std::find_if(candidates.begin(), candidates.end(),
                   [&](const FoundCurve& curve) { return IsFree(clear, from, curve.segments); });
  return free == candidates.end() ? std::nullopt : std::optional(std::move(*free));
}

/// Plans a path whose leg between two successive stops is the cheapest collision-free curve among
/// `words`.
template <typename Options, typename Words>
Plan PlanCurves(const Options& options, const PlanRequest& request, const Words& words) {
  for (Plan refused : {CheckRoute(request), CheckRadius(request.vehicle, options.radius)}) {
    if (!refused.ok()) {
      return refused;
    }
  }
  const double radius = RadiusFor(request.vehicle, options.radius);
  const CollisionChecker clear(request.vehicle, request.obstacles, options.safe_distance);
  const std::vector<Pose2> stops = PlannedStops(request);
  if (Plan refused = CheckStops(stops, clear); !refused.ok()) {
    return refused;
  }
  Plan plan;
  CurveDiagnostics found_curves;
  std::vector<Segment> segments;
  const auto any = [](const std::vector<Segment>&) { return true; };
  for (std::size_t i = 1; i < stops.size(); ++i) {
    const bool rolls = i == 1 && request.start_speed > 0.0;
    std::vector<ShortestCurve> all = words(stops[i - 1], stops[i], radius);
    std::optional<FoundCurve> found;
    if (rolls) {
      // The curve may start at the car if the wheels already have the curve's steering angle;
      // otherwise a lead-in path turns the wheels first. Take the cheaper of the curves with and
      // without lead-in.
      const double bend = CurvatureForSteering(request.vehicle, request.start_steering);
      found = FirstFree(request, clear, stops[0], all, options.min_speed, [&](const auto& own) {
        constexpr double kEqualityTolerance = 1e-6;  // [1/m]
        return !own.empty() && own.front().direction > 0 &&
               std::abs(own.front().curvature - bend) < kEqualityTolerance;
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
          fmt::format("all {} curves to waypoint {} collide with obstacles{}", all.size(), i,
                      rolls ? " or start with a steering step; a car at rest (mission.start.speed: "
                              "0) has more curves"
                            : ""));
    }
    segments.insert(segments.end(), found->segments.begin(), found->segments.end());
    found_curves.curves.push_back({.word = CurveWord(found->curve),
                                   .length = found->curve.length,
                                   .radius = radius,
                                   .shorter_ones_blocked = found->shorter_ones_blocked});
  }
  plan.diagnostics.planner = std::move(found_curves);
  return route::AlongSegments(std::move(plan), request, std::move(segments), options.min_speed);
}

Plan PlanWith(const DubinsOptions& options, const PlanRequest& request) {
  return PlanCurves(options, request, DubinsWords);
}

Plan PlanWith(const ReedsSheppOptions& options, const PlanRequest& request) {
  // All Reeds-Shepp words to a pose may begin in reverse, which a rolling car cannot drive.
  // Therefore the Dubins words, which begin forwards, are candidates too.
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

}  // namespace

void Visit(DiagnosticsVisitor& out, const CurveFindings& own) {
  out.Text("word", own.word);
  out.Number("length_m", own.length);
  out.Number("radius_m", own.radius);
  out.Integer("shorter_ones_blocked", own.shorter_ones_blocked);
}

void Visit(DiagnosticsVisitor& out, const CurveDiagnostics& own) {
  out.List("curves", own.curves);
}

void Visit(KeyVisitor& keys, DubinsOptions& options) {
  route::VisitCurves(keys, options.radius, options.safe_distance, options.min_speed);
}

void Visit(KeyVisitor& keys, ReedsSheppOptions& options) {
  route::VisitCurves(keys, options.radius, options.safe_distance, options.min_speed);
}

PlannerEntry DubinsPlanner() {
  return {.name = "dubins",
          .summary = "shortest forward curves through waypoints with headings (Dubins)",
          .defaults = DubinsOptions{},
          .plan = PlanBy<DubinsOptions, PlanWith>,
          .min_waypoints = 2,
          .keeps_clear = true,
          .has_headings = true};
}

PlannerEntry ReedsSheppPlanner() {
  return {.name = "reeds_shepp",
          .summary =
              "shortest forward and reverse curves through waypoints with headings (Reeds-Shepp)",
          .defaults = ReedsSheppOptions{},
          .plan = PlanBy<ReedsSheppOptions, PlanWith>,
          .min_waypoints = 2,
          .keeps_clear = true,
          .has_headings = true,
          .goes_backwards = true};
}

}  // namespace trackbed
