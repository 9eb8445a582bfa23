#pragma once

#include <limits>
#include <vector>

#include "trackbed/options/key_visitor.h"

/// The options for planning motions in the Frenet frame (frenet.h and lattice.h, which also define
/// the symbols).
namespace trackbed {

struct FrenetWeights {
  double k_dj = 0.1;   ///< Weight of lateral jerk [s^5/m^2].
  double k_d = 1.0;    ///< Weight of the offset at the end [1/m^2].
  double k_dt = 0.1;   ///< Weight of time in C_d [1/s].
  double k_sj = 0.1;   ///< Weight of longitudinal jerk [s^5/m^2].
  double k_s = 1.0;    ///< Weight of the error of the end station [1/m^2].
  double k_v = 1.0;    ///< Weight of the error of the end speed [s^2/m^2].
  double k_st = 0.1;   ///< Weight of time in C_s [1/s].
  double k_lat = 1.0;  ///< Weight of the lateral cost C_d.
  double k_lon = 1.0;  ///< Weight of the longitudinal cost C_s.
  /// Order of the derivative in the cost integrals. Order 3 is the jerk; order 2 is the
  /// acceleration, as in the Frenet lecture.
  int derivative_order = 3;
};
void Visit(KeyVisitor& keys, FrenetWeights& weights);

/// Limits on a motion. If the start already violates a limit, or is closer to an obstacle than the
/// safe distance, the motion may violate that limit as much as the start does, but no more.
struct FrenetLimits {
  double safe_distance = 0.5;  ///< Distance from the car's footprint to every obstacle [m], >= 0.
  /// Fraction by which v may exceed the speed limit: a car that keeps its speed along the path is
  /// faster while it moves sideways.
  double speed_tolerance = 0.05;
  double max_lateral_acceleration = 3.0;  ///< Largest v^2 |kappa| [m/s^2].
  /// Largest steering rate, as a fraction of the car's limit.
  double max_steering_rate_fraction = 1.0;
  double time_step = 0.2;  ///< Time step of the first check of a motion [s], > 0.
  double spacing = 0.1;    ///< Spacing of the points in the last check and in the result [m], > 0.
};

/// Width of the road on either side of the reference path [m], for the car's footprint.
struct RoadWidths {
  double left = std::numeric_limits<double>::infinity();
  double right = std::numeric_limits<double>::infinity();
};

/// The variable of which the offset d is a function. If d is a function of time, the car must move.
/// If d is a function of the station, the car may also start or stop.
enum class LateralMotion {
  /// The offset is a function of the station if the motion begins or ends slower than `low_speed`,
  /// else of time.
  kAuto,
  kOverTime,
  kOverStation,
};

/// Options of PlanFrenet, including the end states to try. Each duration is combined with each
/// offset, and with each speed factor (KeepSpeed) or each station offset (FollowLeader, StopAt).
struct FrenetOptions {
  FrenetWeights weights;
  FrenetLimits limits;
  std::vector<double> end_times{2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0};  ///< Durations T [s], > 0.
  /// Final offsets d(T) [m].
  std::vector<double> end_offsets{0.0,  0.5, -0.5, 1.0, -1.0, 1.5, -1.5, 2.0,
                                  -2.0, 2.5, -2.5, 3.0, -3.0, 3.5, -3.5};
  /// Final speeds, as factors s_t(T)/V_1, >= 0.
  std::vector<double> speed_factors{1.0, 0.9, 0.75, 0.5, 0.25};
  /// Final station errors s(T) - S_1 [m].
  std::vector<double> station_offsets{0.0, -0.5, -1.0, -2.0, -4.0};
  LateralMotion lateral = LateralMotion::kAuto;
  double low_speed = 2.0;  ///< Speed below which kAuto makes d a function of the station [m/s].
  /// Time for which a motion must stay clear of obstacles [s]. After its end, the motion continues
  /// at its final offset and speed. Without a horizon, cheap short motions would approach obstacles
  /// until it is too late for longer motions.
  double horizon = 8.0;
  int budget = 10000;  ///< Maximum number of candidates to check, >= 0.
};
void Visit(KeyVisitor& keys, FrenetOptions& options);

struct LatticeOptions {
  FrenetWeights weights;
  FrenetLimits limits;
  int layers = 4;         ///< Number of layers, >= 0.
  double spacing = 12.0;  ///< Distance between layers [m], > 0.
  /// Offsets d_k of the nodes [m].
  std::vector<double> end_offsets{0.0, 0.5,  -0.5, 1.0,  -1.0, 1.5, -1.5,
                                  2.0, -2.0, 2.5,  -2.5, 3.0,  -3.0};
  /// Speeds v_m of the nodes, relative to the goal's speed. For the goal StopAt, the speeds are
  /// relative to the speed of the limits.
  std::vector<double> speed_factors{1.0, 0.75, 0.5};
  int budget = 100000;  ///< Maximum number of edges to check, >= 0.
};
void Visit(KeyVisitor& keys, LatticeOptions& options);

}  // namespace trackbed
