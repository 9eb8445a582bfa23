#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/path/fit_path.h"
#include "trackbed/vehicle/params.h"

/// Checks, without simulation, whether a car can drive a path at a given speed, and how fast the
/// car can drive the path.
///
/// Symbols: v the speed, kappa(s) curvature, delta(s) = atan(L kappa) steering, omega_delta and
/// delta_max the car's steering rate and angle, mu the lateral friction, a_r the lateral
/// acceleration at which the car tips over. The car is kinematic: its rear axle follows the path
/// exactly.
namespace trackbed {

enum class PathFaultKind {
  kReversal,  ///< The path turns back on itself by more than kMaxHeadingJump [rad].
  /// The heading of a polyline jumps [rad]. A car can only turn at a corner while it is at rest;
  /// the planner rejects paths with corners.
  kHeadingJump,
  kSteeringAngle,  ///< |delta| > delta_max [rad].
  kSteeringRate,   ///< v |d delta/ds| > omega_delta [rad/s].
  kFriction,       ///< v^2 |kappa| > mu g [m/s^2].
  kRollOver,       ///< v^2 |kappa| > a_r [m/s^2].
  kTopSpeed,       ///< v exceeds the car's top speed [m/s].
};

/// Returns the spelling of a kind in files: "steering_rate", ...
const char* ToString(PathFaultKind kind);
/// Returns the unit of the values of a kind: "rad/s", ...
const char* UnitOf(PathFaultKind kind);

/// A stretch of the path that the car cannot follow at the given speed.
struct PathFault {
  PathFaultKind kind = PathFaultKind::kReversal;
  Stations stations{0.0, 0.0};  ///< Stations of the stretch [m].
  double s = 0.0;               ///< Station of the worst violation [m].
  Vec2 position{0.0, 0.0};      ///< Position of the worst violation [m].
  double required = 0.0;  ///< Value that the path requires at the worst violation [UnitOf(kind)].
  double limit = 0.0;     ///< Limit of the required value [UnitOf(kind)].
};

/// Formats a fault: "steering rate 0.95 rad/s exceeds 0.15 rad/s at s = 42 m, (12.5, 3), on 1.2 m".
std::string ToString(const PathFault& fault);

struct PathCheckOptions {
  double speed = 0.0;     ///< Speed v [m/s], > 0.
  double friction = 1.0;  ///< Friction of the road, a factor on the tyres' friction.
  /// Lateral acceleration a_r [m/s^2]; none: the car does not tip over.
  std::optional<double> rollover_acceleration{};
};

/// Returns the lateral acceleration g T/(2 h) [m/s^2] at which a rigid car lifts its inner wheels.
/// T is the track width, h the height of the center of gravity [m]. A car on springs rolls, and
/// lifts its inner wheels at an acceleration that is lower by a tenth or more.
double RollOverAcceleration(double track, double cg_height);

/// Largest demands that a piece of the path makes on the car. A piece is at most 0.05 m long; for a
/// path of more than 20 km, at most 1/400 000 of the path.
struct PathDemand {
  double s = 0.0;                     ///< Station of the start of the piece [m].
  Vec2 position{0.0, 0.0};            ///< Position of the start [m].
  double curvature = 0.0;             ///< Curvature at the start, positive to the left [1/m].
  double curvature_rate = 0.0;        ///< Rate dkappa/ds at the start [1/m^2].
  double steering = 0.0;              ///< Steering angle |delta| [rad].
  double steering_rate = 0.0;         ///< Steering rate at the speed v [rad/s].
  double lateral_acceleration = 0.0;  ///< Lateral acceleration at the speed v [m/s^2].
  // Maximum speed that each limit allows [m/s]; infinite if the limit does not apply.
  double speed_by_steering_rate = 0.0;
  double speed_by_friction = 0.0;
  double speed_by_rollover = 0.0;
  /// The smallest of the maximum speeds by all limits, and of the car's top speed [m/s]; 0 if the
  /// car cannot steer the path.
  double speed = 0.0;
};

struct PathCheck {
  std::vector<PathFault> faults;  ///< Faults along the path; empty if the car can drive the path.
  /// Demands along the path; empty if the path turns back on itself.
  std::vector<PathDemand> demands;
  /// The largest speed at which the whole path can be driven [m/s]; 0 if no speed is possible.
  double max_speed = 0.0;
  double max_speed_station = 0.0;  ///< Station that limits max_speed [m].
  /// Kind of the limit that determines max_speed.
  PathFaultKind max_speed_limit = PathFaultKind::kTopSpeed;
  double steering_limit = 0.0;       ///< Steering angle delta_max [rad].
  double steering_rate_limit = 0.0;  ///< Steering rate omega_delta [rad/s].
  double friction_limit = 0.0;       ///< Limit mu g of v^2 |kappa| [m/s^2]; 0: unknown.
  double rollover_limit = 0.0;       ///< Limit a_r of v^2 |kappa| [m/s^2]; 0: none.

  [[nodiscard]] bool drivable() const { return faults.empty(); }
};

/// Checks a path at a constant speed.
///
/// Guarantees: every fault has a place on the path. A path without faults can be followed exactly
/// by a kinematic car with the given limits, if the car starts on the path with the path's
/// steering. The check ignores obstacles, tyre slip below the limit, braking and accelerating, and
/// controllers that cut corners.
///
/// Errors: PreconditionError unless speed and friction are finite and positive. Cost: 5 us per
/// meter and 100 bytes per piece. The number of pieces exceeds the number of segments by at most
/// 400 000.
PathCheck CheckPath(const FittedPath& fitted, const VehicleParams& vehicle,
                    const PathCheckOptions& options);

}  // namespace trackbed
