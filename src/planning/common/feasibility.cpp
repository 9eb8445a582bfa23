#include "trackbed/planning/common/feasibility.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/planning/common/feasible_speeds.h"
#include "src/planning/common/start_excess.h"
#include "trackbed/core/angle.h"
#include "trackbed/path/acceleration_caps.h"
#include "trackbed/planning/common/path_pieces.h"
#include "trackbed/planning/common/road_hold.h"
#include "trackbed/vehicle/steering_reach.h"

// Checks a plan against the car's limits and, if possible, changes the plan until it is feasible.
// The check covers the start, the path, the steering rate and the accelerations, at samples along
// the path. For each checked quantity, the result holds the largest excess over the limit and the
// remedy against it. If slower driving helps, MakeFeasible adds speed caps and lowers the
// acceleration limits where the road's grip is smaller, up to four times. The speed caps enforce
// the limits of steering rate, top speed and lateral acceleration. If slower driving does not help,
// MakeFeasible refuses the plan. SetSpeedsAtLimit computes new speeds for plans at the limit of the
// g-g-v diagram.

namespace trackbed {
namespace {

constexpr double kMinPlanSpeed = 0.1;  // Minimum speed of a plan; a slower plan is refused [m/s].
constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// Keeps the largest excess over the limit of one quantity.
class WorstExcess {
 public:
  WorstExcess(std::string what, std::string unit, Remedy remedy)
      : excess_{.what = std::move(what), .unit = std::move(unit), .remedy = remedy} {}

  /// Records by how much the value `required` exceeds the limit, if this is the largest excess so
  /// far. A limit of 0 means that the limit is unknown and cannot be exceeded.
  void Take(double required, double limit, double station) {
    if (limit > 0.0 && required > limit * (1.0 + feasible_speeds::kRounding) &&
        required / limit > ratio_) {
      ratio_ = required / limit;
      excess_.required = required;
      excess_.limit = limit;
      excess_.station = station;
    }
  }

  void AddTo(std::vector<Excess>& list) const {
    if (ratio_ > 0.0) {
      list.push_back(excess_);
    }
  }

 private:
  Excess excess_;
  double ratio_ = 0.0;
};

/// Returns whether the plan's speeds were determined by the car's g-g-v diagram.
bool IsAtLimit(const Plan& plan, const PlanRequest& request) {
  return request.limits || plan.diagnostics.speed_profile;
}

void CheckStart(const Plan& plan, const PlanRequest& request, std::vector<Excess>& found) {
  for (Excess& excess : start_excess::At(plan, request)) {
    found.push_back(std::move(excess));
  }
}

constexpr const char* kSlope = "pull of gravity";

void CheckPath(const Plan& plan, const PlanRequest& request, std::vector<Excess>& found) {
  const VehicleParams& vehicle = request.vehicle;
  const VehicleParams car = feasible_speeds::SteeredCar(plan, request);
  WorstExcess steering("steering angle", "rad", Remedy::kNone);
  WorstExcess lateral("lateral acceleration", "m/s^2", Remedy::kLowerSpeed);
  WorstExcess speed("speed", "m/s", Remedy::kLowerSpeed);
  WorstExcess rate("steering rate along the path", "rad/s", Remedy::kLowerSpeed);
  WorstExcess slope(kSlope, "m/s^2", Remedy::kNone);
  WorstExcess combined("combined acceleration", "m/s^2", Remedy::kGentlerBends);
  const Path& path = plan.reference.path;
  const RoadHold road(request);
  const bool is_at_limit = IsAtLimit(plan, request);
  ForEachPiece(path, feasible_speeds::kCheckSpacing, [&](const PathPiece& piece) {
    const double s = piece.stations.from;
    const double v_from = plan.reference.speed.SpeedAt(s);
    const double v_to = plan.reference.speed.SpeedAt(piece.stations.to);
    const double v = std::max(v_from, v_to);
    if (!plan.sampled) {
      rate.Take(SteeringRateOn(car, piece.bends(),
                               feasible_speeds::SpeedOn(path, piece, road, v_from, v_to)),
                vehicle.steering_rate, s);
    }
    steering.Take(
        SteeringForCurvature(vehicle, piece.curvature),
        SteeringReach(vehicle, piece.bends().front().curvature + piece.bends().back().curvature),
        s);
    lateral.Take(v * v * piece.curvature, feasible_speeds::LateralOver(road, path, piece.stations),
                 s);
    speed.Take(v, vehicle.top_speed, s);
    if (is_at_limit) {
      return;
    }
    const RoadHold::Pull pull = road.Slope(path, s);
    slope.Take(pull.pull, pull.hold, s);
    const RoadHold::Combined both = feasible_speeds::CombinedOver(road, path, piece, v_from, v_to);
    combined.Take(both.required, both.limit, s);
  });
  slope.AddTo(found);
  if (!found.empty() && found.back().what == kSlope) {
    found.back().hint = feasible_speeds::FrictionForSlope(found.back(), path, request);
  }
  steering.AddTo(found);
  lateral.AddTo(found);
  combined.AddTo(found);
  rate.AddTo(found);
  speed.AddTo(found);
}

void CheckSteeringRate(const Plan& plan, const PlanRequest& request, std::vector<Excess>& found) {
  WorstExcess rate("steering rate", "rad/s", Remedy::kLowerSpeed);
  const std::vector<Stations> legs = SplitIntoLegs(plan.reference.path, plan.stops);
  const std::vector<SpeedProfile::Knot>& knots = plan.schedule_speed.knots();
  feasible_speeds::ForEachRamp(plan.schedule, [&](double from, double to, double slope) {
    if (feasible_speeds::EndsAtStop(legs, to)) {
      return;
    }
    double fastest = std::max(plan.schedule_speed.SpeedAt(from), plan.schedule_speed.SpeedAt(to));
    auto knot = std::upper_bound(
        knots.begin(), knots.end(), from,
        [](double station, const SpeedProfile::Knot& each) { return station < each.s; });
    for (; knot != knots.end() && knot->s < to; ++knot) {
      fastest = std::max(fastest, knot->speed);
    }
    rate.Take(fastest * slope, request.vehicle.steering_rate, from);
  });
  rate.AddTo(found);
}

void CheckAcceleration(const Plan& plan, const PlanRequest& request, std::vector<Excess>& found) {
  const Path& path = plan.reference.path;
  WorstExcess braking("deceleration", "m/s^2", Remedy::kGentlerBraking);
  WorstExcess driving("acceleration", "m/s^2", Remedy::kGentlerDriving);
  const std::vector<AccelerationCap> grip = feasible_speeds::GripAlong(path, request);
  const std::vector<SpeedProfile::Knot>& knots = plan.reference.speed.knots();
  std::size_t first = 0;
  for (std::size_t i = 1; i < knots.size(); ++i) {
    const SpeedProfile::Knot& a = knots[i - 1];
    const SpeedProfile::Knot& b = knots[i];
    const double change = (b.speed * b.speed - a.speed * a.speed) / (2.0 * (b.s - a.s));
    constexpr double kSameStation = 2e-9;  // [m]
    while (first + 1 < grip.size() && grip[first].to <= a.s + kSameStation) {
      ++first;
    }
    for (std::size_t k = first; k < grip.size() && grip[k].from < b.s - kSameStation; ++k) {
      const double s = std::max(a.s, grip[k].from);
      braking.Take(-change, grip[k].deceleration, s);
      driving.Take(change, grip[k].acceleration, s);
    }
    braking.Take(-change, kMaxBrakingFactor * request.speed.deceleration, a.s);
  }
  braking.AddTo(found);
  driving.AddTo(found);
}

bool Has(const std::vector<Excess>& excesses, Remedy remedy) {
  return std::any_of(excesses.begin(), excesses.end(),
                     [&](const Excess& excess) { return excess.remedy == remedy; });
}

std::string Listed(const std::vector<Excess>& excesses) {
  std::vector<std::string> texts;
  for (const Excess& excess : excesses) {
    texts.push_back(ToString(excess));
  }
  return fmt::format("{}", fmt::join(texts, "; "));
}

/// Adds a note unless the plan already has the same note, because the limits may be applied to a
/// plan twice.
void AddOnce(std::vector<std::string>& notes, std::string note) {
  if (std::find(notes.begin(), notes.end(), note) == notes.end()) {
    notes.push_back(std::move(note));
  }
}

Plan Refuse(const std::vector<Excess>& excesses, const Plan& plan) {
  Plan refused;
  refused.status = PlanStatus::kInfeasible;
  refused.reason = "the path is not feasible: " + Listed(excesses);
  refused.diagnostics = plan.diagnostics;
  return refused;
}

/// Describes the changes made to a plan, for example "speed reduced to 2.1 m/s where needed".
std::string DescribeSpeedChanges(const SpeedLimits& before, const SpeedLimits& after,
                                 double slowest) {
  std::vector<std::string> texts;
  if (slowest < before.speed) {
    texts.push_back(fmt::format("speed reduced to {:.3g} m/s where needed", slowest));
  }
  if (after.deceleration < before.deceleration) {
    texts.push_back(fmt::format("deceleration limited to {:.3g} m/s^2", after.deceleration));
  }
  if (after.acceleration < before.acceleration) {
    texts.push_back(fmt::format("acceleration limited to {:.3g} m/s^2", after.acceleration));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

/// Returns the excess of a car that arrives too fast at a place. `fast` is the first place at which
/// the car exceeds the limit of the g-g-v diagram, although it brakes from the start.
Excess StartExcessAtLimit(const Plan& plan, const PlanRequest& request,
                          const std::vector<SpeedCap>& caps, const LimitExcess& fast,
                          Refusal refusal) {
  const Excess speed{"speed", fast.speed, fast.allowed, "m/s", fast.s, Remedy::kNone};
  if (refusal == Refusal::kBrief) {
    return speed;
  }
  PlanRequest own = request;
  const auto highest = start_excess::HighestStartSpeed(request.start_speed, [&](double start) {
    Plan trial = plan;
    own.start_speed = start;
    return !SetSpeedsAtLimit(trial, own, caps);
  });
  return highest ? start_excess::TooFast(request.start_speed, *highest, ToString(speed), fast.s)
                 : speed;
}

/// Returns the plan with speeds at the limit of the g-g-v diagram. Speeds at the limit of the g-g-v
/// diagram are feasible by construction. The plan can still be infeasible if the car cannot follow
/// the path at any speed, or if the car is too fast at the start.
Plan DriveAtLimit(Plan plan, const PlanRequest& request, Refusal refusal) {
  std::vector<Excess> excesses;
  for (Excess& excess : FindExcesses(plan, request)) {
    if (excess.remedy == Remedy::kNone) {
      excesses.push_back(std::move(excess));
    }
  }
  std::vector<SpeedCap> caps = feasible_speeds::CapsFor(plan, request);
  if (feasible_speeds::MinSpeedOf(caps, request.speed.speed) < kMinPlanSpeed) {
    for (Excess& excess : FindExcesses(plan, request)) {
      excesses.push_back(std::move(excess));
    }
    return Refuse(excesses, plan);
  }
  caps.insert(caps.end(), plan.caps.begin(), plan.caps.end());
  if (const std::optional<LimitExcess> fast =
          feasible_speeds::SteerableSpeedsAtLimit(plan, request, caps)) {
    excesses.push_back(StartExcessAtLimit(plan, request, caps, *fast, refusal));
  }
  const auto& knots = plan.reference.speed.knots();
  const auto stuck =
      std::adjacent_find(knots.begin(), knots.end(), [](const auto& before, const auto& after) {
        return before.speed == 0.0 && after.speed == 0.0;
      });
  if (stuck != knots.end()) {  // the car can neither climb this slope nor stop on it
    excesses.push_back({"speed", kMinPlanSpeed, 0.0, "m/s", stuck->s, Remedy::kNone});
  }
  if (!excesses.empty() && request.infeasible != InfeasiblePolicy::kAllow) {
    return Refuse(excesses, plan);
  }
  if (!excesses.empty()) {
    AddOnce(plan.notes, "infeasible, kept anyway: " + Listed(excesses));
  }
  return plan;
}

/// A plan that was slowed down, and the remaining excesses over limits.
struct SlowerPlan {
  Plan plan;
  SpeedLimits limits;           ///< Smallest limits of the accelerations along the plan.
  double slowest = 0.0;         ///< Smallest speed cap [m/s].
  std::vector<Excess> reasons;  ///< Excesses for which the plan was slowed down.
  std::vector<Excess> left;     ///< Excesses that slowing down does not repair.

  [[nodiscard]] bool ok() const { return left.empty(); }
};

/// Slows down a plan that exceeds limits; `first` contains the excesses of the plan.
SlowerPlan SlowDown(const Plan& plan, const PlanRequest& request,
                    const std::vector<Excess>& first) {
  const std::vector<SpeedCap> caps = feasible_speeds::CapsFor(plan, request);
  SlowerPlan slower{.plan = plan,
                    .limits = request.speed,
                    .slowest = feasible_speeds::MinSpeedOf(caps, request.speed.speed),
                    .reasons = first,
                    .left = first};
  if (slower.slowest < kMinPlanSpeed) {
    return slower;
  }
  std::vector<SpeedCap>& own = slower.plan.caps;
  own.insert(own.end(), caps.begin(), caps.end());
  // Iterate, because braking for the new speed caps may itself be too hard; gentler braking must
  // begin earlier.
  constexpr int kMaxAttempts = 4;
  constexpr double kNearlyAll = 0.999;
  feasible_speeds::GripShares shares;
  for (int i = 0; i < kMaxAttempts && !slower.left.empty(); ++i) {
    shares.braking = std::min(shares.braking,
                              Has(slower.left, Remedy::kGentlerBraking) ? kNearlyAll : kUnlimited);
    shares.driving = std::min(shares.driving,
                              Has(slower.left, Remedy::kGentlerDriving) ? kNearlyAll : kUnlimited);
    if (Has(slower.left, Remedy::kGentlerBends)) {
      if (!Has(slower.reasons, Remedy::kGentlerBends)) {
        slower.reasons.insert(slower.reasons.end(), slower.left.begin(), slower.left.end());
      }
      shares = feasible_speeds::kBendShares;
      const std::vector<SpeedCap> bends = feasible_speeds::CapsInBends(slower.plan, request);
      own.insert(own.end(), bends.begin(), bends.end());
      slower.slowest = feasible_speeds::MinSpeedOf(bends, slower.slowest);
    }
    const std::vector<AccelerationCap> sections =
        feasible_speeds::SectionsOfLessGrip(plan.reference.path, request, shares);
    feasible_speeds::SetSpeedsOn(slower.plan, request.start_speed, request.speed, sections);
    slower.limits = feasible_speeds::SmallestOf(request.speed, sections);
    slower.left = FindExcesses(slower.plan, request);
  }
  if (slower.left.empty() && slower.slowest < kMinPlanSpeed) {
    slower.left = first;
  }
  return slower;
}

/// Returns the excess of the start speed, if the plan is feasible for a car that starts slower.
/// `left` are the excesses that slowing down does not repair.
std::optional<Excess> StartSpeedExcess(const Plan& plan, const PlanRequest& request,
                                       const std::vector<Excess>& left) {
  PlanRequest own = request;
  const auto highest = start_excess::HighestStartSpeed(request.start_speed, [&](double start) {
    Plan trial = plan;
    own.start_speed = start;
    SetSpeeds(trial, start, own.speed);
    const std::vector<Excess> first = FindExcesses(trial, own);
    return first.empty() || (!Has(first, Remedy::kNone) && SlowDown(trial, own, first).ok());
  });
  if (!highest) {
    return std::nullopt;
  }
  const Excess cause = start_excess::LeftAfterBraking(plan, request).value_or(left.front());
  return start_excess::TooFast(request.start_speed, *highest, ToString(cause), cause.station);
}

/// Returns the plan after the changes that the request asks for, or a refused plan; see
/// MakeFeasible.
Plan Repaired(Plan plan, const PlanRequest& request, Refusal refusal) {
  if (request.limits) {
    return DriveAtLimit(std::move(plan), request, refusal);
  }
  std::vector<Excess> first = FindExcesses(plan, request);
  // The plan is the remainder of an earlier plan whose speeds were determined by the g-g-v diagram.
  if (IsAtLimit(plan, request)) {
    std::erase_if(first, [](const Excess& excess) { return excess.remedy != Remedy::kNone; });
  }
  if (first.empty()) {
    return plan;
  }
  const bool hopeless = Has(first, Remedy::kNone);
  if (request.infeasible == InfeasiblePolicy::kAllow) {
    AddOnce(plan.notes, "infeasible, kept anyway: " + Listed(first));
    return plan;
  }
  if (hopeless || request.infeasible == InfeasiblePolicy::kRefuse) {
    return Refuse(first, plan);
  }
  SlowerPlan slower = SlowDown(plan, request, first);
  if (!slower.ok()) {
    const std::optional<Excess> start = refusal == Refusal::kExplained
                                            ? StartSpeedExcess(plan, request, slower.left)
                                            : std::nullopt;
    return Refuse(start ? std::vector{*start} : slower.left, plan);
  }
  slower.plan.notes.push_back(fmt::format(
      "{}: at {:.3g} m/s {}", DescribeSpeedChanges(request.speed, slower.limits, slower.slowest),
      request.speed.speed, Listed(slower.reasons)));
  return std::move(slower.plan);
}

}  // namespace

std::string ToString(const Excess& excess) {
  const std::string text =
      fmt::format("{} {:.3g} {} exceeds {:.3g} {} at s = {:.4g} m", excess.what, excess.required,
                  excess.unit, excess.limit, excess.unit, excess.station);
  return excess.hint.empty() ? text : fmt::format("{} ({})", text, excess.hint);
}

void SetSpeeds(Plan& plan, double start_speed, const SpeedLimits& limits) {
  feasible_speeds::SetSpeedsOn(plan, start_speed, limits, {});
}

std::vector<Excess> FindExcesses(const Plan& plan, const PlanRequest& request) {
  std::vector<Excess> found;
  CheckStart(plan, request, found);
  CheckPath(plan, request, found);
  CheckSteeringRate(plan, request, found);
  CheckAcceleration(plan, request, found);
  // List the excess of the combined acceleration only if there is no other excess, which would be
  // closer to the cause.
  if (found.size() > 1) {
    std::erase_if(found,
                  [](const Excess& excess) { return excess.remedy == Remedy::kGentlerBends; });
  }
  return found;
}

FeasiblePlan MakeFeasible(Plan plan, const PlanRequest& request, Refusal refusal) {
  if (!plan.ok()) {
    return FeasiblePlan(std::move(plan));
  }
  return FeasiblePlan(Repaired(std::move(plan), request, refusal));
}

PlanRequest RequestOn(const RoadConditions& road, const VehicleParams& vehicle,
                      const SpeedLimits& speed) {
  return {.vehicle = vehicle,
          .waypoints = {},
          .start = {},
          .speed = speed,
          .friction = road.friction,
          .friction_patches = road.friction_patches,
          .ground = road.ground,
          .infeasible = road.infeasible,
          .limits = road.limits};
}

FeasiblePlan MakeFeasibleFromHere(Plan plan, const PlanRequest& request) {
  PlanRequest own = request;
  const PathPoint first = plan.reference.path.At(0.0);
  own.start = first.pose;
  own.start_speed = plan.reference.speed.SpeedAt(0.0);
  own.start_steering = SteeringForCurvature(request.vehicle, first.curvature);
  return MakeFeasible(std::move(plan), own);
}

}  // namespace trackbed
