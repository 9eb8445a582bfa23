#pragma once

#include <optional>
#include <vector>

#include "trackbed/vehicle/ggv_diagram.h"

/// The fastest speeds along a path within a car's g-g-v diagram: a forward pass that accelerates as
/// hard as possible, and a backward pass that brakes as late as possible.
///
/// Symbols: s station along the path as seen from above [m], kappa its curvature [1/m], v speed
/// over the ground as seen from above [m/s]; z_s and z_l the slopes of the ground along the path
/// and to its left, z_ss the second derivative of its height along the path [1/m]. With A^2 = 1 +
/// z_s^2, N^2 = A^2 + z_l^2 and G = g + v^2 z_ss, an acceleration a = dv/dt of a point of mass 1
/// needs
///   f_x = A a + z_s G/A,   f_y = (A^2 v^2 kappa + z_l G)/(N A),   f_n = (G - z_l v^2 kappa)/N
/// for its tyres (ggv_diagram.h), in addition to the drag.
///
/// Steady-state: neglects the car's yaw acceleration, slip and steering angles; loads follow the
/// accelerations instantly. There is no wind.
namespace trackbed {

/// The inputs of the limit at a station.
struct LimitStation {
  double s = 0.0;          ///< [m]; rises strictly
  double curvature = 0.0;  ///< kappa [1/m]; the larger one at a jump
  double road = 1.0;       ///< factor on the tyres' friction [1], > 0
  double cap = 0.0;        ///< upper bound on the speed [m/s]; 0: no cap
  double grade = 0.0;      ///< z_s [1]
  double bank = 0.0;       ///< z_l [1]; negative if the bank helps in a left bend
  double crest = 0.0;      ///< z_ss [1/m]; negative on a crest, positive in a dip
};

struct LimitOptions {
  double share = 1.0;  ///< usable fraction of the forces of tyres, motor and brakes, in (0, 1]
  double jerk = 0.0;   ///< largest |da/dt| [m/s^3]; 0: not limited
  double speed = 0.0;  ///< largest speed [m/s]; 0: the car's, which must then be known
};

/// A place at which the car exceeds the limit because it arrives too fast.
struct LimitExcess {
  double s = 0.0;        ///< [m]
  double speed = 0.0;    ///< at arrival, braking as hard as possible [m/s]
  double allowed = 0.0;  ///< [m/s]
};

/// Speeds at the stations, with v^2 linear in between, and the time that they take.
struct LimitSpeeds {
  std::vector<double> speeds;         ///< [m/s], one for each station
  double time = 0.0;                  ///< from the first station to the last, or of a lap [s]
  std::optional<LimitExcess> excess;  ///< the first excess, if any
};

/// The speeds of a car that begins with `start_speed` and has at most `end_speed` at the last
/// station (0 to stop there).
///
/// Guarantees: accelerations and speeds stay within `share` of the diagram at both ends of each
/// interval, to 0.002 m/s^2, and no speed except the first can be raised. Longer intervals cost a
/// little time, because the smaller acceleration of their ends applies. An interval in which drag
/// or a slope exceeds the motor is driven at full force. With a jerk limit, the second differences
/// of v^2 meet it exactly and the accelerations meet the diagram to 0.1 m/s^2. A start above the
/// diagram slows down at its maximum braking, without a jerk limit; a jump of the acceleration at
/// the first station is allowed.
///
/// Does not check whether the car can steer at these speeds: set caps. PreconditionError for
/// numbers that are not finite, fewer than two stations, or stations that do not rise. Cost: 1 to 2
/// us per station, half as much again with a jerk limit.
LimitSpeeds LimitSpeedsAlong(const std::vector<LimitStation>& stations, const GgvDiagram& diagram,
                             const LimitOptions& options, double start_speed, double end_speed);

/// As LimitSpeedsAlong, for a closed path of `length` [m], beyond the last station: the speed after
/// a lap equals that at its start. Cost: half as much again.
LimitSpeeds LimitSpeedsAround(const std::vector<LimitStation>& stations, double length,
                              const GgvDiagram& diagram, const LimitOptions& options);

}  // namespace trackbed
