// Plans routes of continuous curvature, by dynamic programming over the curvature at the stops.
//
// For a leg at the speed u, the largest sharpness is sigma = f omega/(L u). The plan may use the
// fraction f of the steering rate omega; L is the wheelbase. Since the steering angle is atan(L
// kappa), its rate is at most L u sigma = f omega. The tyres' grip at the leg's speed limits the
// curvature, too. On straights, the car may drive faster than the leg's speed u.
//
// The objective `length` uses the mission's speed, and lower speeds only where obstacles block all
// curves at a higher speed. The objective `time` compares several speeds for each leg, and pairs of
// speeds for its first and last turn, by an estimate of the driving time. By the speed profile of
// the whole path, the planner compares the best combination of speeds with the mission's speed on
// all legs.
//
// A car that rolls at the start drives its first turns at its present speed, or straightens its
// wheels first and slows down on a straight.
#include "src/planning/curves/continuous_route.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "src/planning/curves/continuous_or_steps.h"
#include "src/planning/curves/leg_speeds.h"
#include "src/planning/curves/route_time.h"
#include "src/planning/curves/sharp_turns.h"
#include "trackbed/planning/common/collision_checker.h"
#include "trackbed/planning/common/driving_time.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/lead_in.h"
#include "trackbed/planning/common/route.h"
#include "trackbed/planning/curves/drivable_curve.h"

namespace trackbed {
namespace {

/// Cost of a change of direction [m], equal to that of hybrid A*.
constexpr double kCuspPenalty = 5.0;

/// Share of the tyres' grip on turns; the rest is left for braking and for corrections.
constexpr double kGripShare = 0.5;

/// The candidate speeds of a leg form a geometric sequence. Above the fraction kFineChoices of the
/// mission's speed, each candidate is kSpeedRatio times the previous one. Most turns have their
/// best speed in this range. At lower candidate speeds, the ratio is kCoarseSpeedRatio.
constexpr double kSpeedRatio = 0.8;
constexpr double kFineChoices = 0.2;
constexpr double kCoarseSpeedRatio = 0.6;

/// A leg between two stops.
struct Leg {
  std::vector<Segment> segments;
  ShortestCurve word;
  CurveFindings findings;
  double speed = 0.0;    // Speed on the turns [m/s].
  std::size_t lead = 0;  // Number of segments before the turns, on which a rolling car slows down.
  double cost = kNoCurve;
};

/// The place where the turns of a leg begin.
struct LegStart {
  CurveState state;
  double speed = 0.0;  // Speed on the turns [m/s].
  LeadIn lead{};       // Straight on which a rolling car slows down to `speed`.
};

/// The cheapest way to a stop with one of the curvatures at this stop.
struct Arrival {
  double cost = kNoCurve;  // Cost of the route from the start to the stop.
  std::size_t before = 0;  // Index of the curvature at the previous stop.
  Leg leg;                 // Leg from the previous stop.
};

bool IsStraight(const Segment& segment) {
  return segment.curvature == 0.0 && segment.sharpness == 0.0 && segment.sharpness_rate == 0.0;
}

class RoutePlanner {
 public:
  RoutePlanner(const ContinuousRoute& route, const PlanRequest& request)
      : route_(route),
        request_(request),
        clear_(request.vehicle, request.obstacles, route.safe_distance),
        stops_(PlannedStops(request)),
        speed_(std::max(request.speed.speed, route.min_speed)) {}

  [[nodiscard]] Plan Make() {
    std::vector<Leg> best;
    if (route_.objective == CurveObjective::kTime) {
      best = BestLegs(Speeds());
      std::vector<Leg> constant = BestLegs({speed_});
      const auto time = [this](const std::vector<Leg>& legs) {
        return DrivingTime(PlanOf(legs), request_.vehicle);
      };
      if (!constant.empty() && (best.empty() || time(constant) <= time(best))) {
        best = std::move(constant);
      }
    }
    for (const double speed : Speeds()) {
      if (!best.empty()) {
        break;
      }
      best = BestLegs({speed});
    }
    return best.empty() ? Blocked() : PlanOf(best);
  }

 private:
  [[nodiscard]] bool IsRolling(std::size_t leg) const {
    return leg == 0 && request_.start_speed > 0.0;
  }

  /// The choices of speeds for a leg, from the mission's speed down to the lowest speed.
  [[nodiscard]] std::vector<double> Speeds() const {
    std::vector<double> speeds{speed_};
    while (speeds.back() > route_.min_speed) {
      const bool fine = speeds.back() * kSpeedRatio >= kFineChoices * speed_;
      speeds.push_back(
          std::max(speeds.back() * (fine ? kSpeedRatio : kCoarseSpeedRatio), route_.min_speed));
    }
    return speeds;
  }

  /// The largest curvature at `speed` [1/m].
  [[nodiscard]] double MaxCurvature(double speed) const {
    const double most = LateralAccelerationOnClothoids(request_.vehicle, request_.friction,
                                                       route_.max_lateral_acceleration);
    return std::min(1.0 / route_.radius, most / (speed * speed));
  }

  /// The limits of a leg. A car that starts with sharper steering may keep this steering on its
  /// first leg.
  [[nodiscard]] CurveLimits LimitsAt(double speed, double start_curvature) const {
    const VehicleParams& car = request_.vehicle;
    return {.radius = 1.0 / std::max(MaxCurvature(speed), std::abs(start_curvature)),
            .sharpness =
                route_.max_steering_rate_fraction * car.steering_rate / (car.wheelbase * speed)};
  }

  /// The choices of curvatures at a stop [1/m].
  [[nodiscard]] std::vector<double> CurvaturesAt(std::size_t stop) const {
    const bool is_end = stop == 0 || stop + 1 == stops_.size();
    if (stop == 0 && request_.start_speed > 0.0) {
      return {CurvatureForSteering(request_.vehicle, request_.start_steering)};
    }
    const double most = MaxCurvature(route_.min_speed);
    if (is_end) {
      return route_.turns_at_rest ? std::vector<double>{0.0, most, -most} : std::vector{0.0};
    }
    std::vector<double> choices{0.0, 0.5 * most, -0.5 * most, most, -most};
    // Half of the car's largest curvature may be too much at the mission's speed.
    if (const double fast = MaxCurvature(speed_); fast < 0.5 * most) {
      choices.insert(choices.end(), {fast, -fast});
    }
    return choices;
  }

  [[nodiscard]] std::vector<ShortestCurve> Words(const CurveLimits& limits, std::size_t leg,
                                                 const CurveState& start, double to) const {
    const ContinuousCurves curves(limits);
    const CurveState goal{stops_[leg + 1], to};
    // The words with cusps from and to curved states are many; a route of four legs would take
    // seconds.
    const bool is_curved = to != 0.0 || (!IsRolling(leg) && start.curvature != 0.0);
    switch (is_curved ? CurveMotion::kForwards : route_.motion) {
      case CurveMotion::kForwards:
        return curves.DubinsWords(start, goal);
      case CurveMotion::kContinuous:
        return curves.ReedsSheppWords(start, goal);
      case CurveMotion::kHybrid: {
        std::vector<ShortestCurve> words = curves.HybridReedsSheppWords(start, goal);
        const std::vector<ShortestCurve> continuous = curves.ReedsSheppWords(start, goal);
        words.insert(words.end(), continuous.begin(), continuous.end());
        return words;
      }
    }
    return {};
  }

  [[nodiscard]] double CostOf(const std::vector<Segment>& segments, double speed,
                              std::size_t leg) const {
    const bool counts_time = route_.objective == CurveObjective::kTime;
    double cost = 0.0;
    for (std::size_t i = 0; i < segments.size(); ++i) {
      cost += counts_time ? 0.0 : segments[i].length;
      if (i > 0 && segments[i - 1].direction != segments[i].direction) {
        cost += counts_time ? SteeringTime(request_.vehicle, segments[i - 1], segments[i])
                            : kCuspPenalty;
      }
    }
    if (counts_time) {
      const LegLimits limits = LimitsOfMotion(route_, request_);
      const bool starts = leg == 0 && request_.start_speed == 0.0;
      const bool ends = leg + 2 == stops_.size();
      cost += LegTime(limits, LegPieces(limits, segments, speed), starts ? 0.0 : speed,
                      ends ? 0.0 : speed);
    }
    return cost;
  }

  /// Returns a lower bound of CostOf for a curve of a length [m].
  [[nodiscard]] double LeastCost(double length) const {
    return route_.objective == CurveObjective::kTime
               ? length / std::max(speed_, request_.start_speed)
               : length;
  }

  /// Returns where the turns of a leg may begin if the mission drives them at `speed`.
  [[nodiscard]] std::vector<LegStart> StartsAt(double speed, std::size_t leg, double from) const {
    const CurveState here{stops_[leg], from};
    if (!IsRolling(leg)) {
      return {{here, speed}};
    }
    const double present = std::max(speed, request_.start_speed);
    // A car that starts in a sharp bend drives turns as sharp as this bend only if it must.
    const bool is_sharp = std::abs(from) > MaxCurvature(present);
    std::vector<LegStart> starts;
    if (speed < request_.start_speed || is_sharp) {
      LeadIn lead = ComputeLeadIn(request_, std::min(speed, request_.start_speed), 0.0);
      if (route::IsFree(clear_, request_.start, lead.segments)) {
        starts.push_back({{lead.end, 0.0}, speed, std::move(lead)});
      }
    }
    if (starts.empty() || !is_sharp) {
      starts.push_back({here, present});
    }
    return starts;
  }

  /// Returns the cost of the lead-in, on which the speed falls evenly.
  [[nodiscard]] double LeadCost(const LegStart& start) const {
    const double sum = start.speed + request_.start_speed;
    return route_.objective == CurveObjective::kTime ? 2.0 * start.lead.length / sum
                                                     : start.lead.length;
  }

  /// Returns the cheapest leg at `speed` that is free of obstacles. The cost of the leg is infinite
  /// if all candidate curves are blocked, or cost at least `bound`.
  [[nodiscard]] Leg LegAt(double speed, std::size_t leg, double from, double to, double bound) {
    std::vector<Leg> found;
    for (const LegStart& start : StartsAt(speed, leg, from)) {
      const double curvature = start.state.curvature;
      const CurveLimits limits = LimitsAt(start.speed, leg == 0 ? curvature : 0.0);
      const double most = (1.0 + 1e-9) / limits.radius;
      if (std::abs(curvature) > most || std::abs(to) > most) {
        continue;
      }
      for (const ShortestCurve& word : Words(limits, leg, start.state, to)) {
        if (LeadCost(start) + LeastCost(word.length) >= bound) {
          continue;
        }
        const std::vector<Segment> own = ToSegments(word);
        if (IsRolling(leg) && !own.empty() && own.front().direction < 0) {
          continue;
        }
        Leg candidate = LegAlong(word, limits.radius, start.speed);
        candidate.segments.insert(candidate.segments.begin(), start.lead.segments.begin(),
                                  start.lead.segments.end());
        candidate.findings.length += start.lead.length;
        candidate.lead = start.lead.segments.size();
        candidate.cost = LeadCost(start) + CostOf(own, start.speed, leg);
        found.push_back(std::move(candidate));
      }
    }
    return CheapestFree(std::move(found), leg);
  }

  /// Returns the cheapest free leg of two forward turns that are driven at different speeds. For
  /// example, the first turn after a start at rest may be sharper than the rest of the leg.
  [[nodiscard]] Leg LegOfTwoSpeeds(std::size_t leg, double from, double to, double bound) {
    std::vector<Leg> found;
    const std::vector<double> speeds = Speeds();
    for (const double first : speeds) {
      for (const double last : speeds) {
        const CurveLimits limits = LimitsAt(std::max(first, last), 0.0);
        if (first == last || std::max(std::abs(from), std::abs(to)) * limits.radius > 1.0) {
          continue;
        }
        const ShortestCurve word =
            TwoTurns(limits.radius, LimitsAt(first, 0.0).sharpness, LimitsAt(last, 0.0).sharpness,
                     {stops_[leg], from}, {stops_[leg + 1], to});
        if (word.length < kNoCurve && LeastCost(word.length) < bound) {
          found.push_back(LegAlong(word, limits.radius, std::min(first, last)));
          found.back().cost = CostOf(found.back().segments, found.back().speed, leg);
        }
      }
    }
    return CheapestFree(std::move(found), leg);
  }

  [[nodiscard]] static Leg LegAlong(const ShortestCurve& word, double radius, double speed) {
    Leg leg{.segments = ToSegments(word), .word = word, .speed = speed};
    leg.findings.length = word.length;
    leg.findings.radius = radius;
    return leg;
  }

  /// Returns the cheapest leg that is free of obstacles. The cost of the leg is infinite if all
  /// legs are blocked.
  [[nodiscard]] Leg CheapestFree(std::vector<Leg> found, std::size_t leg) {
    tried_ = std::max(tried_, found.size());
    std::stable_sort(found.begin(), found.end(),
                     [](const Leg& a, const Leg& b) { return a.cost < b.cost; });
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (route::IsFree(clear_, stops_[leg], found[i].segments)) {
        Leg& best = found[i];
        best.findings.word = CurveWord(best.word);
        best.findings.shorter_ones_blocked = static_cast<std::ptrdiff_t>(i);
        const double sharpest = SharpestCurvature(best.segments);
        best.findings.radius = sharpest > 0.0 ? 1.0 / sharpest : best.findings.radius;
        return std::move(best);
      }
    }
    blocked_ = std::max(blocked_, leg + 1);
    return {};
  }

  /// Returns the cheapest legs at the given choices of speeds, or no legs if a leg is blocked.
  [[nodiscard]] std::vector<Leg> BestLegs(const std::vector<double>& speeds) {
    // The ways to each stop, by the curvature at the stop.
    std::vector<std::vector<Arrival>> arrivals(1);
    for (const double curvature : CurvaturesAt(0)) {
      arrivals[0].push_back(
          {.cost = route_.turns_at_rest ? TimeBeforeStart(request_, curvature) : 0.0});
    }
    for (std::size_t leg = 0; leg + 1 < stops_.size(); ++leg) {
      const std::vector<double> from = CurvaturesAt(leg);
      const std::vector<double> to = CurvaturesAt(leg + 1);
      std::vector<Arrival> next(to.size());
      const auto consider = [&](std::size_t i, std::size_t j, const auto& make) {
        const double before = arrivals[leg][i].cost;
        if (before >= next[j].cost) {
          return;
        }
        // The bound leaves room for rounding errors of the sums of costs.
        Leg own = make((next[j].cost - before) + 1e-9 * next[j].cost);
        if (before + own.cost < next[j].cost) {
          next[j] = {.cost = before + own.cost, .before = i, .leg = std::move(own)};
        }
      };
      for (std::size_t j = 0; j < to.size(); ++j) {
        for (std::size_t i = 0; i < from.size(); ++i) {
          for (const double speed : speeds) {
            consider(i, j, [&](double bound) { return LegAt(speed, leg, from[i], to[j], bound); });
          }
          if (speeds.size() > 1 && !IsRolling(leg)) {
            consider(i, j,
                     [&](double bound) { return LegOfTwoSpeeds(leg, from[i], to[j], bound); });
          }
        }
      }
      arrivals.push_back(std::move(next));
    }
    const auto cheapest =
        std::min_element(arrivals.back().begin(), arrivals.back().end(),
                         [](const Arrival& a, const Arrival& b) { return a.cost < b.cost; });
    if (cheapest->cost == kNoCurve) {
      return {};
    }
    std::vector<Leg> legs(arrivals.size() - 1);
    auto index = static_cast<std::size_t>(cheapest - arrivals.back().begin());
    for (std::size_t i = legs.size(); i-- > 0;) {
      legs[i] = std::move(arrivals[i + 1][index].leg);
      index = arrivals[i + 1][index].before;
    }
    return legs;
  }

  [[nodiscard]] Plan PlanOf(const std::vector<Leg>& found) const {
    Plan plan;
    CurveDiagnostics diagnostics;
    std::vector<Segment> segments;
    double station = 0.0;
    for (const Leg& leg : found) {
      diagnostics.curves.push_back(leg.findings);
      for (std::size_t i = 0; i < leg.segments.size(); ++i) {
        const Segment& segment = leg.segments[i];
        if (leg.speed < speed_ && i >= leg.lead && !IsStraight(segment)) {
          double from = station;
          for (const LegPiece& piece :
               LegPieces(LimitsOfMotion(route_, request_), {segment}, leg.speed)) {
            plan.caps.push_back({from, from + piece.length, piece.speed});
            from += piece.length;
          }
        }
        station += segment.length;
        segments.push_back(segment);
      }
    }
    plan.diagnostics.planner = std::move(diagnostics);
    plan.reference.path = Path(request_.start, std::move(segments));
    route::Complete(plan, request_);
    return plan;
  }

  [[nodiscard]] Plan Blocked() const {
    return route::Refused(
        PlanStatus::kNoPath,
        fmt::format("all {} curves to waypoint {} collide with obstacles{}", tried_, blocked_,
                    IsRolling(blocked_ - 1) && route_.motion != CurveMotion::kForwards
                        ? " or start backwards"
                        : ""));
  }

  const ContinuousRoute& route_;
  const PlanRequest& request_;
  CollisionChecker clear_;
  std::vector<Pose2> stops_;
  double speed_;
  std::size_t tried_ = 0;
  std::size_t blocked_ = 1;
};

}  // namespace

LegLimits LimitsOfMotion(const ContinuousRoute& route, const PlanRequest& request) {
  const VehicleParams& car = request.vehicle;
  return {.speed = {.speed = std::max(request.speed.speed, route.min_speed),
                    .acceleration = request.speed.acceleration,
                    .deceleration = request.speed.deceleration},
          .steering_rate = route.max_steering_rate_fraction * car.steering_rate,
          .lateral =
              LateralAccelerationOnClothoids(car, request.friction, route.max_lateral_acceleration),
          .wheelbase = car.wheelbase};
}

double LateralAccelerationOnClothoids(const VehicleParams& vehicle, double friction, double most) {
  const double grip = kGripShare * MaxLateralAcceleration(vehicle, friction);
  return grip > 0.0 ? std::min(grip, most) : most;
}

Plan PlanContinuousRoute(const ContinuousRoute& route, const PlanRequest& request) {
  Plan straight = RoutePlanner(route, request).Make();
  const double time = TotalTime(request, straight);
  // Other motions turn the car in little room by cusps.
  if (route.objective != CurveObjective::kTime || route.motion != CurveMotion::kForwards ||
      time <= kMostTime * LeastForwardTime(request, route.radius)) {
    return straight;
  }
  ContinuousRoute turned = route;
  turned.turns_at_rest = true;
  Plan other = RoutePlanner(turned, request).Make();
  return time > kMostTime * TotalTime(request, other) ? other : straight;
}

}  // namespace trackbed
