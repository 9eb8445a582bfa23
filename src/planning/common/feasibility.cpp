#include "trackbed/planning/common/feasibility.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "trackbed/core/angle.h"
#include "trackbed/planning/common/path_pieces.h"
#include "trackbed/world/world.h"

namespace trackbed {
namespace {

constexpr double kRounding = 1e-6;      // of a limit
constexpr double kCheckSpacing = 0.1;   // between the stations that are looked at [m]
constexpr double kSlowest = 0.1;        // no plan is slowed down below this [m/s]
constexpr double kSamePlace = 1e-3;     // [m]; of the wheelbase where that is less than 1 m
constexpr double kSameHeading = 1e-3;   // [rad]
constexpr double kSameSteering = 1e-3;  // [rad]

/// The road's factor for a car at a station: the least under its axles.
double RoadAt(const PlanRequest& request, const Path& path, double s) {
  if (request.friction_patches.empty()) {
    return request.friction;
  }
  const Pose2 pose = path.At(s).pose;
  const auto factor = [&](const Vec2& point) {
    return RoadFactor(request.friction, request.friction_patches, point);
  };
  return std::min(factor(pose.position()), factor(ToWorld(pose, {request.vehicle.wheelbase, 0.0})));
}

/// Keeps the worst of one kind.
class Worst {
 public:
  Worst(std::string what, std::string unit, Remedy remedy)
      : excess_{.what = std::move(what), .unit = std::move(unit), .remedy = remedy} {}

  /// A limit of 0 is not known.
  void Take(double asked, double limit, double station) {
    if (limit > 0.0 && asked > limit * (1.0 + kRounding) && asked / limit > ratio_) {
      ratio_ = asked / limit;
      excess_.asked = asked;
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

/// Calls with every stretch [from, to] of the schedule on which the wheels turn, and the slope.
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

/// The road's factor over a piece.
double RoadOver(const PlanRequest& request, const Path& path, const Stations& piece) {
  return std::min(RoadAt(request, path, piece.from), RoadAt(request, path, piece.to));
}

/// Where the car stands on the way, the wheels may turn on the spot.
bool EndsAtStop(const std::vector<Stations>& legs, double s) {
  constexpr double kSame = 1e-6;  // [m]
  return std::any_of(legs.begin(), legs.end(), [&](const Stations& leg) {
    return &leg != &legs.back() && std::abs(leg.to - s) < kSame;
  });
}

void CheckStart(const Plan& plan, const PlanRequest& request, std::vector<Excess>& found) {
  const PathPoint first = plan.reference.path.At(0.0);
  Worst place("initial position error", "m", Remedy::kNone);
  place.Take((first.pose.position() - request.start.position()).norm(),
             kSamePlace * std::min(1.0, request.vehicle.wheelbase), 0.0);
  place.AddTo(found);
  Worst heading("initial heading error", "rad", Remedy::kNone);
  heading.Take(std::abs(AngleDifference(first.pose.yaw, request.start.yaw)), kSameHeading, 0.0);
  heading.AddTo(found);
  if (request.start_speed > 0.0) {
    const double steering = SteeringForCurvature(request.vehicle, first.curvature);
    Worst wheels("initial steering step", "rad", Remedy::kNone);
    wheels.Take(std::abs(steering - request.start_steering), kSameSteering, 0.0);
    wheels.AddTo(found);
  }
}

void CheckPath(const Plan& plan, const PlanRequest& request, std::vector<Excess>& found) {
  const VehicleParams& vehicle = request.vehicle;
  Worst steering("steering angle", "rad", Remedy::kNone);
  Worst lateral("lateral acceleration", "m/s^2", Remedy::kLowerSpeed);
  Worst speed("speed", "m/s", Remedy::kLowerSpeed);
  Worst rate("steering rate along the path", "rad/s", Remedy::kLowerSpeed);
  const Path& path = plan.reference.path;
  ForEachPiece(path, vehicle, kCheckSpacing, [&](const PathPiece& piece) {
    const double s = piece.stations.from;
    const double v =
        std::max(plan.reference.speed.SpeedAt(s), plan.reference.speed.SpeedAt(piece.stations.to));
    rate.Take(v * piece.slope, vehicle.steering_rate, s);
    steering.Take(SteeringForCurvature(vehicle, piece.curvature), vehicle.steering_limit, s);
    lateral.Take(v * v * piece.curvature,
                 MaxLateralAcceleration(vehicle, RoadOver(request, path, piece.stations)), s);
    speed.Take(v, vehicle.top_speed, s);
  });
  steering.AddTo(found);
  lateral.AddTo(found);
  rate.AddTo(found);
  speed.AddTo(found);
}

void CheckSteeringRate(const Plan& plan, const PlanRequest& request, std::vector<Excess>& found) {
  Worst rate("steering rate", "rad/s", Remedy::kLowerSpeed);
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
  const VehicleParams& vehicle = request.vehicle;
  constexpr double kController = 2.0;  // see SpeedControl
  Worst braking("deceleration", "m/s^2", Remedy::kGentlerBraking);
  Worst driving("acceleration", "m/s^2", Remedy::kGentlerDriving);
  const std::vector<SpeedProfile::Knot>& knots = plan.reference.speed.knots();
  for (std::size_t i = 1; i < knots.size(); ++i) {
    const SpeedProfile::Knot& a = knots[i - 1];
    const SpeedProfile::Knot& b = knots[i];
    const double change = (b.speed * b.speed - a.speed * a.speed) / (2.0 * (b.s - a.s));
    for (const double s : {a.s, 0.5 * (a.s + b.s), b.s}) {
      const double road = RoadAt(request, plan.reference.path, s);
      if (change < 0.0) {
        braking.Take(-change, MaxDeceleration(vehicle, road), a.s);
      } else {
        driving.Take(change, MaxAcceleration(vehicle, road), a.s);
      }
    }
    braking.Take(-change, kController * request.speed.deceleration, a.s);
  }
  braking.AddTo(found);
  driving.AddTo(found);
}

/// Caps that keep what a slower car can keep: steering rate, top speed, and unless the speeds are
/// at the limit anyway, lateral acceleration.
std::vector<SpeedCap> CapsFor(const Plan& plan, const PlanRequest& request) {
  const VehicleParams& vehicle = request.vehicle;
  const Path& path = plan.reference.path;
  std::vector<SpeedCap> caps;
  const double wanted = request.speed.speed;
  // At the limit, controllers need what is left of the steering rate, too.
  const double rate =
      vehicle.steering_rate * (request.limits ? request.limits->options.share : 1.0);
  if (vehicle.top_speed > 0.0 && vehicle.top_speed < wanted) {
    caps.push_back({0.0, path.length(), vehicle.top_speed});
  }
  const auto add = [&](const Stations& piece, double speed) {
    if (!caps.empty() && caps.back().speed == speed && caps.back().to == piece.from) {
      caps.back().to = piece.to;  // an arc is one
    } else if (speed < wanted * (1.0 - kRounding)) {
      caps.push_back({piece.from, piece.to, speed});
    }
  };
  ForEachPiece(path, vehicle, kCheckSpacing, [&](const PathPiece& piece) {
    double speed = rate / piece.slope;
    if (vehicle.friction_lateral > 0.0 && !request.limits) {
      const double road = RoadOver(request, path, piece.stations);
      speed = std::min(speed, std::sqrt(MaxLateralAcceleration(vehicle, road) / piece.curvature));
    }
    add(piece.stations, speed);  // infinite on a straight
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

std::string Listed(const std::vector<Excess>& excesses) {
  std::vector<std::string> texts;
  for (const Excess& excess : excesses) {
    texts.push_back(ToString(excess));
  }
  return fmt::format("{}", fmt::join(texts, "; "));
}

Plan Refuse(const std::vector<Excess>& excesses, const Plan& plan) {
  Plan refused;
  refused.status = PlanStatus::kInfeasible;
  refused.reason = "the path is not feasible: " + Listed(excesses);
  refused.diagnostics = plan.diagnostics;
  return refused;
}

double SlowestOf(const std::vector<SpeedCap>& caps, double speed) {
  for (const SpeedCap& cap : caps) {
    speed = std::min(speed, cap.speed);
  }
  return speed;
}

/// The limits that keep the car from sliding where it speeds up or slows down.
SpeedLimits Gentler(const SpeedLimits& limits, const std::vector<Excess>& excesses) {
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

/// The changes made to a plan: "speed reduced to 2.1 m/s where needed".
std::string Mended(const SpeedLimits& before, const SpeedLimits& after, double slowest) {
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

/// The plan with speeds at the limit, which is within it by construction: what is left are paths
/// that the car cannot follow at any speed, and starts that are too fast.
Plan DriveAtLimit(Plan plan, const PlanRequest& request) {
  std::vector<Excess> excesses;
  for (Excess& excess : FindExcesses(plan, request)) {
    if (excess.remedy == Remedy::kNone) {
      excesses.push_back(std::move(excess));
    }
  }
  std::vector<SpeedCap> caps = CapsFor(plan, request);
  if (SlowestOf(caps, request.speed.speed) < kSlowest) {
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
    excesses.push_back({"speed", kSlowest, 0.0, "m/s", stuck->s, Remedy::kNone});
  }
  if (!excesses.empty() && request.infeasible != InfeasiblePolicy::kAllow) {
    return Refuse(excesses, plan);
  }
  if (!excesses.empty()) {
    plan.notes.push_back("infeasible, kept anyway: " + Listed(excesses));
  }
  return plan;
}

}  // namespace

std::string ToString(const Excess& excess) {
  return fmt::format("{} {:.3g} {} exceeds {:.3g} {} at s = {:.4g} m", excess.what, excess.asked,
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
  return found;
}

Plan MakeFeasible(Plan plan, const PlanRequest& request) {
  if (!plan.ok()) {
    return plan;
  }
  if (request.limits) {
    return DriveAtLimit(std::move(plan), request);
  }
  const std::vector<Excess> first = FindExcesses(plan, request);
  if (first.empty()) {
    return plan;
  }
  const bool hopeless = std::any_of(first.begin(), first.end(), [](const Excess& excess) {
    return excess.remedy == Remedy::kNone;
  });
  if (request.infeasible == InfeasiblePolicy::kAllow) {
    plan.notes.push_back("infeasible, kept anyway: " + Listed(first));
    return plan;
  }
  if (hopeless || request.infeasible == InfeasiblePolicy::kRefuse) {
    return Refuse(first, plan);
  }
  const std::vector<SpeedCap> caps = CapsFor(plan, request);
  const double slowest = SlowestOf(caps, request.speed.speed);
  if (slowest < kSlowest) {
    return Refuse(first, plan);
  }
  Plan slower = plan;
  slower.caps.insert(slower.caps.end(), caps.begin(), caps.end());
  SpeedLimits limits = request.speed;
  // Braking for the caps may be too hard in its turn, and gentler braking begins elsewhere.
  constexpr int kTries = 4;
  std::vector<Excess> left = first;
  for (int i = 0; i < kTries && !left.empty(); ++i) {
    limits = Gentler(limits, left);
    SetSpeeds(slower, request.start_speed, limits);
    left = FindExcesses(slower, request);
  }
  if (!left.empty()) {
    return Refuse(left, plan);
  }
  slower.notes.push_back(fmt::format("{}: at {:.3g} m/s {}", Mended(request.speed, limits, slowest),
                                     request.speed.speed, Listed(first)));
  return slower;
}

}  // namespace trackbed
