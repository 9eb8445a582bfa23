// Finds the cheapest leg between two stops, each with a curvature.
//
// For a leg at the speed u, the largest sharpness is sigma = f omega/(L u). The plan may use the
// fraction f of the steering rate omega; L is the wheelbase. Since the steering angle is atan(L
// kappa), its rate is at most L u sigma = f omega. The tyres' grip at the leg's speed limits the
// curvature, too. On straights, the car may drive faster than the leg's speed u.
//
// A car that rolls at the start drives its first turns at its present speed, or straightens its
// wheels first and slows down on a straight.
//
// The cost of the cheapest leg so far bounds the length of all further curves. No forward curve is
// shorter than the Dubins curve of its smallest radius, so most speeds need no search for curves.
#include "src/planning/curves/continuous_legs.h"

#include <algorithm>
#include <cmath>

#include "src/planning/curves/sharp_turns.h"
#include "trackbed/planning/common/driving_time.h"
#include "trackbed/planning/common/route.h"
#include "trackbed/planning/curves/dubins.h"

namespace trackbed {
namespace {

/// Cost of a change of direction [m], equal to that of hybrid A*.
constexpr double kCuspPenalty = 5.0;

/// The candidate speeds of a leg form a geometric sequence. Above the fraction kFineChoices of the
/// mission's speed, each candidate is kSpeedRatio times the previous one. Most turns have their
/// best speed in this range. At lower candidate speeds, the ratio is kCoarseSpeedRatio.
constexpr double kSpeedRatio = 0.8;
constexpr double kFineChoices = 0.2;
constexpr double kCoarseSpeedRatio = 0.6;

ContinuousLeg LegAlong(const ShortestCurve& word, double radius, double speed) {
  ContinuousLeg leg{.segments = ToSegments(word), .word = word, .speed = speed};
  leg.findings.length = word.length;
  leg.findings.radius = radius;
  return leg;
}

/// Returns whether no forward curve of at least the radius `radius` is shorter than `longest` [m].
bool IsTooFar(const Pose2& from, const Pose2& to, double radius, double longest) {
  constexpr double kRounding = 1e-9;
  return std::isfinite(longest) &&
         ((to.position() - from.position()).norm() * (1.0 - kRounding) >= longest ||
          Dubins(from, to, radius).length * (1.0 - kRounding) >= longest);
}

}  // namespace

/// The place where the turns of a leg begin.
struct LegFinder::LegStart {
  CurveState state;
  double speed = 0.0;  // Speed on the turns [m/s].
  LeadIn lead{};       // Straight on which a rolling car slows down to `speed`.
};

/// Keeps the cheapest leg that is free of obstacles.
class LegFinder::Choice {
 public:
  Choice(const CollisionChecker& clear, const Pose2& from, double bound)
      : clear_(clear), from_(from), bound_(bound) {}

  /// Returns the cost above which a leg cannot be the cheapest one.
  [[nodiscard]] double bound() const { return bound_; }
  /// Returns the number of added legs.
  [[nodiscard]] std::size_t tried() const { return tried_; }

  void Add(ContinuousLeg leg) {
    ++tried_;
    if (leg.cost >= best_.cost || leg.cost > bound_) {
      return;
    }
    if (!route::IsFree(clear_, from_, leg.segments)) {
      blocked_.push_back(leg.cost);
      return;
    }
    bound_ = leg.cost;
    best_ = std::move(leg);
  }

  /// Returns the cheapest leg.
  [[nodiscard]] ContinuousLeg Take() {
    if (best_.cost < kNoCurve) {
      best_.findings.word = CurveWord(best_.word);
      best_.findings.shorter_ones_blocked = std::count_if(
          blocked_.begin(), blocked_.end(), [&](double cost) { return cost <= best_.cost; });
      const double sharpest = SharpestCurvature(best_.segments);
      best_.findings.radius = sharpest > 0.0 ? 1.0 / sharpest : best_.findings.radius;
    }
    return std::move(best_);
  }

 private:
  const CollisionChecker& clear_;
  const Pose2& from_;
  double bound_;
  ContinuousLeg best_;
  std::vector<double> blocked_;  // Costs of the legs that obstacles block.
  std::size_t tried_ = 0;
};

LegFinder::LegFinder(const ContinuousRoute& route, const PlanRequest& request)
    : route_(route),
      request_(request),
      clear_(request.vehicle, request.obstacles, route.safe_distance),
      limits_(LimitsOfMotion(route, request)),
      speed_(std::max(request.speed.speed, route.min_speed)) {}

std::vector<double> LegFinder::Speeds() const {
  std::vector<double> speeds{speed_};
  while (speeds.back() > route_.min_speed) {
    const bool fine = speeds.back() * kSpeedRatio >= kFineChoices * speed_;
    speeds.push_back(
        std::max(speeds.back() * (fine ? kSpeedRatio : kCoarseSpeedRatio), route_.min_speed));
  }
  if (kCrawlingSpeed < speeds.back()) {
    speeds.push_back(kCrawlingSpeed);
  }
  return speeds;
}

double LegFinder::MaxCurvature(double speed) const {
  return std::min(1.0 / route_.radius, limits_.lateral / (speed * speed));
}

/// Returns the limits of a leg. A car that starts with sharper steering may keep this steering on
/// its first leg.
CurveLimits LegFinder::LimitsAt(double speed, double start_curvature) const {
  return {.radius = 1.0 / std::max(MaxCurvature(speed), std::abs(start_curvature)),
          .sharpness = limits_.steering_rate / (limits_.wheelbase * speed)};
}

/// Returns the motion along the words from a state to the end of the leg.
CurveMotion LegFinder::MotionFrom(const CurveState& start, const LegEnds& ends) const {
  // The words with cusps from and to curved states are many; a route of four legs would take
  // seconds.
  const bool is_curved = ends.to.curvature != 0.0 || (!IsRolling(ends) && start.curvature != 0.0);
  return is_curved ? CurveMotion::kForwards : route_.motion;
}

/// Returns the words that are shorter than `longest` [m].
std::vector<ShortestCurve> LegFinder::Words(const CurveLimits& limits, const LegEnds& ends,
                                            const CurveState& start, double longest) const {
  const ContinuousCurves curves(limits);
  switch (MotionFrom(start, ends)) {
    case CurveMotion::kForwards:
      return curves.DubinsWords(start, ends.to, longest);
    case CurveMotion::kContinuous:
      return curves.ReedsSheppWords(start, ends.to, longest);
    case CurveMotion::kHybrid: {
      std::vector<ShortestCurve> words = curves.HybridReedsSheppWords(start, ends.to, longest);
      const std::vector<ShortestCurve> continuous = curves.ReedsSheppWords(start, ends.to, longest);
      words.insert(words.end(), continuous.begin(), continuous.end());
      return words;
    }
  }
  return {};
}

double LegFinder::CostOf(const std::vector<Segment>& segments, double speed,
                         const LegEnds& ends) const {
  const bool counts_time = route_.objective == CurveObjective::kTime;
  double cost = 0.0;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    cost += counts_time ? 0.0 : segments[i].length;
    if (i > 0 && segments[i - 1].direction != segments[i].direction) {
      cost +=
          counts_time ? SteeringTime(request_.vehicle, segments[i - 1], segments[i]) : kCuspPenalty;
    }
  }
  if (counts_time) {
    const bool starts = ends.is_first && request_.start_speed == 0.0;
    cost += LegTime(limits_, LegPieces(limits_, segments, speed), starts ? 0.0 : speed,
                    ends.is_last ? 0.0 : speed);
  }
  return cost;
}

/// Returns a lower bound of CostOf that takes less time to compute, with room for rounding errors.
double LegFinder::LeastCost(const std::vector<Segment>& segments, double speed) const {
  return route_.objective == CurveObjective::kTime
             ? (1.0 - 1e-9) * LeastLegTime(limits_, segments, speed)
             : 0.0;
}

/// Returns an upper bound of the length of a curve whose cost CostOf is at most `bound` [m].
double LegFinder::LongestWithin(double bound, double speed, const LegEnds& ends) const {
  // Leave room for rounding errors.
  const double most = bound * (1.0 + 1e-9) + 1e-9;
  if (route_.objective == CurveObjective::kLength) {
    return most;
  }
  const double fastest = std::max(speed_, request_.start_speed);
  if (IsRolling(ends) || !std::isfinite(most)) {
    return most * fastest;
  }
  // In the time, the car speeds up from the speed at the start, and brakes to the speed at the end.
  const double a = limits_.speed.acceleration;
  const double d = limits_.speed.deceleration;
  const double start = ends.is_first ? 0.0 : speed;
  const double end = ends.is_last ? 0.0 : speed;
  const double peak =
      std::clamp((most + start / a + end / d) / (1.0 / a + 1.0 / d), std::max(start, end), fastest);
  const double rest = most - (peak - start) / a - (peak - end) / d;
  return 0.5 * ((peak * peak - start * start) / a + (peak * peak - end * end) / d) +
         std::max(rest, 0.0) * peak;
}

/// Returns where the turns of a leg may begin if the mission drives them at `speed`.
std::vector<LegFinder::LegStart> LegFinder::StartsAt(double speed, const LegEnds& ends) const {
  if (!IsRolling(ends)) {
    return {{ends.from, speed}};
  }
  const double present = std::max(speed, request_.start_speed);
  // A car that starts in a sharp bend drives turns as sharp as this bend only if it must.
  const bool is_sharp = std::abs(ends.from.curvature) > MaxCurvature(present);
  std::vector<LegStart> starts;
  if (speed < request_.start_speed || is_sharp) {
    LeadIn lead = ComputeLeadIn(request_, std::min(speed, request_.start_speed), 0.0);
    if (route::IsFree(clear_, request_.start, lead.segments)) {
      starts.push_back({{lead.end, 0.0}, speed, std::move(lead)});
    }
  }
  if (starts.empty() || !is_sharp) {
    starts.push_back({ends.from, present});
  }
  return starts;
}

/// Returns the cost of the lead-in, on which the speed falls evenly.
double LegFinder::LeadCost(const LegStart& start) const {
  const double sum = start.speed + request_.start_speed;
  return route_.objective == CurveObjective::kTime ? 2.0 * start.lead.length / sum
                                                   : start.lead.length;
}

/// Adds the legs whose turns are driven at `speed`.
void LegFinder::AddLegsAt(double speed, const LegEnds& ends, Choice& choice) const {
  for (const LegStart& start : StartsAt(speed, ends)) {
    const double curvature = start.state.curvature;
    const CurveLimits limits = LimitsAt(start.speed, ends.is_first ? curvature : 0.0);
    const double most = (1.0 + 1e-9) / limits.radius;
    if (std::abs(curvature) > most || std::abs(ends.to.curvature) > most) {
      continue;
    }
    const double lead = LeadCost(start);
    if (lead > choice.bound()) {
      continue;
    }
    const double longest = LongestWithin(choice.bound() - lead, start.speed, ends);
    if (MotionFrom(start.state, ends) == CurveMotion::kForwards &&
        IsTooFar(start.state.pose, ends.to.pose, limits.radius, longest)) {
      continue;
    }
    for (const ShortestCurve& word : Words(limits, ends, start.state, longest)) {
      const std::vector<Segment> own = ToSegments(word);
      if (IsRolling(ends) && !own.empty() && own.front().direction < 0) {
        continue;
      }
      if (lead + LeastCost(own, start.speed) > choice.bound()) {
        continue;
      }
      ContinuousLeg candidate = LegAlong(word, limits.radius, start.speed);
      candidate.segments.insert(candidate.segments.begin(), start.lead.segments.begin(),
                                start.lead.segments.end());
      candidate.findings.length += start.lead.length;
      candidate.lead = start.lead.segments.size();
      candidate.cost = lead + CostOf(own, start.speed, ends);
      choice.Add(std::move(candidate));
    }
  }
}

/// Adds the legs of two forward turns that are driven at different speeds. For example, the first
/// turn after a start at rest may be sharper than the rest of the leg.
void LegFinder::AddLegsOfTwoSpeeds(const std::vector<double>& speeds, const LegEnds& ends,
                                   Choice& choice) const {
  const double bend = std::max(std::abs(ends.from.curvature), std::abs(ends.to.curvature));
  for (const double first : speeds) {
    for (const double last : speeds) {
      const CurveLimits limits = LimitsAt(std::max(first, last), 0.0);
      if (first == last || bend * limits.radius > 1.0) {
        continue;
      }
      const double slow = std::min(first, last);
      const double longest = LongestWithin(choice.bound(), slow, ends);
      if (IsTooFar(ends.from.pose, ends.to.pose, limits.radius, longest)) {
        continue;
      }
      const ShortestCurve word =
          TwoTurns(limits.radius, LimitsAt(first, 0.0).sharpness, LimitsAt(last, 0.0).sharpness,
                   ends.from, ends.to, longest);
      if (word.length == kNoCurve) {
        continue;
      }
      ContinuousLeg leg = LegAlong(word, limits.radius, slow);
      if (LeastCost(leg.segments, leg.speed) <= choice.bound()) {
        leg.cost = CostOf(leg.segments, leg.speed, ends);
        choice.Add(std::move(leg));
      }
    }
  }
}

ContinuousLeg LegFinder::Cheapest(const LegEnds& ends, const std::vector<double>& speeds,
                                  double bound) {
  ContinuousLeg best;
  const auto take = [&](Choice choice) {
    tried_ = std::max(tried_, choice.tried());
    ContinuousLeg leg = choice.Take();
    if (leg.cost < best.cost) {
      bound = leg.cost;
      best = std::move(leg);
    }
  };
  for (const double speed : speeds) {
    Choice choice(clear_, ends.from.pose, bound);
    AddLegsAt(speed, ends, choice);
    take(std::move(choice));
  }
  if (speeds.size() > 1 && !IsRolling(ends)) {
    Choice choice(clear_, ends.from.pose, bound);
    AddLegsOfTwoSpeeds(speeds, ends, choice);
    take(std::move(choice));
  }
  return best;
}

}  // namespace trackbed
