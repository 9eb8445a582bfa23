#pragma once

#include <optional>
#include <vector>

#include "trackbed/vehicle/ggv_diagram.h"

/// Computes the fastest speeds along a path within a car's g-g-v diagram. A forward pass
/// accelerates as hard as possible, and a backward pass brakes as late as possible.
///
/// Symbols: s station along the path as seen from above [m], kappa its curvature [1/m], v speed
/// over the ground as seen from above [m/s]; z_s and z_l the slopes of the ground along the path
/// and to its left, z_ss the second derivative of its height along the path [1/m]. A^2 = 1 + z_s^2,
/// N^2 = A^2 + z_l^2 and G = g + v^2 z_ss. For an acceleration a = dv/dt, a point mass of 1 kg
/// needs
///   f_x = A a + z_s G/A,   f_y = (A^2 v^2 kappa + z_l G)/(N A),   f_n = (G - z_l v^2 kappa)/N
/// as tyre forces (ggv_diagram.h), in addition to the drag.
///
/// The model is steady-state: it neglects the car's yaw acceleration, slip and steering angles.
/// Wheel loads follow the accelerations instantly. The model has no wind.
namespace trackbed {

/// The quantities that limit the speed at a station of the path.
struct LimitStation {
  double s = 0.0;          ///< Station [m], strictly increasing.
  double curvature = 0.0;  ///< Curvature kappa [1/m]; where kappa jumps, the larger value.
  double road = 1.0;       ///< Factor on the tyres' friction [1], > 0.
  double cap = 0.0;        ///< Upper bound on the speed [m/s]; 0: no cap.
  double grade = 0.0;      ///< Slope z_s along the path [1].
  double bank = 0.0;   ///< Slope z_l to the left [1]; negative if the bank helps in a left bend.
  double crest = 0.0;  ///< Second derivative z_ss [1/m]; negative on a crest, positive in a dip.
};

struct LimitOptions {
  double share = 1.0;  ///< Usable fraction of the forces of tyres, motor and brakes, in (0, 1].
  double jerk = 0.0;   ///< Largest |da/dt| [m/s^3]; 0: not limited.
  /// Largest speed [m/s]. With 0, the car's top speed applies, which must then be known.
  double speed = 0.0;
};

/// A place at which the car arrives too fast for the limit.
struct LimitExcess {
  double s = 0.0;        ///< Station [m].
  double speed = 0.0;    ///< Speed on arrival after the hardest braking [m/s].
  double allowed = 0.0;  ///< Allowed speed [m/s].
};

/// Speeds at the stations of a path, and the driving time. Between stations, v^2 is linear.
struct LimitSpeeds {
  std::vector<double> speeds;  ///< Speeds [m/s], one for each station.
  double time = 0.0;           ///< Time from the first station to the last, or of a lap [s].
  /// The first place at which the car arrives too fast, if any.
  std::optional<LimitExcess> excess;
};

/// Computes the highest speeds of a car that starts with `start_speed` [m/s] and has at most
/// `end_speed` [m/s] at the last station. With an `end_speed` of 0, the car stops at the last
/// station.
///
/// Guarantees: at both ends of each interval between stations, accelerations and speeds stay within
/// the fraction `share` of the g-g-v diagram, to 0.002 m/s^2. Except at the first station, no
/// higher speed is possible. Longer intervals make the profile slightly slower, because the smaller
/// acceleration of the two ends applies to the whole interval. The car drives at full force in an
/// interval in which drag or a slope exceeds the motor's force. With a jerk limit, the second
/// differences of v^2 meet the limit exactly, and the accelerations meet the diagram to 0.1 m/s^2.
/// A car that starts faster than the diagram allows brakes as hard as possible, without a jerk
/// limit. The acceleration may jump at the first station.
///
/// The function does not check whether the car can steer fast enough at these speeds;
/// LimitStation::cap can ensure that. Throws PreconditionError for numbers that are not finite,
/// fewer than two stations, or stations that do not increase. Cost: 1 to 2 us per station, 50 %
/// more with a jerk limit.
LimitSpeeds LimitSpeedsAlong(const std::vector<LimitStation>& stations, const GgvDiagram& diagram,
                             const LimitOptions& options, double start_speed, double end_speed);

/// Same as LimitSpeedsAlong, but for laps of a closed path. The `length` [m] of the path must
/// exceed the last station. The speed at the end of a lap equals the speed at its start. Cost: 50 %
/// more than LimitSpeedsAlong.
LimitSpeeds LimitSpeedsAround(const std::vector<LimitStation>& stations, double length,
                              const GgvDiagram& diagram, const LimitOptions& options);

}  // namespace trackbed
