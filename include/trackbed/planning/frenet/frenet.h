#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/options/key_visitor.h"
#include "trackbed/path/reference.h"
#include "trackbed/planning/common/plan_status.h"
#include "trackbed/planning/frenet/frenet_motion.h"
#include "trackbed/vehicle/params.h"

/// Optimal motions in the Frenet frame of a reference path (Werling et al. 2010; the weights are
/// named as in the Frenet lecture): polynomials to many ends, ranked by their cost; the first one
/// that the car can drive is taken.
///
/// Symbols: those of path/frenet_frame.h; T duration [s]; S_1, V_1 wanted station [m] and speed
/// [m/s] at the end.
///   C_d = K_dj int d_ttt^2 dt + K_d d(T)^2 + K_dt T
///   C_s = K_sj int s_ttt^2 dt + K_s (s(T) - S_1)^2 + K_v (s_t(T) - V_1)^2 + K_st T
///   C = K_lat C_d + K_lon C_s
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

/// Reach or keep a speed.
struct KeepSpeed {
  double speed = 0.0;  ///< V_1 [m/s], >= 0
};

/// Keep behind something that goes on at a constant speed:
/// S_1(t) = station + speed t - front - gap - time_gap speed, with the car's front ahead of its
/// rear axle; V_1 = speed.
struct FollowLeader {
  double station = 0.0;   ///< of the leader's rear end now [m]
  double speed = 0.0;     ///< along the path [m/s], >= 0
  double gap = 4.0;       ///< between the bumpers at rest [m]
  double time_gap = 1.5;  ///< [s]
};

/// Come to rest: S_1 = station, V_1 = 0.
struct StopAt {
  double station = 0.0;  ///< of the rear axle [m]
};

using FrenetGoal = std::variant<KeepSpeed, FollowLeader, StopAt>;

/// How far the road reaches from the reference path to either side [m], for the car's footprint.
struct RoadWidths {
  double left = std::numeric_limits<double>::infinity();
  double right = std::numeric_limits<double>::infinity();
};

struct FrenetRequest {
  VehicleParams vehicle;
  SpeedLimits speed;  ///< no faster, no harder
  RoadWidths road;
  FrenetState start;  ///< the car against the reference path
  FrenetGoal goal;
  std::vector<MovingBox> obstacles;
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

struct FrenetCost {
  double lateral = 0.0;       ///< C_d
  double longitudinal = 0.0;  ///< C_s
  double total = 0.0;         ///< C
};

/// What is wanted at the end of a motion.
struct FrenetTarget {
  std::optional<double> station;  ///< S_1 [m]; none: K_s does not count
  double speed = 0.0;             ///< V_1 [m/s]
};

/// S_1 and V_1 of a goal at a time [s] after the start.
FrenetTarget TargetAt(const FrenetGoal& goal, const VehicleParams& vehicle, double time);

/// C of one piece. Over the station, the integral of d is that of a car which drives the piece at
/// its mean speed v: v^5 int d'''^2 ds (of order 2: v^3 int d''^2 ds). Both forms are one at
/// constant speed.
FrenetCost PieceCost(const FrenetPiece& piece, const FrenetTarget& target,
                     const FrenetWeights& weights);

struct FrenetCandidate {
  FrenetPiece piece;
  FrenetCost cost;
};

/// All candidates, cheapest first; of equal ones, as their ends are listed.
std::vector<FrenetCandidate> FrenetCandidates(const FrenetRequest& request,
                                              const FrenetOptions& options);

/// Why a candidate cannot be driven.
enum class Rejection {
  kSpeed,         ///< faster than allowed, or backwards, or d(t) without motion
  kAcceleration,  ///< along or across
  kCurvature,     ///< tighter than the car can steer
  kSteeringRate,  ///< the steering would have to turn faster than it can
  kFrame,         ///< the path is bent too much, or driven backwards, for a frame there
  kRoad,          ///< the footprint leaves the road
  kCollision,  ///< the footprint comes closer than the safe distance to an obstacle, now or later
};

/// "speed", "acceleration", "curvature", "steering_rate", "frame", "road", "collision".
const char* ToString(Rejection rejection);

struct RejectionCounts {
  std::array<int, 7> counts{};

  [[nodiscard]] int Of(Rejection rejection) const;
  void Add(Rejection rejection);
  [[nodiscard]] int total() const;
  /// "3 collision, 1 speed"; empty when there is none.
  [[nodiscard]] std::string ToString() const;

  bool operator==(const RejectionCounts&) const = default;
};

/// What planning in the frame gives back, here and in planning/lattice.h.
struct FrenetPlan {
  /// kStartBlocked: the start has no frame or overlaps an obstacle. kSearchFailed: no candidate, or
  /// none that can be driven within the budget.
  PlanStatus status = PlanStatus::kSearchFailed;
  std::string reason;                   ///< for people; empty when ok
  FrenetMotion motion;                  ///< empty unless ok, as are the points
  std::vector<TrajectoryPoint> points;  ///< at most `spacing` apart; for ToReference
  double cost = 0.0;                    ///< C, of all pieces together
  int candidates = 0;                   ///< there were (edges of a lattice)
  int checked = 0;                      ///< of them; a lattice may check an edge again
  int passed = 0;                       ///< of these
  RejectionCounts rejected;             ///< the others

  [[nodiscard]] bool ok() const { return status == PlanStatus::kOk; }
};

/// The cheapest candidate that can be driven.
///
/// Guarantees: the points keep every limit; between them, `spacing` apart, the clearance can be
/// less by half of what car and obstacle move toward each other from point to point. checked =
/// passed + rejected.total(). Same input, same bytes. Beyond the end of the motion only collisions
/// are looked for, every `time_step`, up to the horizon. Errors: InternalError for options out of
/// range or a start that is not finite. Cost: 0.3 ms for 525 candidates, 1 ms when
/// all of them are rejected.
FrenetPlan PlanFrenet(const Path& reference, const FrenetRequest& request,
                      const FrenetOptions& options);

}  // namespace trackbed
