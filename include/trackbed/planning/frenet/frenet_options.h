#pragma once

#include <limits>
#include <vector>

#include "trackbed/options/key_visitor.h"

/// The options for planning motions in the Frenet frame; frenet.h and lattice.h define the symbols.
namespace trackbed {

struct FrenetWeights {
  double k_dj = 0.1;   ///< Weight K_dj of the lateral jerk [s^5/m^2].
  double k_d = 1.0;    ///< Weight K_d of the offset at the end of a motion [1/m^2].
  double k_dt = 0.1;   ///< Weight K_dt of the duration in the lateral cost C_d [1/s].
  double k_sj = 0.1;   ///< Weight K_sj of the longitudinal jerk [s^5/m^2].
  double k_s = 1.0;    ///< Weight K_s of the error of the end station [1/m^2].
  double k_v = 1.0;    ///< Weight K_v of the error of the end speed [s^2/m^2].
  double k_st = 0.1;   ///< Weight K_st of the duration in the longitudinal cost C_s [1/s].
  double k_lat = 1.0;  ///< Weight K_lat of the lateral cost C_d.
  double k_lon = 1.0;  ///< Weight K_lon of the longitudinal cost C_s.
  /// Order of the derivatives whose squares the cost integrates. With order 3, the cost integrates
  /// the squared jerk; with order 2, the squared acceleration, as in the Frenet lecture.
  int derivative_order = 3;
};
void Visit(KeyVisitor& keys, FrenetWeights& weights);

/// Limits that every planned motion must meet. If the start state already violates a limit or the
/// safe distance, the motion may violate this limit as much as the start state does, but no more.
struct FrenetLimits {
  /// Smallest distance from the car's footprint to any obstacle [m], >= 0.
  double safe_distance = 0.5;
  /// Fraction by which the car's speed may exceed the speed limit, because a car that keeps its
  /// speed along the path is faster while it also moves sideways.
  double speed_tolerance = 0.05;
  double max_lateral_acceleration = 3.0;  ///< Largest lateral acceleration v^2 |kappa| [m/s^2].
  /// Largest steering rate, as a fraction of the car's limit.
  double max_steering_rate_fraction = 1.0;
  double time_step = 0.2;  ///< Time step of the first, coarse check of a motion [s], > 0.
  /// Spacing of the points in the final check and in the resulting motion [m], > 0.
  double spacing = 0.1;
};

/// Width of the road on either side of the reference path [m]; the car's footprint must stay on the
/// road.
struct RoadWidths {
  double left = std::numeric_limits<double>::infinity();
  double right = std::numeric_limits<double>::infinity();
};

/// The variable on which the offset d depends: time or station. If the offset d is a function of
/// time, the car must move during the whole motion. If the offset d is a function of the station,
/// the car may also start or stop.
enum class LateralMotion {
  /// The offset is a function of the station if the motion begins or ends slower than `low_speed`,
  /// else a function of time.
  kAuto,
  kOverTime,
  kOverStation,
};

/// Options of PlanFrenet, including the end states to try. For its candidate motions, the planner
/// combines each duration with each end offset, and with each speed factor (KeepSpeed) or each
/// station offset (FollowLeader, StopAt).
struct FrenetOptions {
  FrenetWeights weights;
  FrenetLimits limits;
  /// Durations T of the candidate motions [s], > 0.
  std::vector<double> end_times{2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0};
  /// Offsets d(T) at the end of the candidate motions [m].
  std::vector<double> end_offsets{0.0,  0.5, -0.5, 1.0, -1.0, 1.5, -1.5, 2.0,
                                  -2.0, 2.5, -2.5, 3.0, -3.0, 3.5, -3.5};
  /// Speeds at the end of the candidate motions, as fractions s_t(T)/V_1 of the desired speed V_1,
  /// >= 0.
  std::vector<double> speed_factors{1.0, 0.9, 0.75, 0.5, 0.25};
  /// Errors s(T) - S_1 from the desired station S_1 at the end of the candidate motions [m].
  std::vector<double> station_offsets{0.0, -0.5, -1.0, -2.0, -4.0};
  LateralMotion lateral = LateralMotion::kAuto;
  /// Speed below which LateralMotion::kAuto makes d a function of the station [m/s].
  double low_speed = 2.0;
  /// Time for which a motion must stay clear of obstacles [s]. After the end of a shorter motion,
  /// the car is assumed to continue at the final offset and speed of the motion. Without a horizon,
  /// cheap short motions would approach an obstacle until it is too late for a longer motion that
  /// passes the obstacle.
  double horizon = 8.0;
  int budget = 10000;  ///< Maximum number of candidate motions to check, >= 0.
};
void Visit(KeyVisitor& keys, FrenetOptions& options);

struct LatticeOptions {
  FrenetWeights weights;
  FrenetLimits limits;
  int layers = 4;         ///< Number of layers of the lattice, >= 0.
  double spacing = 12.0;  ///< Distance between neighboring layers of the lattice [m], > 0.
  /// Offsets d_k of the lattice's nodes [m].
  std::vector<double> end_offsets{0.0, 0.5,  -0.5, 1.0,  -1.0, 1.5, -1.5,
                                  2.0, -2.0, 2.5,  -2.5, 3.0,  -3.0};
  /// Speeds v_m of the lattice's nodes, as factors on the goal's speed. For the goal StopAt, the
  /// node speeds v_m are given as factors on the speed limit.
  std::vector<double> speed_factors{1.0, 0.75, 0.5};
  int budget = 100000;  ///< Maximum number of lattice edges to check, >= 0.
};
void Visit(KeyVisitor& keys, LatticeOptions& options);

}  // namespace trackbed
