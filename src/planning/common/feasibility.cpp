#include "trackbed/planning/common/feasibility.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "trackbed/core/angle.h"
#include "trackbed/planning/common/path_pieces.h"
#include "trackbed/planning/common/road_hold.h"

// Checks a plan against the car's limits and repairs the plan. The check samples start, path,
// steering rate and accelerations. The check keeps the worst excess of each quantity, with the
// remedy that would help. If slower driving helps, MakeFeasible adds speed caps and lowers the
// acceleration limits, up to four times. The caps are for steering rate, top speed and lateral
// acceleration. If slower driving does not help, MakeFeasible refuses the plan. SetSpeedsAtLimit
// computes new speeds for plans at the limit of the g-g-v diagram.

namespace trackbed {
namespace {

constexpr double kRounding = 1e-6;     // Relative tolerance of a limit.
constexpr double kCheckSpacing = 0.1;  // Spacing of the checks along the path [m].
constexpr double kMinPlanSpeed = 0.1;  // Slowest permitted plan; slower plans are refused [m/s].
// Tolerance [m] of the position; per meter of wheelbase if the wheelbase is shorter than 1 m.
constexpr double kSamePlace = 1e-3;
constexpr double kSameHeading = 1e-3;   // [rad]
constexpr double kSameSteering = 1e-3;  // [rad]

/// Keeps the worst excess of one quantity.
class WorstExcess {
 public:
  WorstExcess(std::string what, std::string unit, Remedy remedy)
      : excess_{.what = std::move(what), .unit = std::move(unit), .remedy = remedy} {}

  /// A limit of 0 means that the limit is unknown, so nothing exceeds it.
  void Take(double required, double limit, double station) {
    if (limit > 0.0 && required > limit * (1.0 + kRounding) && required / limit > ratio_) {
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

/// Calls `call` with `from`, `to` and the slope of each stretch of the schedule on which the wheels
/// turn.
template <typename Call>
void ForEachRamp(const SteeringSchedule& schedule, const Call& call) {
  const std::vector<SteeringSchedule::Knot>& knots = schedule.knots();
  for (std::size_t i = 1; i < knots.size(); ++i) {
    const double length = knots[i].distance - knots[i - 1].distance;
    const double turned = std::abs(knots[i].steering - knots[i - 1].steering);
    if (turned > 0.0) {
      call(knots[i - 1].distance, knots[i].distance, turned / length);
    }
  }
}

/// The largest lateral acceleration v^2 |kappa| over a piece of the path.
double LateralOver(const RoadHold& road, const Path& path, const Stations& piece) {
  if (road.uniform()) {
    return road.Lateral(path, piece.from, 0.0);
  }
  const double curvature = path.At(0.5 * (piece.from + piece.to)).curvature;
  return std::min(road.Lateral(path, piece.from, curvature),
                  road.Lateral(path, piece.to, curvature));
}

/// The acceleration that the plan needs over a piece of its path, along and across together.
RoadHold::Combined CombinedOver(const RoadHold& road, const Plan& plan, const PathPiece& piece) {
  const auto [from, to] = piece.stations;
  const Path& path = plan.reference.path;
  const double v_from = plan.reference.speed.SpeedAt(from);
  const double v_to = plan.reference.speed.SpeedAt(to);
  const double along = to > from ? 0.5 * (v_to * v_to - v_from * v_from) / (to - from) : 0.0;
  const double across = std::max(v_from * v_from, v_to * v_to) * piece.curvature;
  return road.Both(path, from, along, std::copysign(across, path.At(0.5 * (from + to)).curvature));
}

/// Whether the g-g-v diagram of the car determined the plan's speeds.
bool IsAtLimit(const Plan& plan, const PlanRequest& request) {
  return request.limits || plan.diagnostics.speed_profile;
}

/// Whether a leg ends at s with an intermediate stop, where the wheels may turn at standstill.
bool EndsAtStop(const std::vector<Stations>& legs, double s) {
  constexpr double kEqualityTolerance = 1e-6;  // [m]
  return std::any_of(legs.begin(), legs.end(), [&](const Stations& leg) {
    return &leg != &legs.back() && std::abs(leg.to - s) < kEqualityTolerance;
  });
}

void CheckStart(const Plan& plan, const PlanRequest& request, std::vector<Excess>& found) {
  const PathPoint first = plan.reference.path.At(0.0);
  WorstExcess place("initial position error", "m", Remedy::kNone);
  place.Take((first.pose.position() - request.start.position()).norm(),
             kSamePlace * std::min(1.0, request.vehicle.wheelbase), 0.0);
  place.AddTo(found);
  WorstExcess heading("initial heading error", "rad", Remedy::kNone);
  heading.Take(std::abs(AngleDifference(first.pose.yaw, request.start.yaw)), kSameHeading, 0.0);
  heading.AddTo(found);
  if (request.start_speed > 0.0) {
    const double steering = SteeringForCurvature(request.vehicle, first.curvature);
    WorstExcess wheels("initial steering step", "rad", Remedy::kNone);
    wheels.Take(std::abs(steering - request.start_steering), kSameSteering, 0.0);
    wheels.AddTo(found);
  }
}

void CheckPath(const Plan& plan, const PlanRequest& request, std::vector<Excess>& found) {
  const VehicleParams& vehicle = request.vehicle;
  WorstExcess steering("steering angle", "rad", Remedy::kNone);
  WorstExcess lateral("lateral acceleration", "m/s^2", Remedy::kLowerSpeed);
  WorstExcess speed("speed", "m/s", Remedy::kLowerSpeed);
  WorstExcess rate("steering rate along the path", "rad/s", Remedy::kLowerSpeed);
  WorstExcess slope("pull of gravity", "m/s^2", Remedy::kNone);
  WorstExcess combined("combined acceleration", "m/s^2", Remedy::kGentlerBends);
  const Path& path = plan.reference.path;
  const RoadHold road(request);
  const bool is_at_limit = IsAtLimit(plan, request);
  ForEachPiece(path, vehicle, kCheckSpacing, [&](const PathPiece& piece) {
    const double s = piece.stations.from;
    const double v =
        std::max(plan.reference.speed.SpeedAt(s), plan.reference.speed.SpeedAt(piece.stations.to));
    if (!plan.sampled) {
      rate.Take(v * piece.slope, vehicle.steering_rate, s);
    }
    steering.Take(SteeringForCurvature(vehicle, piece.curvature), vehicle.steering_limit, s);
    lateral.Take(v * v * piece.curvature, LateralOver(road, path, piece.stations), s);
    speed.Take(v, vehicle.top_speed, s);
    if (is_at_limit) {
      return;
    }
    const RoadHold::Pull pull = road.Slope(path, s);
    slope.Take(pull.pull, pull.hold, s);
    const RoadHold::Combined both = CombinedOver(road, plan, piece);
    combined.Take(both.required, both.limit, s);
  });
  slope.AddTo(found);
  steering.AddTo(found);
  lateral.AddTo(found);
  combined.AddTo(found);
  rate.AddTo(found);
  speed.AddTo(found);
}

void CheckSteeringRate(const Plan& plan, const PlanRequest& request, std::vector<Excess>& found) {
  WorstExcess rate("steering rate", "rad/s", Remedy::kLowerSpeed);
  const std::vector<Stations> legs = SplitIntoLegs(plan.reference.path, plan.stops);
  ForEachRamp(plan.schedule, [&](double from, double to, double slope) {
    if (EndsAtStop(legs, to)) {
      return;
    }
    double fastest = std::max(plan.schedule_speed.SpeedAt(from), plan.schedule_speed.SpeedAt(to));
    for (const SpeedProfile::Knot& knot : plan.schedule_speed.knots()) {
      if (knot.s > from && knot.s < to) {
        fastest = std::max(fastest, knot.speed);
      }
    }
    rate.Take(fastest * slope, request.vehicle.steering_rate, from);
  });
  rate.AddTo(found);
}

void CheckAcceleration(const Plan& plan, const PlanRequest& request, std::vector<Excess>& found) {
  constexpr double kController = 2.0;  // multiple of the planned deceleration; see SpeedControl
  const Path& path = plan.reference.path;
  const RoadHold road(request);
  WorstExcess braking("deceleration", "m/s^2", Remedy::kGentlerBraking);
  WorstExcess driving("acceleration", "m/s^2", Remedy::kGentlerDriving);
  const std::vector<SpeedProfile::Knot>& knots = plan.reference.speed.knots();
  for (std::size_t i = 1; i < knots.size(); ++i) {
    const SpeedProfile::Knot& a = knots[i - 1];
    const SpeedProfile::Knot& b = knots[i];
    const double change = (b.speed * b.speed - a.speed * a.speed) / (2.0 * (b.s - a.s));
    const double looks =
        road.uniform() ? 1.0 : std::max(2.0, std::ceil((b.s - a.s) / kCheckSpacing));
    for (double look = 0.0; look <= looks; look += 1.0) {
      const double s = std::lerp(a.s, b.s, look / looks);
      if (change < 0.0) {
        braking.Take(-change, road.Braking(path, s), a.s);
      } else {
        driving.Take(change, road.Driving(path, s), a.s);
      }
    }
    braking.Take(-change, kController * request.speed.deceleration, a.s);
  }
  braking.AddTo(found);
  driving.AddTo(found);
}

/// Speed caps for the limits that depend on speed: steering rate, top speed and lateral
/// acceleration. Plans whose speeds are at the limit anyway get no cap for the lateral
/// acceleration.
std::vector<SpeedCap> CapsFor(const Plan& plan, const PlanRequest& request) {
  const VehicleParams& vehicle = request.vehicle;
  const Path& path = plan.reference.path;
  std::vector<SpeedCap> caps;
  const double wanted = request.speed.speed;
  // If the plan drives at the limit, use only a share of the steering rate, because the controllers
  // need the rest.
  const double rate =
      vehicle.steering_rate * (request.limits ? request.limits->options.share : 1.0);
  if (vehicle.top_speed > 0.0 && vehicle.top_speed < wanted) {
    caps.push_back({0.0, path.length(), vehicle.top_speed});
  }
  const auto add = [&](const Stations& piece, double speed) {
    if (!caps.empty() && caps.back().speed == speed && caps.back().to == piece.from) {
      caps.back().to = piece.to;  // extend the cap over the arc
    } else if (speed < wanted * (1.0 - kRounding)) {
      caps.push_back({piece.from, piece.to, speed});
    }
  };
  const RoadHold road(request);
  ForEachPiece(path, vehicle, kCheckSpacing, [&](const PathPiece& piece) {
    double speed = rate / piece.slope;
    if (vehicle.friction_lateral > 0.0 && !request.limits) {
      const double lateral = LateralOver(road, path, piece.stations);
      speed = std::min(speed, std::sqrt(lateral / piece.curvature));
    }
    add(piece.stations, speed);  // the speed is infinite on a straight
  });
  const std::vector<Stations> legs = SplitIntoLegs(path, plan.stops);
  ForEachRamp(plan.schedule, [&](double from, double to, double slope) {
    const double speed = rate / slope;
    if (speed < wanted * (1.0 - kRounding) && !EndsAtStop(legs, to)) {
      caps.push_back({from, to, speed});
    }
  });
  return caps;
}

bool Has(const std::vector<Excess>& excesses, Remedy remedy) {
  return std::any_of(excesses.begin(), excesses.end(),
                     [&](const Excess& excess) { return excess.remedy == remedy; });
}

/// Reduced acceleration limits that leave grip for bends: at most 0.7, about 1/sqrt(2), of what the
/// road holds.
SpeedLimits LeaveGripForBends(const SpeedLimits& limits, const Path& path,
                              const PlanRequest& request) {
  constexpr double kShare = 0.7;
  const RoadHoldLimits hold = MinRoadHold(path, {0.0, path.length()}, request);
  SpeedLimits gentler = limits;
  if (hold.braking > 0.0) {
    gentler.deceleration = std::min(gentler.deceleration, kShare * hold.braking);
  }
  if (hold.driving > 0.0) {
    gentler.acceleration = std::min(gentler.acceleration, kShare * hold.driving);
  }
  return gentler;
}

/// Speed caps for each bend in which the plan exceeds the friction ellipse. A bend is a stretch of
/// the path without straights. The caps keep the bend within the ellipse even while the car speeds
/// up or slows down at the limits.
std::vector<SpeedCap> CapsInBends(const Plan& plan, const PlanRequest& request,
                                  const SpeedLimits& limits) {
  const Path& path = plan.reference.path;
  const RoadHold road(request);
  std::vector<SpeedCap> caps;
  std::vector<SpeedCap> bend;
  bool is_exceeded = false;
  const auto finish_bend = [&] {
    if (is_exceeded) {
      caps.insert(caps.end(), bend.begin(), bend.end());
    }
    bend.clear();
    is_exceeded = false;
  };
  ForEachPiece(path, request.vehicle, kCheckSpacing, [&](const PathPiece& piece) {
    if (piece.curvature == 0.0) {
      finish_bend();
      return;
    }
    const auto [from, to] = piece.stations;
    const double curvature = path.At(0.5 * (from + to)).curvature;
    double lateral = std::numeric_limits<double>::infinity();
    for (const double s : {from, to}) {
      for (const double along : {-limits.deceleration, limits.acceleration}) {
        lateral = std::min(lateral, road.LateralBeside(path, s, curvature, along));
      }
    }
    bend.push_back({from, to, std::sqrt(std::max(0.0, lateral) / piece.curvature)});
    const RoadHold::Combined both = CombinedOver(road, plan, piece);
    is_exceeded = is_exceeded || (both.limit > 0.0 && both.required > both.limit);
  });
  finish_bend();
  std::erase_if(caps, [&](const SpeedCap& cap) { return cap.speed >= limits.speed; });
  return caps;
}

std::string Listed(const std::vector<Excess>& excesses) {
  std::vector<std::string> texts;
  for (const Excess& excess : excesses) {
    texts.push_back(ToString(excess));
  }
  return fmt::format("{}", fmt::join(texts, "; "));
}

/// Adds a note unless the plan already has it, because the same limits may be applied to a plan
/// twice.
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

double MinSpeedOf(const std::vector<SpeedCap>& caps, double speed) {
  for (const SpeedCap& cap : caps) {
    speed = std::min(speed, cap.speed);
  }
  return speed;
}

/// Reduced acceleration limits, so that the car does not slide while it speeds up or slows down.
SpeedLimits ReduceAccelerations(const SpeedLimits& limits, const std::vector<Excess>& excesses) {
  SpeedLimits gentler = limits;
  for (const Excess& excess : excesses) {
    const double below = 0.999 * excess.limit;
    if (excess.remedy == Remedy::kGentlerBraking) {
      gentler.deceleration = std::min(gentler.deceleration, below);
    } else if (excess.remedy == Remedy::kGentlerDriving) {
      gentler.acceleration = std::min(gentler.acceleration, below);
    }
  }
  return gentler;
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

/// The plan with speeds at the limit of the g-g-v diagram. Speeds at the limit of the g-g-v diagram
/// are feasible by construction. Excesses remain for paths that the car cannot follow at any speed,
/// and for starts that are too fast.
Plan DriveAtLimit(Plan plan, const PlanRequest& request) {
  std::vector<Excess> excesses;
  for (Excess& excess : FindExcesses(plan, request)) {
    if (excess.remedy == Remedy::kNone) {
      excesses.push_back(std::move(excess));
    }
  }
  std::vector<SpeedCap> caps = CapsFor(plan, request);
  if (MinSpeedOf(caps, request.speed.speed) < kMinPlanSpeed) {
    for (Excess& excess : FindExcesses(plan, request)) {
      excesses.push_back(std::move(excess));
    }
    return Refuse(excesses, plan);
  }
  caps.insert(caps.end(), plan.caps.begin(), plan.caps.end());
  if (const std::optional<LimitExcess> fast = SetSpeedsAtLimit(plan, request, caps)) {
    excesses.push_back({"speed", fast->speed, fast->allowed, "m/s", fast->s, Remedy::kNone});
  }
  const auto& knots = plan.reference.speed.knots();
  const auto stuck =
      std::adjacent_find(knots.begin(), knots.end(), [](const auto& before, const auto& after) {
        return before.speed == 0.0 && after.speed == 0.0;
      });
  if (stuck != knots.end()) {  // a slope that the car can neither climb nor hold
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

/// The plan after the repair that the request asks for, or a refused plan; see MakeFeasible.
Plan Repaired(Plan plan, const PlanRequest& request) {
  if (request.limits) {
    return DriveAtLimit(std::move(plan), request);
  }
  std::vector<Excess> first = FindExcesses(plan, request);
  // The plan is the rest of a plan whose speeds come from the g-g-v diagram.
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
  const std::vector<SpeedCap> caps = CapsFor(plan, request);
  double slowest = MinSpeedOf(caps, request.speed.speed);
  if (slowest < kMinPlanSpeed) {
    return Refuse(first, plan);
  }
  Plan slower = plan;
  slower.caps.insert(slower.caps.end(), caps.begin(), caps.end());
  SpeedLimits limits = request.speed;
  // Iterate, because braking for the new caps may itself be too hard, and gentler braking begins
  // earlier.
  constexpr int kMaxAttempts = 4;
  std::vector<Excess> left = first;
  for (int i = 0; i < kMaxAttempts && !left.empty(); ++i) {
    limits = ReduceAccelerations(limits, left);
    if (Has(left, Remedy::kGentlerBends)) {
      limits = LeaveGripForBends(limits, plan.reference.path, request);
      const std::vector<SpeedCap> bends = CapsInBends(slower, request, limits);
      slower.caps.insert(slower.caps.end(), bends.begin(), bends.end());
      slowest = MinSpeedOf(bends, slowest);
    }
    SetSpeeds(slower, request.start_speed, limits);
    left = FindExcesses(slower, request);
  }
  if (!left.empty() || slowest < kMinPlanSpeed) {
    return Refuse(left.empty() ? first : left, plan);
  }
  slower.notes.push_back(fmt::format("{}: at {:.3g} m/s {}",
                                     DescribeSpeedChanges(request.speed, limits, slowest),
                                     request.speed.speed, Listed(first)));
  return slower;
}

}  // namespace

std::string ToString(const Excess& excess) {
  return fmt::format("{} {:.3g} {} exceeds {:.3g} {} at s = {:.4g} m", excess.what, excess.required,
                     excess.unit, excess.limit, excess.unit, excess.station);
}

void SetSpeeds(Plan& plan, double start_speed, const SpeedLimits& limits) {
  const Path& path = plan.reference.path;
  const double stop =
      plan.schedule_speed.knots().empty() ? path.length() : plan.schedule_speed.knots().back().s;
  plan.reference.speed = StopAtCusps(path, start_speed, limits, plan.caps, plan.stops);
  plan.schedule_speed = std::abs(stop - path.length()) < 1e-9
                            ? plan.reference.speed
                            : StopAtEnd(stop, start_speed, limits, plan.caps);
}

std::vector<Excess> FindExcesses(const Plan& plan, const PlanRequest& request) {
  std::vector<Excess> found;
  CheckStart(plan, request, found);
  CheckPath(plan, request, found);
  CheckSteeringRate(plan, request, found);
  CheckAcceleration(plan, request, found);
  // Another excess is closer to the cause: the combined acceleration is only listed alone.
  if (found.size() > 1) {
    std::erase_if(found,
                  [](const Excess& excess) { return excess.remedy == Remedy::kGentlerBends; });
  }
  return found;
}

FeasiblePlan MakeFeasible(Plan plan, const PlanRequest& request) {
  if (!plan.ok()) {
    return FeasiblePlan(std::move(plan));
  }
  return FeasiblePlan(Repaired(std::move(plan), request));
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
