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

/// Plans optimal motions in the Frenet frame of a reference path (Werling et al. 2010). The cost
/// weights K have the names of the Frenet lecture (docs/references.md). The candidate motions are
/// polynomials that lead to many end states, ranked by cost. The planner chooses the cheapest
/// candidate motion that the car can drive.
///
/// Symbols: as in path/frenet_frame.h; T is the duration of a motion [s]; S_1 and V_1 are the
/// desired station [m] and speed [m/s] at its end. The lateral cost C_d, the longitudinal cost C_s
/// and the total cost C of a motion are:
///   C_d = K_dj int d_ttt^2 dt + K_d d(T)^2 + K_dt T
///   C_s = K_sj int s_ttt^2 dt + K_s (s(T) - S_1)^2 + K_v (s_t(T) - V_1)^2 + K_st T
///   C = K_lat C_d + K_lon C_s
namespace trackbed {

/// The goal to reach or keep a speed.
struct KeepSpeed {
  double speed = 0.0;  ///< Desired speed V_1 [m/s], >= 0.
};

/// The goal to follow a leader, which is assumed to drive at constant speed. The desired station is
/// S_1(t) = station + speed t - front - gap - time_gap speed, with the leader's `station` and
/// `speed`, and the distance `front` from the car's rear axle to its front. The desired speed V_1
/// is the leader's speed.
struct FollowLeader {
  double station = 0.0;  ///< Present station of the leader's rear end [m].
  double speed = 0.0;    ///< Speed of the leader along the path [m/s], >= 0.
  double gap = 4.0;      ///< Distance to keep behind a standing leader, from bumper to bumper [m].
  /// Time gap to the leader [s], which adds the distance time_gap times speed to `gap`.
  double time_gap = 1.5;
};

/// The goal to come to rest, with the desired station S_1 = `station` and the desired speed V_1 =
/// 0.
struct StopAt {
  double station = 0.0;  ///< Station at which the rear axle comes to rest [m].
};

using FrenetGoal = std::variant<KeepSpeed, FollowLeader, StopAt>;

struct FrenetRequest {
  VehicleParams vehicle;
  SpeedLimits speed;  ///< Upper limits of the car's speed and accelerations.
  RoadWidths road;
  FrenetState start;  ///< State of the car at the start, in the Frenet frame of the reference path.
  FrenetGoal goal;
  std::vector<MovingBox> obstacles;
  /// Edges of the road as functions of the station, which the car must respect in addition to
  /// `road`. If `edges` is null, only the constant road widths `road` apply.
  std::shared_ptr<const RoadEdges> edges{};
};

struct FrenetCost {
  double lateral = 0.0;       ///< Lateral cost C_d.
  double longitudinal = 0.0;  ///< Longitudinal cost C_s.
  double total = 0.0;         ///< Total cost C.
};

/// The desired end state of a motion.
struct FrenetTarget {
  /// Desired station S_1 [m]; none: any end station is equally good.
  std::optional<double> station;
  double speed = 0.0;  ///< Desired speed V_1 [m/s].
};

/// Returns the desired station S_1 and speed V_1 of a goal at the time `time` [s] after the start
/// of the motion.
FrenetTarget TargetAt(const FrenetGoal& goal, const VehicleParams& vehicle, double time);

/// Computes the cost C of one piece of a motion. If the offset d is a function of the station, the
/// integral of d_ttt^2 over time is approximated by v^5 int d'''^2 ds, with the mean speed v of the
/// piece. With derivative_order 2, the integral of d_tt^2 over time is approximated by v^3 int
/// d''^2 ds, with the mean speed v. The approximations of the cost integrals by the mean speed are
/// exact at constant speed.
FrenetCost PieceCost(const FrenetPiece& piece, const FrenetTarget& target,
                     const FrenetWeights& weights);

struct FrenetCandidate {
  FrenetPiece piece;
  FrenetCost cost;
};

/// Returns all candidate motions, cheapest first. Candidates of equal cost are in the order in
/// which the options list their end states.
std::vector<FrenetCandidate> FrenetCandidates(const FrenetRequest& request,
                                              const FrenetOptions& options);

/// The reason why a candidate motion is rejected.
enum class Rejection {
  /// The motion is too fast or leads backwards, or the offset d is a function of time while the car
  /// does not move.
  kSpeed,
  kAcceleration,  ///< The longitudinal or lateral acceleration of the motion is too large.
  kCurvature,     ///< The curvature of the motion is too large for the car's steering.
  kSteeringRate,  ///< The motion requires a higher steering rate than the car has.
  /// The Frenet frame is undefined for the motion, because the path bends too much or is driven
  /// backwards.
  kFrame,
  kRoad,  ///< The car's footprint leaves the road or crosses the road's edges.
  /// The car's footprint comes closer than the safe distance to an obstacle, during or after the
  /// motion.
  kCollision,
};

/// Returns the name of a reason for rejecting a motion: "speed", "acceleration", "curvature",
/// "steering_rate", "frame", "road", "collision".
const char* ToString(Rejection rejection);

struct RejectionCounts {
  std::array<int, 7> counts{};

  [[nodiscard]] int Of(Rejection rejection) const;
  void Add(Rejection rejection);
  [[nodiscard]] int total() const;
  /// Formats the counts of rejected motions, for example "3 collision, 1 speed"; empty if no motion
  /// was rejected.
  [[nodiscard]] std::string ToString() const;

  bool operator==(const RejectionCounts&) const = default;
};

/// The result of planning a motion in the Frenet frame, by PlanFrenet or PlanLattice.
struct FrenetPlan {
  /// Status of the planning. The status is kStartBlocked if the Frenet frame is undefined at the
  /// start, or if the car overlaps an obstacle. The status is kSearchFailed if there is no
  /// candidate motion, or no drivable candidate within the budget.
  PlanStatus status = PlanStatus::kSearchFailed;
  std::string reason;   ///< Reason why planning failed; empty if ok.
  FrenetMotion motion;  ///< The chosen motion; empty unless the status is kOk.
  /// Points of the chosen motion, at most `spacing` apart, for ToReference; empty unless the status
  /// is kOk.
  std::vector<TrajectoryPoint> points;
  double cost = 0.0;   ///< Cost C of the chosen motion, over all its pieces.
  int candidates = 0;  ///< Total number of candidate motions, or of the edges of a lattice.
  /// Number of checks whether the car can drive a candidate motion. PlanLattice may check an edge
  /// more than once.
  int checked = 0;
  int passed = 0;            ///< Number of checks in which a candidate motion proved drivable.
  RejectionCounts rejected;  ///< Number of failed checks of candidates, by reason.

  [[nodiscard]] bool ok() const { return status == PlanStatus::kOk; }
};

/// Finds the cheapest candidate motion that the car can drive.
///
/// Guarantees: every point of the motion meets every limit; the points are at most `spacing` apart.
/// Between two checked points of the motion, the car can be closer to an obstacle than the safe
/// distance. The shortfall from the safe distance is at most half the distance by which car and
/// obstacle approach each other between two checked points. The counts of checks satisfy checked =
/// passed + rejected.total(). The same input always yields a bit-identical result. From the end of
/// the motion to the horizon, the planner checks only for collisions, at intervals of `time_step`.
/// Throws InternalError if an option is out of range or if the start state is not finite. Computing
/// time: 0.3 ms for 525 candidates, 1 ms if all candidates are rejected.
FrenetPlan PlanFrenet(const Path& reference, const FrenetRequest& request,
                      const FrenetOptions& options);

}  // namespace trackbed
