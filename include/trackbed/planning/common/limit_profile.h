#pragma once

#include <optional>
#include <vector>

#include "trackbed/vehicle/ggv_diagram.h"

/// The fastest speeds along a path that a car's g-g-v diagram allows: a pass forward, which
/// accelerates as hard as possible, and one backward, which brakes as late as possible.
///
/// Symbols: s station along the path as seen from above [m], kappa its curvature [1/m], v speed
/// over the ground as seen from above [m/s]; z_s and z_l the slopes of the ground along the path
/// and to its left, z_ss the second derivative of its height along the path [1/m]. With A^2 = 1 +
/// z_s^2, N^2 = A^2 + z_l^2 and G = g + v^2 z_ss, an acceleration a = dv/dt of a point of mass 1
/// needs
///   f_x = A a + z_s G/A,   f_y = (A^2 v^2 kappa + z_l G)/(N A),   f_n = (G - z_l v^2 kappa)/N
/// of its tyres (ggv_diagram.h), besides the drag.
///
/// Steady-state: the car's yaw acceleration, the slip and the steering angles are neglected, and
/// loads follow the accelerations at once. The air is still.
namespace trackbed {

/// What the limit depends on at a station.
struct LimitStation {
  double s = 0.0;          ///< [m]; rises strictly
  double curvature = 0.0;  ///< kappa [1/m]; where it jumps, the larger one
  double road = 1.0;       ///< factor on the tyres' friction [1], > 0
  double cap = 0.0;        ///< the speed must not be higher [m/s]; 0: no cap
  double grade = 0.0;      ///< z_s [1]
  double bank = 0.0;       ///< z_l [1]; a bank that helps in a left bend is negative
  double crest = 0.0;      ///< z_ss [1/m]; negative on a crest, positive in a dip
};

struct LimitOptions {
  double share = 1.0;  ///< of the forces of tyres, motor and brakes, above 0, at most 1
  double jerk = 0.0;   ///< largest |da/dt| [m/s^3]; 0: not limited
  double speed = 0.0;  ///< largest speed [m/s]; 0: the car's, which must have one then
};

/// A place where the car cannot keep within the limit, because it comes too fast.
struct LimitExcess {
  double s = 0.0;        ///< [m]
  double speed = 0.0;    ///< with which it gets there, braking as hard as it can [m/s]
  double allowed = 0.0;  ///< [m/s]
};

/// Speeds at the stations, v^2 linear in between, and their time.
struct LimitSpeeds {
  std::vector<double> speeds;         ///< [m/s], one for each station
  double time = 0.0;                  ///< from the first station to the last, or of a lap [s]
  std::optional<LimitExcess> excess;  ///< the first place, if there is one
};

/// The speeds of a car that begins with `start_speed` and is no faster than `end_speed` at the last
/// station; 0 to stop there.
///
/// Guarantees: accelerations and speeds keep within `share` of the diagram at both ends of each
/// interval, to 0.002 m/s^2, and no speed but the first can be raised; longer intervals cost a
/// little time, because the smaller acceleration of their ends counts. An interval in which drag or
/// a slope is stronger than the motor is driven with full force. With a jerk limit the second
/// differences of v^2 keep it exactly and the accelerations the diagram to 0.1 m/s^2. A start from
/// above the diagram comes down braking as hard as it allows, without a jerk limit; a jump of the
/// acceleration at the first station does not count.
///
/// Does not check whether the car can steer so fast: give caps. PreconditionError for numbers that
/// are not finite, fewer than two stations, or stations that do not rise. Cost: 1 to 2 us a
/// station, half as much again with a jerk limit.
LimitSpeeds LimitSpeedsAlong(const std::vector<LimitStation>& stations, const GgvDiagram& diagram,
                             const LimitOptions& options, double start_speed, double end_speed);

/// The same of a closed path of `length` [m], above the last station: the speed after a lap is that
/// at its start. Cost: half as much again.
LimitSpeeds LimitSpeedsAround(const std::vector<LimitStation>& stations, double length,
                              const GgvDiagram& diagram, const LimitOptions& options);

}  // namespace trackbed
