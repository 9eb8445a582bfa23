#pragma once

#include <limits>
#include <vector>

#include "trackbed/options/key_visitor.h"

/// The options of motions in the Frenet frame (frenet.h and lattice.h, which also define the
/// symbols).
namespace trackbed {

struct FrenetWeights {
  double k_dj = 0.1;   ///< of lateral jerk [s^5/m^2]
  double k_d = 1.0;    ///< of the offset at the end [1/m^2]
  double k_dt = 0.1;   ///< of time [1/s]
  double k_sj = 0.1;   ///< of longitudinal jerk [s^5/m^2]
  double k_s = 1.0;    ///< of the error of the end station [1/m^2]
  double k_v = 1.0;    ///< of the error of the end speed [s^2/m^2]
  double k_st = 0.1;   ///< of time [1/s]
  double k_lat = 1.0;  ///< of C_d
  double k_lon = 1.0;  ///< of C_s
  /// Order of the derivative in the integrals: 3 is jerk; 2 is acceleration, as in the Frenet
  /// lecture.
  int derivative_order = 3;
};
void Visit(KeyVisitor& keys, FrenetWeights& weights);

/// Limits on a motion. If the start already violates a limit, or is closer to an obstacle than the
/// safe distance, the motion may violate it as much as the start does, but no more.
struct FrenetLimits {
  double safe_distance = 0.5;  ///< from the car's footprint to every obstacle [m], >= 0
  /// Fraction by which v may exceed the speed limit: a car that keeps its speed along the path is
  /// faster while it moves sideways.
  double speed_tolerance = 0.05;
  double max_lateral_acceleration = 3.0;    ///< v^2 |kappa| [m/s^2]
  double max_steering_rate_fraction = 1.0;  ///< of the car's steering rate
  double time_step = 0.2;                   ///< of the first check [s], > 0
  double spacing = 0.1;  ///< of the last check and of the result's points [m], > 0
};

/// Width of the road on either side of the reference path [m], for the car's footprint.
struct RoadWidths {
  double left = std::numeric_limits<double>::infinity();
  double right = std::numeric_limits<double>::infinity();
};

/// How d varies: over time, which needs motion, or over the station, for a car that starts or
/// stops.
enum class LateralMotion {
  kAuto,  ///< over the station if the motion begins or ends below `low_speed`
  kOverTime,
  kOverStation,
};

/// The end states to try: each duration with each offset, and each speed factor (KeepSpeed) or each
/// station offset (FollowLeader, StopAt).
struct FrenetOptions {
  FrenetWeights weights;
  FrenetLimits limits;
  std::vector<double> end_times{2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0};  ///< T [s], > 0
  /// d(T) [m].
  std::vector<double> end_offsets{0.0,  0.5, -0.5, 1.0, -1.0, 1.5, -1.5, 2.0,
                                  -2.0, 2.5, -2.5, 3.0, -3.0, 3.5, -3.5};
  std::vector<double> speed_factors{1.0, 0.9, 0.75, 0.5, 0.25};      ///< s_t(T)/V_1, >= 0
  std::vector<double> station_offsets{0.0, -0.5, -1.0, -2.0, -4.0};  ///< s(T) - S_1 [m]
  LateralMotion lateral = LateralMotion::kAuto;
  double low_speed = 2.0;  ///< [m/s]
  /// Time for which a motion must stay clear, continued at its final offset and speed [s]. Without
  /// it, short motions, which are cheap, approach obstacles until it is too late for longer ones.
  double horizon = 8.0;
  int budget = 10000;  ///< maximum number of candidates to check, >= 0
};
void Visit(KeyVisitor& keys, FrenetOptions& options);

struct LatticeOptions {
  FrenetWeights weights;
  FrenetLimits limits;
  int layers = 4;         ///< >= 0
  double spacing = 12.0;  ///< between layers [m], > 0
  /// d_k [m].
  std::vector<double> end_offsets{0.0, 0.5,  -0.5, 1.0,  -1.0, 1.5, -1.5,
                                  2.0, -2.0, 2.5,  -2.5, 3.0,  -3.0};
  /// v_m over the goal's speed; if the goal is to stop, over the limits' speed.
  std::vector<double> speed_factors{1.0, 0.75, 0.5};
  int budget = 100000;  ///< maximum number of edges to check, >= 0
};
void Visit(KeyVisitor& keys, LatticeOptions& options);

}  // namespace trackbed
