#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/path/fit_path.h"
#include "trackbed/vehicle/params.h"

/// Checks, without simulation, whether a car can drive a path at a given speed, and how fast the
/// car can drive the path.
///
/// Symbols: v is the speed, kappa(s) the curvature of the path, delta(s) = atan(L kappa) the
/// steering angle, omega_delta and delta_max the limits of the car's steering rate and steering
/// angle, mu the lateral friction coefficient, and a_r the lateral acceleration at which the car
/// tips over. The checked car is kinematic: its rear axle follows the path exactly.
namespace trackbed {

enum class PathFaultKind {
  kReversal,  ///< The path turns back on itself by more than kMaxHeadingJump [rad].
  /// The heading of a polyline jumps at a corner [rad]. No car can follow a corner without
  /// stopping; the planner `path_file` rejects paths with corners.
  kHeadingJump,
  kSteeringAngle,  ///< The steering angle exceeds its limit: |delta| > delta_max [rad].
  kSteeringRate,   ///< The steering rate exceeds its limit: v |d delta/ds| > omega_delta [rad/s].
  kFriction,  ///< The lateral acceleration exceeds the tyres' friction: v^2 |kappa| > mu g [m/s^2].
  kRollOver,  ///< The car tips over: the lateral acceleration v^2 |kappa| exceeds a_r [m/s^2].
  kTopSpeed,  ///< The speed v exceeds the car's top speed [m/s].
};

/// Returns the name of a kind of fault as written in files: "steering_rate", ...
const char* ToString(PathFaultKind kind);
/// Returns the unit of the values of a kind of fault: "rad/s", ...
const char* UnitOf(PathFaultKind kind);

/// A stretch of the path that the car cannot follow at the given speed.
struct PathFault {
  PathFaultKind kind = PathFaultKind::kReversal;
  Stations stations{0.0, 0.0};  ///< Stations between which the car cannot follow the path [m].
  double s = 0.0;               ///< Station of the worst violation [m].
  Vec2 position{0.0, 0.0};      ///< Position of the worst violation [m].
  /// Value that the path requires of the car at the worst violation [UnitOf(kind)].
  double required = 0.0;
  double limit = 0.0;  ///< Limit that the required value exceeds [UnitOf(kind)].
};

/// Formats a fault, for example "steering rate 0.95 rad/s exceeds 0.15 rad/s at s = 42 m, (12.5,
/// 3), on 1.2 m".
std::string ToString(const PathFault& fault);

struct PathCheckOptions {
  double speed = 0.0;     ///< Constant speed v of the car [m/s], > 0.
  double friction = 1.0;  ///< Friction of the road, as a factor on the tyres' friction coefficient.
  /// Lateral acceleration a_r at which the car tips over [m/s^2]; none: the car never tips over.
  std::optional<double> rollover_acceleration{};
};

/// Returns the lateral acceleration g T/(2 h) [m/s^2] at which a rigid car lifts its inner wheels,
/// with the track width T and the height h of the center of gravity [m]. A car with springs rolls,
/// and therefore lifts its inner wheels at a lateral acceleration that is lower than that of a
/// rigid car by a tenth or more.
double RollOverAcceleration(double track, double cg_height);

/// Largest steering angle, steering rate and lateral acceleration that a piece of the path
/// requires. Pieces of the checked path are at most 0.05 m long, or at most 1/400 000 of the path
/// if the path is longer than 20 km.
struct PathDemand {
  double s = 0.0;           ///< Station at the start of the path piece [m].
  Vec2 position{0.0, 0.0};  ///< Position at the start of the path piece [m].
  /// Curvature at the start of the path piece, positive to the left [1/m].
  double curvature = 0.0;
  /// Change of curvature dkappa/ds at the start of the path piece [1/m^2].
  double curvature_rate = 0.0;
  double steering = 0.0;       ///< Largest steering angle |delta| on the path piece [rad].
  double steering_rate = 0.0;  ///< Largest steering rate on the path piece at the speed v [rad/s].
  /// Largest lateral acceleration on the path piece at the speed v [m/s^2].
  double lateral_acceleration = 0.0;
  // Maximum speeds that the single limits allow on the path piece [m/s]; infinite where a limit
  // does not apply.
  double speed_by_steering_rate = 0.0;
  double speed_by_friction = 0.0;
  double speed_by_rollover = 0.0;
  /// Maximum speed that all limits and the car's top speed allow on the path piece [m/s]; 0 if the
  /// car cannot steer the path.
  double speed = 0.0;
};

struct PathCheck {
  std::vector<PathFault> faults;  ///< Faults along the path; empty if the car can drive the path.
  /// Demands on the car in all pieces of the path; empty if the path turns back on itself.
  std::vector<PathDemand> demands;
  /// Largest constant speed at which the car can drive the whole path [m/s]; 0 if no speed is
  /// possible.
  double max_speed = 0.0;
  /// Station of the place that limits the largest constant speed [m].
  double max_speed_station = 0.0;
  /// Kind of the limit that determines the largest constant speed.
  PathFaultKind max_speed_limit = PathFaultKind::kTopSpeed;
  double steering_limit = 0.0;       ///< The car's largest steering angle delta_max [rad].
  double steering_rate_limit = 0.0;  ///< The car's largest steering rate omega_delta [rad/s].
  /// Limit mu g of the lateral acceleration v^2 |kappa| by friction [m/s^2]; 0: unknown.
  double friction_limit = 0.0;
  /// Limit a_r of the lateral acceleration v^2 |kappa| by tipping over [m/s^2]; 0: no limit.
  double rollover_limit = 0.0;

  [[nodiscard]] bool drivable() const { return faults.empty(); }
};

/// Checks whether a car can drive a path at a constant speed.
///
/// Guarantees: every reported fault has a place on the path. If there are no faults, a kinematic
/// car with the given limits can follow the path exactly. The car must start on the path with the
/// steering angle of the path. The check does not consider obstacles, tyre slip below the friction
/// limit, braking and accelerating, or controllers that cut corners.
///
/// Throws PreconditionError unless speed and friction are finite and positive. Cost: 5 us of
/// computing time per meter of path, and 100 bytes of memory per piece. The number of pieces
/// exceeds the number of path segments by at most 400 000.
PathCheck CheckPath(const FittedPath& fitted, const VehicleParams& vehicle,
                    const PathCheckOptions& options);

}  // namespace trackbed
