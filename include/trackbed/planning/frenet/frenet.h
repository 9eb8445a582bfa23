#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/options/key_visitor.h"
#include "trackbed/path/reference.h"
#include "trackbed/planning/common/plan_status.h"
#include "trackbed/planning/frenet/frenet_motion.h"
#include "trackbed/planning/frenet/frenet_options.h"
#include "trackbed/planning/frenet/road_edges.h"
#include "trackbed/vehicle/params.h"

/// Optimal motions in the Frenet frame of a reference path (Werling et al. 2010; the weights are
/// named as in the Frenet lecture): polynomials to many end states, ranked by cost. The first one
/// that the car can drive is chosen.
///
/// Symbols: those of path/frenet_frame.h; T duration [s]; S_1, V_1 desired station [m] and speed
/// [m/s] at the end.
///   C_d = K_dj int d_ttt^2 dt + K_d d(T)^2 + K_dt T
///   C_s = K_sj int s_ttt^2 dt + K_s (s(T) - S_1)^2 + K_v (s_t(T) - V_1)^2 + K_st T
///   C = K_lat C_d + K_lon C_s
namespace trackbed {

/// Reach or keep a speed.
struct KeepSpeed {
  double speed = 0.0;  ///< V_1 [m/s], >= 0
};

/// Follow a leader with constant speed: S_1(t) = station + speed t - front - gap - time_gap speed,
/// with `front` the distance from the car's rear axle to its front; V_1 = speed.
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

struct FrenetRequest {
  VehicleParams vehicle;
  SpeedLimits speed;  ///< upper limits on speed and accelerations
  RoadWidths road;
  FrenetState start;  ///< the car against the reference path
  FrenetGoal goal;
  std::vector<MovingBox> obstacles;
  /// Edges of the road over the station, in addition to `road`; none: `road` alone.
  std::shared_ptr<const RoadEdges> edges{};
};

struct FrenetCost {
  double lateral = 0.0;       ///< C_d
  double longitudinal = 0.0;  ///< C_s
  double total = 0.0;         ///< C
};

/// The desired end state of a motion.
struct FrenetTarget {
  std::optional<double> station;  ///< S_1 [m]; none: K_s has no effect
  double speed = 0.0;             ///< V_1 [m/s]
};

/// S_1 and V_1 of a goal, `time` [s] after the start.
FrenetTarget TargetAt(const FrenetGoal& goal, const VehicleParams& vehicle, double time);

/// C of one piece. Over the station, the integral of d is that of a car that drives the piece at
/// its mean speed v: v^5 int d'''^2 ds (of order 2: v^3 int d''^2 ds). Both forms are equal at
/// constant speed.
FrenetCost PieceCost(const FrenetPiece& piece, const FrenetTarget& target,
                     const FrenetWeights& weights);

struct FrenetCandidate {
  FrenetPiece piece;
  FrenetCost cost;
};

/// All candidates, cheapest first; equal costs keep the order of the options.
std::vector<FrenetCandidate> FrenetCandidates(const FrenetRequest& request,
                                              const FrenetOptions& options);

/// The reason why a candidate cannot be driven.
enum class Rejection {
  kSpeed,         ///< too fast, or backwards, or d(t) without motion
  kAcceleration,  ///< longitudinal or lateral
  kCurvature,     ///< tighter than the car can steer
  kSteeringRate,  ///< exceeds the car's steering rate
  kFrame,         ///< the path bends too much, or is driven backwards, for a frame
  kRoad,          ///< the footprint leaves the road, or exceeds its edges
  /// The footprint comes closer than the safe distance to an obstacle, now or later.
  kCollision,
};

/// "speed", "acceleration", "curvature", "steering_rate", "frame", "road", "collision".
const char* ToString(Rejection rejection);

struct RejectionCounts {
  std::array<int, 7> counts{};

  [[nodiscard]] int Of(Rejection rejection) const;
  void Add(Rejection rejection);
  [[nodiscard]] int total() const;
  /// "3 collision, 1 speed"; empty if there are none.
  [[nodiscard]] std::string ToString() const;

  bool operator==(const RejectionCounts&) const = default;
};

/// The result of planning in the frame, here and in planning/lattice.h.
struct FrenetPlan {
  /// kStartBlocked: the start has no frame or overlaps an obstacle. kSearchFailed: there is no
  /// candidate, or no drivable one within the budget.
  PlanStatus status = PlanStatus::kSearchFailed;
  std::string reason;                   ///< empty when ok
  FrenetMotion motion;                  ///< empty unless ok, as are the points
  std::vector<TrajectoryPoint> points;  ///< at most `spacing` apart; for ToReference
  double cost = 0.0;                    ///< C, of all pieces together
  int candidates = 0;                   ///< total number (edges of a lattice)
  int checked = 0;                      ///< checked ones; a lattice may check an edge again
  int passed = 0;                       ///< checked ones that passed
  RejectionCounts rejected;             ///< checked ones that failed

  [[nodiscard]] bool ok() const { return status == PlanStatus::kOk; }
};

/// The cheapest candidate that can be driven.
///
/// Guarantees: the points meet every limit; between them, `spacing` apart, the clearance can be
/// smaller by half the distance that car and obstacle approach each other from point to point.
/// checked = passed + rejected.total(). The same input gives the same bytes. Beyond the end of the
/// motion only collisions are checked, every `time_step`, up to the horizon. Errors: InternalError
/// for options out of range or a start that is not finite. Cost: 0.3 ms for 525 candidates, 1 ms
/// when all of them are rejected.
FrenetPlan PlanFrenet(const Path& reference, const FrenetRequest& request,
                      const FrenetOptions& options);

}  // namespace trackbed
