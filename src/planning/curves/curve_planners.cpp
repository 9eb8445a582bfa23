#include "trackbed/planning/curves/curve_planners.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/planning/curves/clothoid_keys.h"
#include "src/planning/curves/continuous_or_steps.h"
#include "src/planning/curves/continuous_route.h"
#include "src/planning/curves/detours.h"
#include "src/planning/curves/faster_route.h"
#include "src/planning/curves/route_time.h"
#include "trackbed/planning/common/curvature_steps.h"
#include "trackbed/planning/common/route.h"
#include "trackbed/planning/curves/drivable_curve.h"
#include "trackbed/planning/curves/dubins.h"
#include "trackbed/planning/curves/reeds_shepp.h"

// The planners `dubins` and `reeds_shepp`: shortest curves from stop to stop.
// 1. All Dubins or Reeds-Shepp words to the next stop are made drivable: arcs get room for the
//    ramps of the steering (drivable_curve.h).
// 2. The candidates are sorted by length plus a penalty for each stop; the first that keeps clear
//    of obstacles is taken.
// 3. A rolling car may begin its first curve at once, after straightening its wheels, or after
//    slowing down on a straight; the cheapest of the three is taken.
// 4. With curvature `auto`, the path has continuous curvature (continuous_route.h), unless the car
//    cannot drive it. With the objective `time`, the path of steps 1 to 3 is taken if it is faster
//    than the path of continuous curvature through the same stops, too.
// Source: Dubins 1957; Reeds and Shepp 1990.
namespace trackbed {
namespace {

using route::CheckPoses;
using route::CheckRadius;
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
  double length = 0.0;  // Length of the curve [m].
  double radius = 0.0;  // Radius of the sharpest arc [m].
  double cost = 0.0;    // Cost of the curve [m].
};

double Length(const std::vector<Segment>& segments) {
  double length = 0.0;
  for (const Segment& segment : segments) {
    length += segment.length;
  }
  return length;
}

/// Returns the radius of the sharpest arc [m]; `radius` if no arc is sharper.
double SmallestRadius(const std::vector<Segment>& segments, double radius) {
  double sharpest = 0.0;
  for (const Segment& segment : segments) {
    sharpest = std::max(sharpest, std::abs(segment.curvature));
  }
  return sharpest > 0.0 && sharpest < 1.0 / radius ? 1.0 / sharpest : radius;
}

/// Returns the cheapest collision-free curve among `words` that `may_begin` accepts, judging by the
/// first segments. The cost of a curve is the length plus kStopPenalty per stop.
template <typename MayBegin>
std::optional<FoundCurve> FirstFree(const PlanRequest& request, const CollisionChecker& clear,
                                    const Pose2& from, const Pose2& to,
                                    const std::vector<ShortestCurve>& words,
                                    const CurveDrive& drive, const MayBegin& may_begin) {
  // Cost of a stop [m], equal to the penalty of hybrid A* for a change of direction.
  constexpr double kStopPenalty = 5.0;
  std::vector<FoundCurve> candidates;
  for (std::size_t i = 0; i < words.size(); ++i) {
    std::vector<Segment> own = DrivablePieces(request.vehicle, from, to, words[i], drive);
    if (may_begin(own)) {
      const auto stops =
          static_cast<double>(PlanSteps(request.vehicle, own, drive.min_speed).stops.size());
      const double length = Length(own);
      const double sharpest = SmallestRadius(own, drive.radius);
      candidates.push_back({std::move(own), words[i], static_cast<std::ptrdiff_t>(i), length,
                            sharpest, length + kStopPenalty * stops});
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const FoundCurve& a, const FoundCurve& b) { return a.cost < b.cost; });
  const auto free =
      std::find_if(candidates.begin(), candidates.end(),
                   [&](const FoundCurve& curve) { return IsFree(clear, from, curve.segments); });
  return free == candidates.end() ? std::nullopt : std::optional(std::move(*free));
}

/// Returns the cheapest first curve of a rolling car. The curve begins at the car if the wheels
/// have the curve's steering angle. If the wheels have another steering angle, the curve begins
/// where the wheels are straight, or after a straight line on which the car slows down.
template <typename Words>
std::optional<FoundCurve> FirstRolling(const PlanRequest& request, const CollisionChecker& clear,
                                       const Pose2& to, const Words& words, CurveDrive drive) {
  drive.speed = std::max(drive.speed, request.start_speed);
  drive.start_speed = request.start_speed;
  drive.deceleration = request.speed.deceleration;
  std::optional<FoundCurve> found;
  const auto take_from = [&](const LeadIn& lead, double slowed, const auto& may_begin) {
    if (!IsFree(clear, request.start, lead.segments)) {
      return;
    }
    std::optional<FoundCurve> own = FirstFree(request, clear, lead.end, to,
                                              words(lead.end, to, drive.radius), drive, may_begin);
    // The length on which the car slows down counts twice: the car needs up to twice the time.
    if (own && (!found || lead.length + slowed + own->cost < found->cost)) {
      own->cost += lead.length + slowed;
      std::vector<Segment> segments = lead.segments;
      AppendPieces(segments, own->segments);
      own->segments = std::move(segments);
      found = std::move(own);
    }
  };
  const auto from = [&](double curvature) {
    return [&, curvature](const std::vector<Segment>& own) {
      return CanStartRolling(request, curvature, own, drive.min_speed);
    };
  };
  take_from({.segments = {}, .end = request.start}, 0.0,
            from(CurvatureForSteering(request.vehicle, request.start_steering)));
  take_from(ComputeLeadIn(request, request.start_speed, 0.0), 0.0, from(0.0));
  drive.start_speed = 0.0;
  const LeadIn slowing = LeadInForCurves(request, drive.radius, drive.min_speed);
  take_from(slowing, slowing.length, [](const std::vector<Segment>& own) {
    return own.empty() || own.front().direction > 0;
  });
  return found;
}

/// Plans a path whose leg between two successive stops is the cheapest collision-free curve among
/// `words`.
template <typename Options, typename Words>
Plan PlanCurves(const Options& options, const PlanRequest& request, const Words& words) {
  for (Plan refused : {CheckPoses(request), CheckRadius(request.vehicle, options.radius)}) {
    if (!refused.ok()) {
      return refused;
    }
  }
  CurveDrive drive{.speed = std::max(request.speed.speed, options.min_speed),
                   .min_speed = options.min_speed,
                   .radius = RadiusFor(request.vehicle, options.radius),
                   .road = request.friction};
  const CollisionChecker clear = route::CheckerFromStart(request, options.safe_distance);
  const std::vector<Pose2> stops = PlannedStops(request);
  if (Plan refused = CheckStops(stops, request, options.safe_distance); !refused.ok()) {
    return refused;
  }
  Plan plan;
  CurveDiagnostics found_curves;
  std::vector<Segment> segments;
  const auto any = [](const std::vector<Segment>&) { return true; };
  for (std::size_t i = 1; i < stops.size(); ++i) {
    const bool rolls = i == 1 && request.start_speed > 0.0;
    const std::vector<ShortestCurve> all = words(stops[i - 1], stops[i], drive.radius);
    drive.before = LastBend(segments);
    drive.after = {};
    if (i + 1 < stops.size()) {
      const auto next = words(stops[i], stops[i + 1], drive.radius);
      drive.after = FirstBend(request.vehicle, next.front(), drive);
    }
    const std::optional<FoundCurve> found =
        rolls ? FirstRolling(request, clear, stops[1], words, drive)
              : FirstFree(request, clear, stops[i - 1], stops[i], all, drive, any);
    if (!found) {
      return Refused(PlanStatus::kNoPath,
                     fmt::format("all {} curves to waypoint {} collide with obstacles{}",
                                 all.size(), i, rolls ? " or start with a steering step" : ""));
    }
    AppendPieces(segments, found->segments);
    found_curves.curves.push_back({.word = CurveWord(found->curve),
                                   .length = found->length,
                                   .radius = found->radius,
                                   .shorter_ones_blocked = found->shorter_ones_blocked});
  }
  plan.diagnostics.planner = std::move(found_curves);
  return route::AlongSegments(std::move(plan), request, std::move(segments), options.min_speed);
}

/// Returns the requirements of the options on a route of continuous curvature.
template <typename Options>
ContinuousRoute RouteFor(const Options& options, const PlanRequest& request, CurveMotion motion) {
  return {.motion = motion,
          .objective = options.objective,
          .max_lateral_acceleration = options.max_lateral_acceleration,
          .max_steering_rate_fraction = options.max_steering_rate_fraction,
          .radius = RadiusFor(request.vehicle, options.radius),
          .safe_distance = options.safe_distance,
          .min_speed = options.min_speed};
}

/// The ends of a route at which the wheels are turned at rest.
struct TurnedEnds {
  bool start = false;
  bool goal = false;
};

/// Plans a path of curves of continuous curvature.
template <typename Options>
Plan PlanContinuous(const Options& options, const PlanRequest& request, CurveMotion motion,
                    TurnedEnds may_turn, LegCosts& known) {
  for (Plan refused : {CheckPoses(request), CheckRadius(request.vehicle, options.radius),
                       CheckStops(PlannedStops(request), request, options.safe_distance)}) {
    if (!refused.ok()) {
      return refused;
    }
  }
  ContinuousRoute route = RouteFor(options, request, motion);
  route.turns_at_start = may_turn.start;
  route.turns_at_goal = may_turn.goal;
  return PlanContinuousRoute(route, request, known);
}

/// Makes a route of continuous curvature faster, after its legs have been chosen.
template <typename Options>
Plan Faster(const Options& options, const PlanRequest& request, CurveMotion motion, Plan plan,
            FasterLegs& legs) {
  if (options.curvature == CurveCurvature::kSteps) {
    return plan;
  }
  return FasterRoute(RouteFor(options, request, motion), request, std::move(plan), legs);
}

/// Plans a path of curves among `words`, or of continuous curvature, as the options demand. At
/// the ends in `may_turn`, the wheels of a path of continuous curvature may be turned.
template <typename Options, typename Words>
Plan PlanWithCurvature(const Options& options, const PlanRequest& request, CurveMotion continuous,
                       const Words& words, LegCosts& known, TurnedEnds may_turn = {}) {
  switch (options.curvature) {
    case CurveCurvature::kSteps:
      return PlanCurves(options, request, words);
    case CurveCurvature::kContinuous:
    case CurveCurvature::kCuspSteps:
      return PlanContinuous(options, request, continuous, may_turn, known);
    case CurveCurvature::kAuto:
      break;
  }
  return DrivableOrSteps(PlanContinuous(options, request, continuous, may_turn, known), request,
                         [&] { return PlanCurves(options, request, words); });
}

/// With curvature `auto` and the objective `time`, returns the fastest of the plan `best`, a path
/// with steps, and a path of continuous curvature through its stops (FastestCurves). Otherwise,
/// returns `best`.
template <typename Options, typename Words>
Plan FastestWithSteps(const Options& options, const PlanRequest& request, CurveMotion motion,
                      const Words& words, const CurveLength& length, TurnedEnds may_turn,
                      LegCosts& known, FasterLegs& legs, Plan best) {
  if (options.objective != CurveObjective::kTime || options.curvature != CurveCurvature::kAuto) {
    return best;
  }
  return FastestCurves(
      std::move(best), request,
      [&] {
        return WithoutDetours(request, length, {[&](const PlanRequest& own) {
                                return PlanCurves(options, own, words);
                              }});
      },
      [&](const PlanRequest& own) {
        return Faster(options, own, motion, PlanContinuous(options, own, motion, may_turn, known),
                      legs);
      });
}

/// Returns the ends of a plan at which the wheels are turned.
TurnedEnds TurnedEndsOf(const Plan& plan) {
  const std::vector<Segment>& segments = plan.reference.path.segments();
  if (segments.empty()) {
    return {};
  }
  const Segment& last = segments.back();
  return {segments.front().curvature != 0.0, last.CurvatureAt(last.length) != 0.0};
}

Plan PlanWith(const DubinsOptions& options, const PlanRequest& request) {
  const auto length = [](const Pose2& from, const Pose2& to, double radius) {
    return Dubins(from, to, radius).length;
  };
  LegCosts known;  // The plans with other headings or waypoints share most legs.
  FasterLegs legs;
  const auto plan = [&](TurnedEnds may_turn) {
    return WithoutDetours(request, length,
                          {.plan =
                               [&](const PlanRequest& own) {
                                 return PlanWithCurvature(options, own, CurveMotion::kForwards,
                                                          DubinsWords, known, may_turn);
                               },
                           .faster =
                               [&](const PlanRequest& own, Plan found) {
                                 return Faster(options, own, CurveMotion::kForwards,
                                               std::move(found), legs);
                               }});
  };
  if (options.objective != CurveObjective::kTime || options.curvature == CurveCurvature::kSteps) {
    return plan({});
  }
  Plan best = plan({.start = true, .goal = true});
  // The planner estimates the times of legs, but FasterRoute makes them faster. Compare the times
  // of the final plans with those of straight wheels at the start, and at both ends.
  const auto compare = [&](TurnedEnds may_turn) {
    Plan other = plan(may_turn);
    if (TotalTime(request, other) <= TotalTime(request, best)) {
      best = std::move(other);
    }
  };
  if (TurnedEndsOf(best).start) {
    compare({.start = false, .goal = true});
  }
  if (TurnedEndsOf(best).goal) {
    compare({});
  }
  return FastestWithSteps(options, request, CurveMotion::kForwards, DubinsWords, length,
                          {.start = true, .goal = true}, known, legs, std::move(best));
}

Plan PlanWith(const ReedsSheppOptions& options, const PlanRequest& request) {
  // For some poses, all Reeds-Shepp words begin in reverse, which a rolling car cannot drive.
  // The candidates for a rolling car include the Dubins words, which begin forwards.
  const auto words = [](const Pose2& from, const Pose2& to, double radius) {
    std::vector<ShortestCurve> all = ReedsSheppWords(from, to, radius);
    const std::vector<ShortestCurve> forwards = DubinsWords(from, to, radius);
    all.insert(all.end(), forwards.begin(), forwards.end());
    std::stable_sort(all.begin(), all.end(), [](const ShortestCurve& a, const ShortestCurve& b) {
      return a.length < b.length;
    });
    return all;
  };
  const CurveMotion motion = options.curvature == CurveCurvature::kContinuous
                                 ? CurveMotion::kContinuous
                                 : CurveMotion::kHybrid;
  LegCosts known;  // The plans with other headings or waypoints share most legs.
  FasterLegs legs;
  Plan plan = WithoutDetours(
      request, ReedsSheppLength,
      {.plan =
           [&](const PlanRequest& own) {
             return PlanWithCurvature(options, own, motion, words, known);
           },
       .faster = [&](const PlanRequest& own,
                     Plan found) { return Faster(options, own, motion, std::move(found), legs); }});
  return FastestWithSteps(options, request, motion, words, ReedsSheppLength, {}, known, legs,
                          std::move(plan));
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

namespace {

/// Visits the keys that `dubins` and `reeds_shepp` share.
template <typename Options>
void VisitKeys(KeyVisitor& keys, Options& options, const EnumNames<CurveCurvature>& curvatures) {
  static const EnumNames<CurveObjective> objectives{{CurveObjective::kLength, "length"},
                                                    {CurveObjective::kTime, "time"}};
  route::VisitCurves(keys, options.radius, options.safe_distance, options.min_speed);
  keys.Field(kCurvatureKey, options.curvature, Need::kOptional, curvatures);
  VisitClothoids(keys, options.max_lateral_acceleration, options.max_steering_rate_fraction);
  keys.Field({"objective", "",
              "what curves with clothoids minimize: the length at the mission's speed, or the "
              "driving time, with slower, sharper turns"},
             options.objective, Need::kOptional, objectives);
}

}  // namespace

void Visit(KeyVisitor& keys, DubinsOptions& options) {
  static const EnumNames<CurveCurvature> names{{CurveCurvature::kAuto, "auto"},
                                               {CurveCurvature::kSteps, "steps"},
                                               {CurveCurvature::kContinuous, "continuous"}};
  VisitKeys(keys, options, names);
}

void Visit(KeyVisitor& keys, ReedsSheppOptions& options) {
  VisitKeys(keys, options, CurvaturesWithCusps());
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
