// Plans routes of continuous curvature, by dynamic programming over the curvature at the stops.
//
// For a leg at the speed u, the largest sharpness is sigma = f omega/(L u), where f is the fraction
// of the steering rate omega that the plan may use, and L the wheelbase. Since the steering angle
// is atan(L kappa), its rate is at most L u sigma = f omega. The curvature is also limited by the
// tyres' grip at u. On straights, the car may drive faster than u.
//
// The objective `length` takes the mission's speed, and lower speeds only where all words at a
// higher speed are blocked. The objective `time` compares several speeds for each leg by an
// estimate of the driving time, then compares the best combination with the one at the mission's
// speed by the speed profile of the whole path.
#include "src/planning/curves/continuous_route.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "trackbed/planning/common/collision_checker.h"
#include "trackbed/planning/common/route.h"
#include "trackbed/planning/curves/drivable_curve.h"

namespace trackbed {
namespace {

/// Cost of a change of direction [m], equal to that of hybrid A*.
constexpr double kCuspPenalty = 5.0;

/// Share of the tyres' grip on turns; the rest is left for braking and for corrections.
constexpr double kGripShare = 0.5;

/// Lowest speed of a leg as a fraction of the mission's speed, and the ratio of neighboring
/// choices.
constexpr double kSlowest = 0.2;
constexpr double kSpeedRatio = 0.8;

/// A leg between two stops.
struct Leg {
  std::vector<Segment> segments;
  CurveFindings findings;
  double speed = 0.0;  // on its turns [m/s]
  double cost = kNoCurve;
};

/// The legs of a route with their total cost.
struct Legs {
  std::vector<Leg> legs;
  double cost = kNoCurve;
};

/// Returns the radius at the sharpest point [m]; `radius` if no point is sharper.
double SharpestRadius(const std::vector<Segment>& segments, double radius) {
  double sharpest = 0.0;
  for (const Segment& segment : segments) {
    sharpest = std::max(
        {sharpest, std::abs(segment.curvature), std::abs(segment.CurvatureAt(segment.length))});
  }
  return sharpest > 0.0 ? 1.0 / sharpest : radius;
}

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
    Legs best;
    if (route_.objective == CurveObjective::kTime) {
      best = BestLegs(SlowerSpeeds());
      Legs constant = BestLegs({speed_});
      if (!constant.legs.empty() && (best.legs.empty() || Time(constant) <= Time(best))) {
        best = std::move(constant);
      }
    } else {
      for (const double speed : SlowerSpeeds()) {
        best = BestLegs({speed});
        if (!best.legs.empty()) {
          break;
        }
      }
    }
    return best.legs.empty() ? Blocked() : PlanOf(best);
  }

 private:
  [[nodiscard]] bool IsRolling(std::size_t leg) const {
    return leg == 0 && request_.start_speed > 0.0;
  }

  /// The choices of speeds for a leg, fastest first.
  [[nodiscard]] std::vector<double> SlowerSpeeds() const {
    std::vector<double> speeds{speed_};
    const double slowest = std::max(route_.min_speed, kSlowest * speed_);
    while (speeds.back() * kSpeedRatio >= slowest) {
      speeds.push_back(speeds.back() * kSpeedRatio);
    }
    return speeds;
  }

  /// The largest curvature at `speed` [1/m].
  [[nodiscard]] double MaxCurvature(double speed) const {
    const double most = LateralAccelerationOnClothoids(request_.vehicle, request_.friction,
                                                       route_.max_lateral_acceleration);
    return std::min(1.0 / route_.radius, most / (speed * speed));
  }

  /// The limits of a leg; a car that starts with sharper steering may keep it on its first leg.
  [[nodiscard]] CurveLimits LimitsAt(double speed, double start_curvature) const {
    const VehicleParams& car = request_.vehicle;
    return {.radius = 1.0 / std::max(MaxCurvature(speed), std::abs(start_curvature)),
            .sharpness =
                route_.max_steering_rate_fraction * car.steering_rate / (car.wheelbase * speed)};
  }

  /// The choices of curvatures at a stop [1/m].
  [[nodiscard]] std::vector<double> CurvaturesAt(std::size_t stop) const {
    if (stop == 0) {
      return {request_.start_speed > 0.0
                  ? CurvatureForSteering(request_.vehicle, request_.start_steering)
                  : 0.0};
    }
    if (stop + 1 == stops_.size()) {
      return {0.0};
    }
    const double most = MaxCurvature(speed_);
    return {0.0, 0.5 * most, -0.5 * most, most, -most};
  }

  [[nodiscard]] std::vector<ShortestCurve> Words(const CurveLimits& limits, std::size_t leg,
                                                 double from, double to) const {
    const ContinuousCurves curves(limits);
    const CurveState start{stops_[leg], from};
    const CurveState goal{stops_[leg + 1], to};
    // The words with cusps from and to curved states are many; a route of four legs would take
    // seconds.
    const bool is_curved = to != 0.0 || (leg > 0 && from != 0.0);
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

  /// Time on a straight between turns at `speed`, on which the car may drive faster [s].
  [[nodiscard]] double StraightTime(double length, double speed) const {
    const SpeedLimits& limits = request_.speed;
    const double per_speed = 1.0 / limits.acceleration + 1.0 / limits.deceleration;
    const double peak = std::min(speed_, std::sqrt(speed * speed + 2.0 * length / per_speed));
    const double used = 0.5 * (peak * peak - speed * speed) * per_speed;
    return (peak - speed) * per_speed + std::max(length - used, 0.0) / peak;
  }

  /// Time that the car loses by stopping and by turning its wheels at rest [s].
  [[nodiscard]] double CuspTime(const Segment& before, const Segment& after, double speed) const {
    const SpeedLimits& limits = request_.speed;
    const VehicleParams& car = request_.vehicle;
    const double steering = std::abs(SteeringForCurvature(car, after.curvature) -
                                     SteeringForCurvature(car, before.CurvatureAt(before.length)));
    return 0.5 * speed * (1.0 / limits.acceleration + 1.0 / limits.deceleration) +
           steering / car.steering_rate;
  }

  [[nodiscard]] double CostOf(const std::vector<Segment>& segments, double speed,
                              std::size_t leg) const {
    const bool counts_time = route_.objective == CurveObjective::kTime;
    double cost = 0.0;
    for (std::size_t i = 0; i < segments.size(); ++i) {
      const Segment& segment = segments[i];
      cost += !counts_time          ? segment.length
              : IsStraight(segment) ? StraightTime(segment.length, speed)
                                    : segment.length / speed;
      if (i > 0 && segments[i - 1].direction != segment.direction) {
        cost += counts_time ? CuspTime(segments[i - 1], segment, speed) : kCuspPenalty;
      }
    }
    if (counts_time) {
      const bool starts = leg == 0 && request_.start_speed == 0.0;
      const bool ends = leg + 2 == stops_.size();
      cost += 0.5 * speed *
              ((starts ? 1.0 / request_.speed.acceleration : 0.0) +
               (ends ? 1.0 / request_.speed.deceleration : 0.0));
    }
    return cost;
  }

  /// Returns the cheapest free leg at `speed`; its cost is infinite if all words are blocked.
  [[nodiscard]] Leg LegAt(double speed, std::size_t leg, double from, double to) {
    const double driven = IsRolling(leg) ? std::max(speed, request_.start_speed) : speed;
    const CurveLimits limits = LimitsAt(driven, leg == 0 ? from : 0.0);
    const double most = (1.0 + 1e-9) / limits.radius;
    if (std::abs(from) > most || std::abs(to) > most) {
      return {};
    }
    std::vector<Leg> found;
    for (const ShortestCurve& word : Words(limits, leg, from, to)) {
      std::vector<Segment> own = ToSegments(word);
      if (IsRolling(leg) && !own.empty() && own.front().direction < 0) {
        continue;
      }
      const double cost = CostOf(own, driven, leg);
      found.push_back(
          {.segments = std::move(own),
           .findings = {.word = CurveWord(word), .length = word.length, .radius = limits.radius},
           .speed = driven,
           .cost = cost});
    }
    tried_ = std::max(tried_, found.size());
    std::stable_sort(found.begin(), found.end(),
                     [](const Leg& a, const Leg& b) { return a.cost < b.cost; });
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (route::IsFree(clear_, stops_[leg], found[i].segments)) {
        found[i].findings.shorter_ones_blocked = static_cast<std::ptrdiff_t>(i);
        found[i].findings.radius = SharpestRadius(found[i].segments, limits.radius);
        return std::move(found[i]);
      }
    }
    blocked_ = std::max(blocked_, leg + 1);
    return {};
  }

  /// Returns the cheapest legs at the given choices of speeds; none if a leg is blocked.
  [[nodiscard]] Legs BestLegs(const std::vector<double>& speeds) {
    std::vector<Legs> best(1, {.legs = {}, .cost = 0.0});
    for (std::size_t leg = 0; leg + 1 < stops_.size(); ++leg) {
      const std::vector<double> from = CurvaturesAt(leg);
      const std::vector<double> to = CurvaturesAt(leg + 1);
      std::vector<Legs> next(to.size());
      for (std::size_t j = 0; j < to.size(); ++j) {
        for (std::size_t i = 0; i < from.size(); ++i) {
          for (const double speed : speeds) {
            if (best[i].cost >= next[j].cost) {
              continue;
            }
            Leg own = LegAt(speed, leg, from[i], to[j]);
            if (best[i].cost + own.cost < next[j].cost) {
              next[j] = {best[i].legs, best[i].cost + own.cost};
              next[j].legs.push_back(std::move(own));
            }
          }
        }
      }
      best = std::move(next);
    }
    return best.front().cost < kNoCurve ? best.front() : Legs{};
  }

  [[nodiscard]] Plan PlanOf(const Legs& found) const {
    Plan plan;
    CurveDiagnostics diagnostics;
    std::vector<Segment> segments;
    double station = 0.0;
    for (const Leg& leg : found.legs) {
      diagnostics.curves.push_back(leg.findings);
      for (const Segment& segment : leg.segments) {
        if (leg.speed < speed_ && !IsStraight(segment)) {
          plan.caps.push_back({station, station + segment.length, leg.speed});
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

  /// Returns the driving time of the legs, with the time in which the wheels turn at rest [s].
  [[nodiscard]] double Time(const Legs& found) const {
    const Plan plan = PlanOf(found);
    const std::vector<Segment>& segments = plan.reference.path.segments();
    double time = plan.reference.speed.TimeAt(plan.reference.path.length());
    for (std::size_t i = 1; i < segments.size(); ++i) {
      if (segments[i].direction != segments[i - 1].direction) {
        time += CuspTime(segments[i - 1], segments[i], 0.0);
      }
    }
    return time;
  }

  [[nodiscard]] Plan Blocked() const {
    return route::Refused(
        PlanStatus::kNoPath,
        fmt::format("all {} curves to waypoint {} collide with obstacles{}", tried_, blocked_,
                    IsRolling(blocked_ - 1) && route_.motion != CurveMotion::kForwards
                        ? " or start backwards; a car at rest (mission.start.speed: 0) has more "
                          "curves"
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

double LateralAccelerationOnClothoids(const VehicleParams& vehicle, double friction, double most) {
  const double grip = kGripShare * MaxLateralAcceleration(vehicle, friction);
  return grip > 0.0 ? std::min(grip, most) : most;
}

const EnumNames<CurveCurvature>& CurvaturesWithCusps() {
  static const EnumNames<CurveCurvature> names{{CurveCurvature::kSteps, "steps"},
                                               {CurveCurvature::kContinuous, "continuous"},
                                               {CurveCurvature::kCuspSteps, "cusp_steps"}};
  return names;
}

void VisitClothoids(KeyVisitor& keys, double& max_lateral_acceleration,
                    double& max_steering_rate_fraction) {
  keys.Field({"max_lateral_acceleration", "m/s^2", "maximum lateral acceleration with clothoids"},
             max_lateral_acceleration, Need::kOptional, kPositive);
  keys.Field({"max_steering_rate_fraction", "",
              "maximum fraction of the car's steering rate that clothoids may use"},
             max_steering_rate_fraction, Need::kOptional, Range{.max = 1.0, .above = 0.0});
}

Plan PlanContinuousRoute(const ContinuousRoute& route, const PlanRequest& request) {
  return RoutePlanner(route, request).Make();
}

}  // namespace trackbed
