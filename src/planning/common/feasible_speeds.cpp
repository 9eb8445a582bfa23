#include "src/planning/common/feasible_speeds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "trackbed/planning/common/speed_at_limit.h"

// Finds speeds at which a car can drive a given path (used by feasibility.cpp).
// 1. The path is divided into pieces of at most kCheckSpacing.
// 2. CapsFor limits the speed on each piece by the steering rate, the lateral grip and the top
//    speed.
// 3. GripAlong gives the acceleration and deceleration that the road allows on each piece;
//    SectionsOfLessGrip keeps the pieces on which the road allows less than the mission demands.
// 4. CapsInBends lowers the speed in a whole bend if the accelerations along and across the path
//    together exceed the friction ellipse somewhere in the bend.
// 5. SteerableSpeedsAtLimit repeats the profile at the limit (limit_profile.h) until the wheels can
//    follow the profile.
namespace trackbed::feasible_speeds {
namespace {

/// Returns the grip of the road; infinite if the grip is unknown (0).
double Known(double grip) {
  return grip > 0.0 ? grip : std::numeric_limits<double>::infinity();
}

}  // namespace

double LateralOver(const RoadHold& road, const Path& path, const Stations& piece) {
  if (road.uniform()) {
    return road.Lateral(path, piece.from, 0.0);
  }
  const double curvature = path.At(0.5 * (piece.from + piece.to)).curvature;
  return std::min(road.Lateral(path, piece.from, curvature),
                  road.Lateral(path, piece.to, curvature));
}

RoadHold::Combined CombinedOver(const RoadHold& road, const Path& path, const PathPiece& piece,
                                double v_from, double v_to) {
  if (road.flat() && (piece.curvature == 0.0 || v_from == v_to)) {
    return {};
  }
  const auto [from, to] = piece.stations;
  const double along = to > from ? 0.5 * (v_to * v_to - v_from * v_from) / (to - from) : 0.0;
  const double across = std::max(v_from * v_from, v_to * v_to) * piece.curvature;
  const bool bends_left = road.flat() || path.At(0.5 * (from + to)).curvature >= 0.0;
  return road.Both(path, from, along, bends_left ? across : -across);
}

std::string FrictionForSlope(const Excess& slope, const Path& path, const PlanRequest& request) {
  constexpr double kReserve = 1.1;
  const double factor = RoadHold(request).Factor(path.At(slope.station).pose);
  const double needed = 0.01 * std::ceil(100.0 * kReserve * factor * slope.required / slope.limit);
  return fmt::format(
      "the road has a friction factor of {:.3g} there; set world.friction, or that of the friction "
      "patch, to at least {:.3g}, or make the slope gentler",
      factor, needed);
}

bool EndsAtStop(const std::vector<Stations>& legs, double s) {
  constexpr double kEqualityTolerance = 1e-6;  // [m]
  const auto leg =
      std::upper_bound(legs.begin(), legs.end(), s - kEqualityTolerance,
                       [](double station, const Stations& each) { return station < each.to; });
  return leg < legs.end() - 1 && leg->to < s + kEqualityTolerance;
}

VehicleParams SteeredCar(const Plan& plan, const PlanRequest& request) {
  VehicleParams car = request.vehicle;
  if (!request.limits && !plan.diagnostics.speed_profile) {
    car.cornering_stiffness_front = 0.0;
    car.cornering_stiffness_rear = 0.0;
  }
  return car;
}

double UsableSteeringRate(const PlanRequest& request) {
  const double share = request.limits ? request.limits->options.share : 1.0;
  return share * request.vehicle.steering_rate;
}

PieceSpeed SpeedOn(const Path& path, const PathPiece& piece, const RoadHold& road, double v_from,
                   double v_to) {
  const auto [from, to] = piece.stations;
  return {.speed = std::max(v_from, v_to),
          .acceleration = to > from ? 0.5 * (v_to * v_to - v_from * v_from) / (to - from) : 0.0,
          .direction = piece.direction,
          .road = road.FrictionAt(path, from)};
}

std::vector<SpeedCap> CapsForSteering(const Plan& plan, const PlanRequest& request) {
  std::vector<SpeedCap> caps;
  if (plan.sampled) {
    return caps;
  }
  constexpr double kTolerance = 1e-3;  // relative tolerance of the speed
  const double rate = UsableSteeringRate(request);
  const VehicleParams car = SteeredCar(plan, request);
  const RoadHold road(request);
  ForEachPiece(plan.reference.path, kCheckSpacing, [&](const PathPiece& piece) {
    const SpeedProfile& profile = plan.reference.speed;
    const PieceSpeed at =
        SpeedOn(plan.reference.path, piece, road, profile.SpeedAt(piece.stations.from),
                profile.SpeedAt(piece.stations.to));
    const double speed = SpeedForSteeringRate(car, piece.bends(), rate, at);
    if (speed < at.speed * (1.0 - kTolerance)) {
      caps.push_back({piece.stations.from, piece.stations.to, speed});
    }
  });
  return caps;
}

std::vector<SpeedCap> CapsFor(const Plan& plan, const PlanRequest& request) {
  const VehicleParams& vehicle = request.vehicle;
  const Path& path = plan.reference.path;
  std::vector<SpeedCap> caps;
  const double wanted = request.speed.speed;
  const double rate = UsableSteeringRate(request);
  const VehicleParams car = SteeredCar(plan, request);
  if (vehicle.top_speed > 0.0 && vehicle.top_speed < wanted) {
    caps.push_back({0.0, path.length(), vehicle.top_speed});
  }
  const auto add = [&](const Stations& piece, double speed) {
    if (!caps.empty() && caps.back().speed == speed && caps.back().to == piece.from) {
      caps.back().to = piece.to;  // extend the previous cap over this piece
    } else if (speed < wanted * (1.0 - kRounding)) {
      caps.push_back({piece.from, piece.to, speed});
    }
  };
  const RoadHold road(request);
  ForEachPiece(path, kCheckSpacing, [&](const PathPiece& piece) {
    const PieceSpeed at{.speed = wanted,
                        .direction = piece.direction,
                        .road = road.FrictionAt(path, piece.stations.from)};
    double speed = SpeedForSteeringRate(car, piece.bends(), rate, at);
    if (vehicle.friction_lateral > 0.0 && !request.limits) {
      const double lateral = LateralOver(road, path, piece.stations);
      speed = std::min(speed, std::sqrt(lateral / piece.curvature));
    }
    add(piece.stations, speed);  // on a straight, the speed is infinite and no cap is added
  });
  // Open-loop runs turn the wheels by the schedule, whatever the tyres do.
  const std::vector<Stations> legs = SplitIntoLegs(path, plan.stops);
  ForEachRamp(plan.schedule, [&](double from, double to, double slope) {
    const double speed = rate / slope;
    if (speed < wanted * (1.0 - kRounding) && !EndsAtStop(legs, to)) {
      caps.push_back({from, to, speed});
    }
  });
  return caps;
}

double MinSpeedOf(const std::vector<SpeedCap>& caps, double speed) {
  for (const SpeedCap& cap : caps) {
    speed = std::min(speed, cap.speed);
  }
  return speed;
}

SpeedLimits SmallestOf(SpeedLimits limits, const std::vector<AccelerationCap>& sections) {
  for (const AccelerationCap& section : sections) {
    limits.acceleration = std::min(limits.acceleration, section.acceleration);
    limits.deceleration = std::min(limits.deceleration, section.deceleration);
  }
  return limits;
}

void SetSpeedsOn(Plan& plan, double start_speed, const SpeedLimits& limits,
                 const std::vector<AccelerationCap>& sections) {
  const Path& path = plan.reference.path;
  const double stop =
      plan.schedule_speed.knots().empty() ? path.length() : plan.schedule_speed.knots().back().s;
  plan.reference.speed = StopAtCusps(path, start_speed, limits, plan.caps, plan.stops, sections);
  plan.schedule_speed = std::abs(stop - path.length()) < 1e-9
                            ? plan.reference.speed
                            : StopAtEnd(stop, start_speed, limits, plan.caps, sections);
}

std::optional<LimitExcess> SteerableSpeedsAtLimit(Plan& plan, const PlanRequest& request,
                                                  std::vector<SpeedCap>& caps) {
  constexpr int kMaxAttempts = 8;
  std::optional<LimitExcess> fast = SetSpeedsAtLimit(plan, request, caps);
  for (int i = 0; i < kMaxAttempts; ++i) {
    const std::vector<SpeedCap> more = CapsForSteering(plan, request);
    if (more.empty()) {
      break;
    }
    caps.insert(caps.end(), more.begin(), more.end());
    fast = SetSpeedsAtLimit(plan, request, caps);
  }
  return fast;
}

std::vector<AccelerationCap> GripAlong(const Path& path, const PlanRequest& request) {
  const RoadHold road(request);
  const auto at = [&](double s) {
    return AccelerationCap{s, s, Known(road.Driving(path, s)), Known(road.Braking(path, s))};
  };
  AccelerationCap from = at(0.0);
  if (road.uniform()) {
    return {{0.0, path.length(), from.acceleration, from.deceleration}};
  }
  std::vector<AccelerationCap> pieces;
  ForEachPiece(path, kCheckSpacing, [&](const PathPiece& piece) {
    const AccelerationCap to = at(piece.stations.to);
    pieces.push_back({piece.stations.from, to.to, std::min(from.acceleration, to.acceleration),
                      std::min(from.deceleration, to.deceleration)});
    from = to;
  });
  return pieces;
}

std::vector<AccelerationCap> SectionsOfLessGrip(const Path& path, const PlanRequest& request,
                                                const GripShares& shares) {
  std::vector<AccelerationCap> sections;
  for (AccelerationCap section : GripAlong(path, request)) {
    section.acceleration *= shares.driving;
    section.deceleration *= shares.braking;
    if (section.acceleration >= request.speed.acceleration &&
        section.deceleration >= request.speed.deceleration) {
      continue;
    }
    AccelerationCap* last = sections.empty() ? nullptr : &sections.back();
    if (last != nullptr && last->to == section.from && last->acceleration == section.acceleration &&
        last->deceleration == section.deceleration) {
      last->to = section.to;
    } else {
      sections.push_back(section);
    }
  }
  return sections;
}

std::vector<SpeedCap> CapsInBends(const Plan& plan, const PlanRequest& request) {
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
  const std::vector<AccelerationCap> grip = GripAlong(path, request);
  std::size_t next = 0;
  ForEachPiece(path, kCheckSpacing, [&](const PathPiece& piece) {
    const AccelerationCap& along_path = grip[road.uniform() ? 0 : next++];
    if (piece.curvature == 0.0) {
      finish_bend();
      return;
    }
    const auto [from, to] = piece.stations;
    const double curvature = path.At(0.5 * (from + to)).curvature;
    const double driving =
        std::min(request.speed.acceleration, kBendShares.driving * along_path.acceleration);
    const double braking =
        std::min(request.speed.deceleration, kBendShares.braking * along_path.deceleration);
    double lateral = std::numeric_limits<double>::infinity();
    for (const double s : {from, to}) {
      for (const double along : {-braking, driving}) {
        lateral = std::min(lateral, road.LateralBeside(path, s, curvature, along));
      }
    }
    bend.push_back({from, to, std::sqrt(std::max(0.0, lateral) / piece.curvature)});
    const SpeedProfile& speed = plan.reference.speed;
    const RoadHold::Combined both =
        CombinedOver(road, path, piece, speed.SpeedAt(from), speed.SpeedAt(to));
    is_exceeded =
        is_exceeded || (both.limit > 0.0 && both.required > both.limit * (1.0 + kRounding));
  });
  finish_bend();
  std::erase_if(caps, [&](const SpeedCap& cap) { return cap.speed >= request.speed.speed; });
  return caps;
}

}  // namespace trackbed::feasible_speeds
