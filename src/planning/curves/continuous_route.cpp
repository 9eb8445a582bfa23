// Plans routes of continuous curvature, by dynamic programming over the curvature at the stops.
//
// 1. For each stop and each choice of its curvature, ArrivalsAfter() finds the cheapest route from
//    the start. LegFinder finds the cheapest leg between two stops with given curvatures.
// 2. The cost of the cheapest route so far bounds the cost of each further leg. LegCosts keeps the
//    costs, because a planner plans most legs several times with other headings or waypoints.
// 3. BestLegs() makes the legs of the cheapest route only.
// 4. The objective `length` uses the mission's speed, and lower speeds only where obstacles block
//    all curves at a higher speed. The objective `time` compares several speeds for each leg. By
//    the speed profile of the whole path, the planner compares the best combination of speeds with
//    the mission's speed on all legs.
#include "src/planning/curves/continuous_route.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "src/planning/curves/continuous_legs.h"
#include "src/planning/curves/leg_speeds.h"
#include "src/planning/curves/route_time.h"
#include "trackbed/planning/common/driving_time.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/route.h"

namespace trackbed {
namespace {

/// Share of the tyres' grip on turns; the rest is left for braking and for corrections.
constexpr double kGripShare = 0.5;

/// The cheapest way to a stop with one of the curvatures at this stop.
struct Arrival {
  double cost = kNoCurve;  // Cost of the route from the start to the stop.
  std::size_t before = 0;  // Index of the curvature at the previous stop.
};

bool IsStraight(const Segment& segment) {
  return segment.curvature == 0.0 && segment.sharpness == 0.0 && segment.sharpness_rate == 0.0;
}

class RoutePlanner {
 public:
  RoutePlanner(const ContinuousRoute& route, const PlanRequest& request, LegCosts& known)
      : route_(route),
        request_(request),
        known_(known),
        finder_(route, request),
        stops_(PlannedStops(request)),
        speed_(std::max(request.speed.speed, route.min_speed)) {}

  [[nodiscard]] Plan Make() {
    std::vector<ContinuousLeg> best;
    if (route_.objective == CurveObjective::kTime) {
      best = BestLegs(finder_.Speeds());
      std::vector<ContinuousLeg> constant = BestLegs({speed_});
      const auto time = [this](const std::vector<ContinuousLeg>& legs) {
        return TotalTime(request_, PlanOf(legs));
      };
      if (!constant.empty() && (best.empty() || time(constant) <= time(best))) {
        best = std::move(constant);
      }
    }
    for (const double speed : finder_.Speeds()) {
      if (!best.empty()) {
        break;
      }
      best = BestLegs({speed});
    }
    return best.empty() ? Blocked() : PlanOf(best);
  }

 private:
  /// The choices of curvatures at a stop [1/m].
  [[nodiscard]] std::vector<double> CurvaturesAt(std::size_t stop) const {
    const bool is_end = stop == 0 || stop + 1 == stops_.size();
    if (stop == 0 && request_.start_speed > 0.0) {
      return {CurvatureForSteering(request_.vehicle, request_.start_steering)};
    }
    const double most = finder_.MaxCurvature(route_.min_speed);
    if (is_end) {
      const bool turns = stop == 0 ? route_.turns_at_start : route_.turns_at_goal;
      return turns ? std::vector<double>{0.0, most, -most} : std::vector{0.0};
    }
    std::vector<double> choices{0.0, 0.5 * most, -0.5 * most, most, -most};
    // Half of the car's largest curvature may be too much at the mission's speed.
    if (const double fast = finder_.MaxCurvature(speed_); fast < 0.5 * most) {
      choices.insert(choices.end(), {fast, -fast});
    }
    return choices;
  }

  [[nodiscard]] LegEnds EndsOf(std::size_t leg, double from, double to) const {
    return {{stops_[leg], from}, {stops_[leg + 1], to}, leg == 0, leg + 2 == stops_.size()};
  }

  /// Returns the known costs of a leg for all pairs of curvatures at its ends.
  [[nodiscard]] std::vector<LegCost>& KnownCosts(std::size_t leg, const std::vector<double>& from,
                                                 const std::vector<double>& to,
                                                 const std::vector<double>& speeds) {
    const Pose2& a = stops_[leg];
    const Pose2& b = stops_[leg + 1];
    const LegEnds ends = EndsOf(leg, 0.0, 0.0);
    return known_.Of(
        {a.x, a.y, a.yaw, b.x, b.y, b.yaw, ends.is_first ? request_.start_speed : -1.0,
         ends.is_last ? 1.0 : 0.0, static_cast<double>(from.size()), static_cast<double>(to.size()),
         speeds.front(), static_cast<double>(speeds.size())},
        from.size() * to.size());
  }

  /// Returns the cheapest legs at the given choices of speeds, or no legs if a leg is blocked.
  [[nodiscard]] std::vector<ContinuousLeg> BestLegs(const std::vector<double>& speeds) {
    // The ways to each stop, by the curvature at the stop.
    std::vector<std::vector<Arrival>> arrivals(1);
    for (const double curvature : CurvaturesAt(0)) {
      arrivals[0].push_back(
          {.cost = route_.turns_at_start ? TimeBeforeStart(request_, curvature) : 0.0});
    }
    for (std::size_t leg = 0; leg + 1 < stops_.size(); ++leg) {
      arrivals.push_back(ArrivalsAfter(leg, arrivals.back(), speeds));
    }
    const auto cheapest =
        std::min_element(arrivals.back().begin(), arrivals.back().end(),
                         [](const Arrival& a, const Arrival& b) { return a.cost < b.cost; });
    if (cheapest->cost == kNoCurve) {
      return {};
    }
    std::vector<ContinuousLeg> legs(arrivals.size() - 1);
    auto to = static_cast<std::size_t>(cheapest - arrivals.back().begin());
    for (std::size_t i = legs.size(); i-- > 0;) {
      const Arrival& arrival = arrivals[i + 1][to];
      const std::size_t from = arrival.before;
      const double cost = arrival.cost - arrivals[i][from].cost;
      legs[i] = finder_.Cheapest(EndsOf(i, CurvaturesAt(i)[from], CurvaturesAt(i + 1)[to]), speeds,
                                 cost + Slack(arrival.cost));
      to = from;
    }
    return legs;
  }

  /// Returns the room for rounding errors in sums of costs.
  [[nodiscard]] static double Slack(double cost) { return 1e-9 * cost; }

  /// Returns the cheapest ways to the stop after a leg.
  [[nodiscard]] std::vector<Arrival> ArrivalsAfter(std::size_t leg,
                                                   const std::vector<Arrival>& arrivals,
                                                   const std::vector<double>& speeds) {
    const std::vector<double> from = CurvaturesAt(leg);
    const std::vector<double> to = CurvaturesAt(leg + 1);
    std::vector<LegCost>& known = KnownCosts(leg, from, to, speeds);
    std::vector<std::size_t> order(from.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return arrivals[a].cost < arrivals[b].cost;
    });
    std::vector<Arrival> next(to.size());
    for (std::size_t j = 0; j < to.size(); ++j) {
      Arrival& best = next[j];
      for (const std::size_t i : order) {
        const double before = arrivals[i].cost;
        if (before == kNoCurve || before >= best.cost) {
          break;
        }
        LegCost& own = known[i * to.size() + j];
        const double bound = best.cost - before + (best.cost < kNoCurve ? Slack(best.cost) : 0.0);
        if (own.cost == kNoCurve && own.least < bound) {
          own.cost = finder_.Cheapest(EndsOf(leg, from[i], to[j]), speeds, bound).cost;
          own.least = bound;
        }
        const double total = before + own.cost;
        if (total < best.cost || (total == best.cost && total < kNoCurve && i < best.before)) {
          best = {.cost = total, .before = i};
        }
      }
    }
    if (arrivals[order.front()].cost < kNoCurve) {
      reached_ = std::max(reached_, leg + 1);
    }
    return next;
  }

  [[nodiscard]] Plan PlanOf(const std::vector<ContinuousLeg>& found) const {
    Plan plan;
    CurveDiagnostics diagnostics;
    std::vector<Segment> segments;
    double station = 0.0;
    for (const ContinuousLeg& leg : found) {
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
        fmt::format(
            "all {} curves to waypoint {} collide with obstacles{}", finder_.tried(), reached_,
            reached_ == 1 && request_.start_speed > 0.0 && route_.motion != CurveMotion::kForwards
                ? " or start backwards"
                : ""));
  }

  const ContinuousRoute& route_;
  const PlanRequest& request_;
  LegCosts& known_;
  LegFinder finder_;
  std::vector<Pose2> stops_;
  double speed_;
  std::size_t reached_ = 1;
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

Plan PlanContinuousRoute(const ContinuousRoute& route, const PlanRequest& request,
                         LegCosts& known) {
  return RoutePlanner(route, request, known).Make();
}

}  // namespace trackbed
