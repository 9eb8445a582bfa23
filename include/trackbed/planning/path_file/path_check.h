#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/path/fit_path.h"
#include "trackbed/vehicle/params.h"

/// Whether a car can drive a path at a speed, and how fast it could: without simulation.
///
/// Symbols: v the speed, kappa(s) curvature, delta(s) = atan(L kappa) steering, omega_delta and
/// delta_max the car's steering rate and angle, mu its lateral friction, a_r the lateral
/// acceleration at which it tips over. The car is kinematic: its rear axle follows the path
/// exactly.
namespace trackbed {

enum class PathFaultKind {
  kReversal,       ///< the path turns back on itself, more than kMaxHeadingJump [rad]
  kHeadingJump,    ///< of a polyline [rad]; a car can take none but standing still, and none at all
  kSteeringAngle,  ///< |delta| > delta_max [rad]
  kSteeringRate,   ///< v |d delta/ds| > omega_delta [rad/s]
  kFriction,       ///< v^2 |kappa| > mu g [m/s^2]
  kRollOver,       ///< v^2 |kappa| > a_r [m/s^2]
  kTopSpeed,       ///< v above the car's [m/s]
};

/// "steering_rate", ...: the spelling of files.
const char* ToString(PathFaultKind kind);
/// "rad/s", ...
const char* UnitOf(PathFaultKind kind);

/// A stretch of the path on which the car cannot follow at the speed.
struct PathFault {
  PathFaultKind kind = PathFaultKind::kReversal;
  Stations stations{0.0, 0.0};  ///< the stretch [m]
  double s = 0.0;               ///< where it is worst [m]
  Vec2 position{0.0, 0.0};      ///< there [m]
  double required = 0.0;        ///< there [UnitOf(kind)]
  double limit = 0.0;           ///< likewise
};

/// "steering rate 0.95 rad/s exceeds 0.15 rad/s at s = 42 m, (12.5, 3), on 1.2 m"
std::string ToString(const PathFault& fault);

struct PathCheckOptions {
  double speed = 0.0;                             ///< v [m/s], > 0
  double friction = 1.0;                          ///< of the road, a factor on the tyres' own
  std::optional<double> rollover_acceleration{};  ///< a_r [m/s^2]; none: the car does not tip over
};

/// g T/(2 h) [m/s^2], at which a rigid car of track T and height h of its center of gravity [m]
/// lifts its inner wheels. A car on springs rolls and does so earlier, by a tenth or more.
double RollOverAcceleration(double track, double cg_height);

/// Largest demand of a piece of the path, which is at most 0.05 m long, or 1/400 000 of a path of
/// more than 20 km.
struct PathDemand {
  double s = 0.0;                     ///< of its beginning [m]
  Vec2 position{0.0, 0.0};            ///< there [m]
  double curvature = 0.0;             ///< there, positive to the left [1/m]
  double curvature_rate = 0.0;        ///< dkappa/ds there [1/m^2]
  double steering = 0.0;              ///< |delta| [rad]
  double steering_rate = 0.0;         ///< at v [rad/s]
  double lateral_acceleration = 0.0;  ///< at v [m/s^2]
  // Speeds up to which it can be driven; infinite where nothing limits it [m/s].
  double speed_by_steering_rate = 0.0;
  double speed_by_friction = 0.0;
  double speed_by_rollover = 0.0;
  double speed = 0.0;  ///< the smallest of them and the top speed; 0 where the car cannot steer so
};

struct PathCheck {
  std::vector<PathFault> faults;    ///< along the path; none: it can be driven
  std::vector<PathDemand> demands;  ///< along the path; none where it turns back on itself
  /// The largest speed at which all of it can be driven [m/s]; 0: at none.
  double max_speed = 0.0;
  double max_speed_station = 0.0;                            ///< the place that limits it [m]
  PathFaultKind max_speed_limit = PathFaultKind::kTopSpeed;  ///< and what does there
  double steering_limit = 0.0;                               ///< delta_max [rad]
  double steering_rate_limit = 0.0;                          ///< omega_delta [rad/s]
  double friction_limit = 0.0;                               ///< mu g [m/s^2]; 0: not known
  double rollover_limit = 0.0;                               ///< a_r [m/s^2]; 0: none

  [[nodiscard]] bool drivable() const { return faults.empty(); }
};

/// Checks a path at a constant speed.
///
/// Guarantees: every fault has its place; where there is none, the kinematic car of these limits
/// follows the path exactly if it starts on it with the path's steering. Does not know obstacles,
/// how tyres slip below their limit, braking and accelerating, nor how controllers cut corners.
///
/// Errors: PreconditionError unless speed and friction are finite and positive. Cost: 5 us a meter;
/// 100 bytes a piece, of which a path has at most 400 000 more than segments.
PathCheck CheckPath(const FittedPath& fitted, const VehicleParams& vehicle,
                    const PathCheckOptions& options);

}  // namespace trackbed
