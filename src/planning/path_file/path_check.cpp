#include "trackbed/planning/path_file/path_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "trackbed/core/error.h"
#include "trackbed/planning/common/path_pieces.h"
#include "trackbed/vehicle/steering_reach.h"

// Checks whether a car can drive a path at a constant speed, without simulation.
// 1. The path is divided into pieces of kSpacing.
// 2. DemandOf computes steering angle, steering rate and lateral acceleration on a piece, and the
//    highest speed that each limit of the car allows.
// 3. SteepestSlope samples tight pieces more finely, because the steering rate varies within them.
// 4. FaultFinder merges successive pieces that exceed the same limit into one fault, and keeps the
//    place of the largest excess.
// 5. A jump of the heading is one fault, whatever curvature the fitted arc has.
namespace trackbed {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Relative excess over a limit that is tolerated as rounding error.
constexpr double kRounding = 1e-6;
// Distance between checked points of the path [m]; larger if the path is longer than 20 km.
constexpr double kSpacing = 0.05;
constexpr double kMaxPieces = 4e5;

/// Converts a limit of 0, which means unknown, to infinity.
double OrInfinite(double limit) {
  return limit > 0.0 ? limit : kInfinity;
}

/// Merges adjacent path pieces that exceed the same limit into one fault.
class FaultFinder {
 public:
  FaultFinder(PathFaultKind kind, double limit) : kind_(kind), limit_(OrInfinite(limit)) {}

  void Take(const Stations& piece, double required, const Path& path,
            std::vector<PathFault>& faults) {
    if (!(required > limit_ * (1.0 + kRounding))) {
      is_open_ = false;
      return;
    }
    if (!is_open_) {
      index_ = faults.size();
      faults.push_back({.kind = kind_, .stations = piece, .limit = limit_});
    }
    is_open_ = true;
    PathFault& fault = faults[index_];
    fault.stations.to = piece.to;
    if (required > fault.required) {
      fault.required = required;
      fault.s = piece.from;
      fault.position = path.At(piece.from).pose.position();
    }
  }

 private:
  PathFaultKind kind_;
  double limit_;
  bool is_open_ = false;
  std::size_t index_ = 0;
};

PathCheck Reversed(const FittedPath& fitted, PathCheck check) {
  for (const HeadingJump& jump : fitted.reversals) {
    check.faults.push_back({.kind = PathFaultKind::kReversal,
                            .stations = {jump.s, jump.s},
                            .s = jump.s,
                            .position = jump.position,
                            .required = std::abs(jump.angle),
                            .limit = kMaxHeadingJump});
  }
  check.max_speed_station = check.faults.front().s;
  check.max_speed_limit = PathFaultKind::kReversal;
  return check;
}

/// Returns the steering and the acceleration that the car needs on a path piece, and the limit that
/// restricts the speed most on this piece. `slope` is the result of SteepestSlope.
std::pair<PathDemand, PathFaultKind> DemandOf(const PathPiece& piece, double slope,
                                              const PathPoint& begin, const VehicleParams& vehicle,
                                              double speed, const PathCheck& limits) {
  const auto by_acceleration = [&](double limit) {
    return piece.curvature > 0.0 ? std::sqrt(OrInfinite(limit) / piece.curvature) : kInfinity;
  };
  PathDemand demand{.s = piece.stations.from,
                    .position = begin.pose.position(),
                    .curvature = begin.curvature,
                    .curvature_rate = begin.sharpness,
                    .steering = SteeringForCurvature(vehicle, piece.curvature),
                    .steering_rate = speed * slope,
                    .lateral_acceleration = speed * speed * piece.curvature};
  demand.speed_by_steering_rate =
      slope > 0.0 ? OrInfinite(vehicle.steering_rate) / slope : kInfinity;
  demand.speed_by_friction = by_acceleration(limits.friction_limit);
  demand.speed_by_rollover = by_acceleration(limits.rollover_limit);
  const std::array<std::pair<double, PathFaultKind>, 5> speeds{
      {{demand.steering > SteeringReach(vehicle, begin.curvature) * (1.0 + kRounding) ? 0.0
                                                                                      : kInfinity,
        PathFaultKind::kSteeringAngle},
       {demand.speed_by_steering_rate, PathFaultKind::kSteeringRate},
       {demand.speed_by_friction, PathFaultKind::kFriction},
       {demand.speed_by_rollover, PathFaultKind::kRollOver},
       {OrInfinite(vehicle.top_speed), PathFaultKind::kTopSpeed}}};
  const auto least = std::min_element(
      speeds.begin(), speeds.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  demand.speed = least->first;
  return {demand, least->second};
}

/// Returns the largest slope |d delta/ds| of the steering angle on a piece [rad/m]. On tight bends,
/// the slope varies within a piece. The function samples this steering slope each time the steering
/// has turned by about 0.02 rad.
double SteepestSlope(const Path& path, const PathPiece& piece, const VehicleParams& vehicle) {
  constexpr double kTurn = 0.02;  // [rad]
  constexpr double kMaxParts = 100.0;
  double steepest = 0.0;
  for (const Bend& bend : piece.bends()) {
    steepest = std::max(steepest, SteeringSlope(vehicle, bend));
  }
  const double turn = steepest * (piece.stations.to - piece.stations.from);
  const double parts = std::min(kMaxParts, std::ceil(turn / kTurn));
  for (double part = 1.0; part < parts; part += 1.0) {
    const PathPoint point =
        path.At(std::lerp(piece.stations.from, piece.stations.to, part / parts));
    steepest = std::max(steepest, SteeringSlope(vehicle, {point.curvature, point.sharpness}));
  }
  return steepest;
}

}  // namespace

double RollOverAcceleration(double track, double cg_height) {
  TRACKBED_REQUIRE(
      std::isfinite(track) && track > 0.0 && std::isfinite(cg_height) && cg_height > 0.0,
      "RollOverAcceleration: track {} m, height {} m; must be above 0", track, cg_height);
  return kGravity * track / (2.0 * cg_height);
}

PathCheck CheckPath(const FittedPath& fitted, const VehicleParams& vehicle,
                    const PathCheckOptions& options) {
  TRACKBED_REQUIRE(std::isfinite(options.speed) && options.speed > 0.0 &&
                       std::isfinite(options.friction) && options.friction > 0.0,
                   "CheckPath: speed {} m/s, friction {}; must be above 0", options.speed,
                   options.friction);
  PathCheck check;
  check.steering_limit = SteeringReach(vehicle, 0.0);
  check.steering_rate_limit = vehicle.steering_rate;
  check.friction_limit = MaxLateralAcceleration(vehicle, options.friction);
  check.rollover_limit = options.rollover_acceleration.value_or(0.0);
  if (!fitted.reversals.empty()) {
    return Reversed(fitted, std::move(check));
  }
  const Path& path = fitted.path;
  const std::vector<HeadingJump>& jumps = fitted.jumps;
  FaultFinder left(PathFaultKind::kSteeringAngle, SteeringReach(vehicle, 1.0));
  FaultFinder right(PathFaultKind::kSteeringAngle, SteeringReach(vehicle, -1.0));
  FaultFinder rate(PathFaultKind::kSteeringRate, vehicle.steering_rate);
  FaultFinder friction(PathFaultKind::kFriction, check.friction_limit);
  FaultFinder rollover(PathFaultKind::kRollOver, check.rollover_limit);
  FaultFinder top_speed(PathFaultKind::kTopSpeed, vehicle.top_speed);
  auto jump = jumps.begin();
  check.max_speed = kInfinity;
  const auto limit_speed = [&](double speed, double s, PathFaultKind kind) {
    if (speed < check.max_speed) {
      check.max_speed = speed;
      check.max_speed_station = s;
      check.max_speed_limit = kind;
    }
  };
  const double spacing = std::max(kSpacing, path.length() / kMaxPieces);
  ForEachPiece(path, spacing, [&](const PathPiece& piece) {
    // Where an arc replaces a heading jump, report the jump instead of the arc's curvature. The
    // curvature of such an arc depends on the spacing of the file's points and not on the intended
    // path.
    while (jump != jumps.end() && jump->rounded.to <= piece.stations.from + 1e-9) {
      ++jump;
    }
    if (jump != jumps.end() && piece.stations.from >= jump->rounded.from - 1e-9) {
      check.faults.push_back({.kind = PathFaultKind::kHeadingJump,
                              .stations = jump->rounded,
                              .s = jump->s,
                              .position = jump->position,
                              .required = std::abs(jump->angle),
                              .limit = 0.0});
      limit_speed(0.0, jump->s, PathFaultKind::kHeadingJump);
      ++jump;
      return;
    }
    const auto [demand, limit] =
        DemandOf(piece, SteepestSlope(path, piece, vehicle), path.At(piece.stations.from), vehicle,
                 options.speed, check);
    check.demands.push_back(demand);
    limit_speed(demand.speed, demand.s, limit);
    const bool is_left = demand.curvature >= 0.0;
    left.Take(piece.stations, is_left ? demand.steering : 0.0, path, check.faults);
    right.Take(piece.stations, is_left ? 0.0 : demand.steering, path, check.faults);
    rate.Take(piece.stations, demand.steering_rate, path, check.faults);
    friction.Take(piece.stations, demand.lateral_acceleration, path, check.faults);
    rollover.Take(piece.stations, demand.lateral_acceleration, path, check.faults);
    top_speed.Take(piece.stations, options.speed, path, check.faults);
  });
  return check;
}

const char* ToString(PathFaultKind kind) {
  switch (kind) {
    case PathFaultKind::kReversal:
      return "reversal";
    case PathFaultKind::kHeadingJump:
      return "heading_jump";
    case PathFaultKind::kSteeringAngle:
      return "steering_angle";
    case PathFaultKind::kSteeringRate:
      return "steering_rate";
    case PathFaultKind::kFriction:
      return "friction";
    case PathFaultKind::kRollOver:
      return "roll_over";
    case PathFaultKind::kTopSpeed:
      return "top_speed";
  }
  return "";
}

const char* UnitOf(PathFaultKind kind) {
  switch (kind) {
    case PathFaultKind::kReversal:
    case PathFaultKind::kHeadingJump:
    case PathFaultKind::kSteeringAngle:
      return "rad";
    case PathFaultKind::kSteeringRate:
      return "rad/s";
    case PathFaultKind::kFriction:
    case PathFaultKind::kRollOver:
      return "m/s^2";
    case PathFaultKind::kTopSpeed:
      return "m/s";
  }
  return "";
}

std::string ToString(const PathFault& fault) {
  const char* unit = UnitOf(fault.kind);
  const std::string place = fmt::format("at s = {:.4g} m, ({:.6g}, {:.6g})", fault.s,
                                        fault.position.x(), fault.position.y());
  const std::string beyond =
      fmt::format("{:.3g} {} exceeds {:.3g} {} {}, on {:.3g} m", fault.required, unit, fault.limit,
                  unit, place, fault.stations.to - fault.stations.from);
  switch (fault.kind) {
    case PathFaultKind::kReversal:
      return fmt::format("turns back on itself by {:.3g} rad {}", fault.required, place);
    case PathFaultKind::kHeadingJump:
      return fmt::format("heading jumps by {:.3g} rad {}", fault.required, place);
    case PathFaultKind::kSteeringAngle:
      return "steering angle " + beyond;
    case PathFaultKind::kSteeringRate:
      return "steering rate " + beyond;
    case PathFaultKind::kFriction:
      return "lateral acceleration " + beyond + " (friction)";
    case PathFaultKind::kRollOver:
      return "lateral acceleration " + beyond + " (roll-over)";
    case PathFaultKind::kTopSpeed:
      return "speed " + beyond;
  }
  return "";
}

}  // namespace trackbed
