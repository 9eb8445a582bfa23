#pragma once

#include <limits>
#include <vector>

#include "trackbed/options/key_visitor.h"

/// The options of motions in the Frenet frame (frenet.h and lattice.h, with their symbols).
namespace trackbed {

struct FrenetWeights {
  double k_dj = 0.1;   ///< of lateral jerk [s^5/m^2]
  double k_d = 1.0;    ///< of the offset at the end [1/m^2]
  double k_dt = 0.1;   ///< of time [1/s]
  double k_sj = 0.1;   ///< of longitudinal jerk [s^5/m^2]
  double k_s = 1.0;    ///< of the station missed [1/m^2]
  double k_v = 1.0;    ///< of the speed missed [s^2/m^2]
  double k_st = 0.1;   ///< of time [1/s]
  double k_lat = 1.0;  ///< of C_d
  double k_lon = 1.0;  ///< of C_s
  /// Of the integrals: 3 is jerk; 2 is acceleration, as the Frenet lecture has it.
  int derivative_order = 3;
};
void Visit(KeyVisitor& keys, FrenetWeights& weights);

/// What a motion must keep to. Where the start breaks one of these already, or is closer to an
/// obstacle than the safe distance, the motion may do so as far as the start does, and no further.
struct FrenetLimits {
  double safe_distance = 0.5;  ///< from the car's footprint to every obstacle [m], >= 0
  /// Of the speed limit, that v may be above it: a car that keeps its speed along the path is
  /// faster than that as it moves aside.
  double speed_tolerance = 0.05;
  double max_lateral_acceleration = 3.0;    ///< v^2 |kappa| [m/s^2]
  double max_steering_rate_fraction = 1.0;  ///< of the car's steering rate
  double time_step = 0.2;                   ///< between the points of the first check [s], > 0
  double spacing = 0.1;  ///< between those of the last one, the result's [m], > 0
};

/// How far the road reaches from the reference path to either side [m], for the car's footprint.
struct RoadWidths {
  double left = std::numeric_limits<double>::infinity();
  double right = std::numeric_limits<double>::infinity();
};

/// How d moves: over time, which needs motion, or over the station, for a car that starts or stops.
enum class LateralMotion {
  kAuto,  ///< over the station when the motion begins or ends below `low_speed`
  kOverTime,
  kOverStation,
};

/// The ends that are tried: each duration with each offset, and each speed factor (KeepSpeed) or
/// each station offset (FollowLeader, StopAt).
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
  /// Up to when a motion must stay clear if it goes on at its end's offset and speed [s]; else
  /// short motions, which are cheap, lead up to obstacles until it is too late for long ones.
  double horizon = 8.0;
  int budget = 10000;  ///< candidates checked at most, >= 0
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
  /// v_m over the goal's speed, that of the limits when it stops.
  std::vector<double> speed_factors{1.0, 0.75, 0.5};
  int budget = 100000;  ///< edges checked at most, >= 0
};
void Visit(KeyVisitor& keys, LatticeOptions& options);

}  // namespace trackbed
