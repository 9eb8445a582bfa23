#pragma once

#include <optional>
#include <vector>

#include "trackbed/vehicle/ggv_diagram.h"

/// Computes the fastest speeds along a path within a car's g-g-v diagram. A forward pass
/// accelerates as hard as possible, and a backward pass brakes as late as possible.
///
/// Symbols: s is the station along the path as seen from above [m], kappa the curvature of the path
/// [1/m], and v the speed as seen from above [m/s]. The ground has the slope z_s along the path,
/// the slope z_l to the left of the path, and the second derivative of height z_ss along the path
/// [1/m]. Abbreviations: A^2 = 1 + z_s^2, N^2 = A^2 + z_l^2 and G = g + v^2 z_ss. For an
/// acceleration a = dv/dt, with these symbols and abbreviations, a point mass of 1 kg needs
///   f_x = A a + z_s G/A,   f_y = (A^2 v^2 kappa + z_l G)/(N A),   f_n = (G - z_l v^2 kappa)/N
/// as tyre forces (ggv_diagram.h), in addition to the drag.
///
/// The speed model is steady-state: it neglects the car's yaw acceleration, slip and steering
/// angles. The speed model assumes that wheel loads follow the accelerations instantly, and that
/// there is no wind.
namespace trackbed {

/// The quantities that limit the car's speed at a station of the path.
struct LimitStation {
  double s = 0.0;  ///< Station on the path [m]; the stations of a path must increase strictly.
  /// Curvature kappa of the path [1/m]; where kappa jumps, the larger value.
  double curvature = 0.0;
  double road = 1.0;   ///< Friction of the road, as a factor on the tyres' friction [1], > 0.
  double cap = 0.0;    ///< Upper bound of the car's speed [m/s]; 0: no bound.
  double grade = 0.0;  ///< Slope z_s of the ground along the path [1].
  /// Slope z_l of the ground to the left [1]; negative if the bank helps in a left bend.
  double bank = 0.0;
  /// Second derivative z_ss of the ground's height [1/m]; negative on a crest, positive in a dip.
  double crest = 0.0;
};

struct LimitOptions {
  double share = 1.0;  ///< Usable fraction of the forces of tyres, motor and brakes, in (0, 1].
  double jerk = 0.0;   ///< Largest jerk |da/dt| of the car [m/s^3]; 0: not limited.
  /// Largest speed of the car [m/s]. If `speed` is 0, the car's top speed applies, and must be
  /// known.
  double speed = 0.0;
};

/// A place at which the car cannot brake in time, and arrives faster than its limit allows.
struct LimitExcess {
  double s = 0.0;        ///< Station at which the car is too fast [m].
  double speed = 0.0;    ///< Speed at which the car arrives after the hardest braking [m/s].
  double allowed = 0.0;  ///< Speed that the limit allows at the station [m/s].
};

/// Speeds at the stations of a path, and the driving time. Between stations, the squared speed v^2
/// is linear in the station.
struct LimitSpeeds {
  std::vector<double> speeds;  ///< Speeds of the car [m/s], one for each station.
  double time = 0.0;  ///< Driving time from the first station to the last, or for a whole lap [s].
  /// The first place at which the car arrives too fast, if there is such a place.
  std::optional<LimitExcess> excess;
};

/// Computes the highest speeds along a path for a car that starts with `start_speed` [m/s] and has
/// at most `end_speed` [m/s] at the last station. With an `end_speed` of 0, the car stops at the
/// last station.
///
/// Guarantees: at both ends of each interval between stations, accelerations and speeds stay within
/// the fraction `share` of the g-g-v diagram, with a tolerance of 0.002 m/s^2. No higher speed is
/// possible at any station except the first. Longer intervals between stations make the result
/// slightly slower, because the smaller one of the accelerations at both ends applies to the whole
/// interval. The car drives at full force in an interval in which drag or a slope exceeds the
/// motor's force. The second differences of v^2 meet a jerk limit exactly, and the accelerations
/// meet the g-g-v diagram with a tolerance of 0.1 m/s^2. A car that starts faster than the g-g-v
/// diagram allows brakes as hard as possible, without a jerk limit. At the first station, the
/// acceleration may jump.
///
/// LimitSpeedsAlong does not check whether the car can steer fast enough at the resulting speeds;
/// speed caps (LimitStation::cap) can ensure that. Throws PreconditionError if a number is not
/// finite, if there are fewer than two stations, or if the stations do not increase. Computing
/// time: 1 to 2 us per station, 50 % more with a jerk limit.
LimitSpeeds LimitSpeedsAlong(const std::vector<LimitStation>& stations, const GgvDiagram& diagram,
                             const LimitOptions& options, double start_speed, double end_speed);

/// Same as LimitSpeedsAlong, but for laps of a closed path. The `length` of the closed path [m]
/// must exceed the last station. The speed at the end of a lap equals the speed at its start.
/// Computing time: 50 % more than LimitSpeedsAlong.
LimitSpeeds LimitSpeedsAround(const std::vector<LimitStation>& stations, double length,
                              const GgvDiagram& diagram, const LimitOptions& options);

}  // namespace trackbed
