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

/// Plans optimal motions in the Frenet frame of a reference path (Werling et al. 2010; the weights
/// are named as in the Frenet lecture). The candidates are polynomials to many end states, ranked
/// by cost. The planner chooses the cheapest motion that the car can drive.
///
/// Symbols: as in path/frenet_frame.h; T duration [s]; S_1, V_1 desired station [m] and speed [m/s]
/// at the end.
///   C_d = K_dj int d_ttt^2 dt + K_d d(T)^2 + K_dt T
///   C_s = K_sj int s_ttt^2 dt + K_s (s(T) - S_1)^2 + K_v (s_t(T) - V_1)^2 + K_st T
///   C = K_lat C_d + K_lon C_s
namespace trackbed {

/// A goal: reach or keep a speed.
struct KeepSpeed {
  double speed = 0.0;  ///< Desired speed V_1 [m/s], >= 0.
};

/// A goal: follow a leader that drives at constant speed. The desired station is S_1(t) = station +
/// speed t - front - gap - time_gap speed, with `front` the distance from the car's rear axle to
/// its front. The desired speed is V_1 = speed.
struct FollowLeader {
  double station = 0.0;   ///< Present station of the leader's rear end [m].
  double speed = 0.0;     ///< Speed of the leader along the path [m/s], >= 0.
  double gap = 4.0;       ///< Distance between the bumpers behind a standing leader [m].
  double time_gap = 1.5;  ///< Time gap [s], which adds a distance of time_gap times speed.
};

/// A goal: come to rest, with S_1 = station and V_1 = 0.
struct StopAt {
  double station = 0.0;  ///< Station of the rear axle at rest [m].
};

using FrenetGoal = std::variant<KeepSpeed, FollowLeader, StopAt>;

struct FrenetRequest {
  VehicleParams vehicle;
  SpeedLimits speed;  ///< Upper limits on speed and accelerations.
  RoadWidths road;
  FrenetState start;  ///< State of the car in the Frenet frame of the reference path.
  FrenetGoal goal;
  std::vector<MovingBox> obstacles;
  /// Edges of the road as functions of the station, which apply in addition to `road`. If null,
  /// only `road` applies.
  std::shared_ptr<const RoadEdges> edges{};
};

struct FrenetCost {
  double lateral = 0.0;       ///< Lateral cost C_d.
  double longitudinal = 0.0;  ///< Longitudinal cost C_s.
  double total = 0.0;         ///< Total cost C.
};

/// The desired end state of a motion.
struct FrenetTarget {
  std::optional<double> station;  ///< Station S_1 [m]; none: K_s has no effect.
  double speed = 0.0;             ///< Speed V_1 [m/s].
};

/// Returns the desired station S_1 and speed V_1 of a goal, `time` [s] after the start.
FrenetTarget TargetAt(const FrenetGoal& goal, const VehicleParams& vehicle, double time);

/// Computes the cost C of one piece. If d is a function of the station, the integral over time is
/// approximated by v^5 int d'''^2 ds with the mean speed v of the piece (with order 2, by v^3 int
/// d''^2 ds). At constant speed, the approximation equals the integral over time.
FrenetCost PieceCost(const FrenetPiece& piece, const FrenetTarget& target,
                     const FrenetWeights& weights);

struct FrenetCandidate {
  FrenetPiece piece;
  FrenetCost cost;
};

/// Returns all candidate motions, cheapest first. Candidates of equal cost keep the order of the
/// options.
std::vector<FrenetCandidate> FrenetCandidates(const FrenetRequest& request,
                                              const FrenetOptions& options);

/// The reason why the car cannot drive a candidate motion.
enum class Rejection {
  /// The motion is too fast or backwards, or d is a function of time and the car does not move.
  kSpeed,
  kAcceleration,  ///< The longitudinal or lateral acceleration is too large.
  kCurvature,     ///< The curvature is tighter than the car can steer.
  kSteeringRate,  ///< The steering rate exceeds the car's limit.
  /// The Frenet frame is undefined: the path bends too much, or is driven backwards.
  kFrame,
  kRoad,  ///< The footprint leaves the road or crosses its edges.
  /// The footprint comes closer than the safe distance to an obstacle, during or after the motion.
  kCollision,
};

/// Returns the name of a reason: "speed", "acceleration", "curvature", "steering_rate", "frame",
/// "road", "collision".
const char* ToString(Rejection rejection);

struct RejectionCounts {
  std::array<int, 7> counts{};

  [[nodiscard]] int Of(Rejection rejection) const;
  void Add(Rejection rejection);
  [[nodiscard]] int total() const;
  /// Formats the counts: "3 collision, 1 speed"; empty if nothing was rejected.
  [[nodiscard]] std::string ToString() const;

  bool operator==(const RejectionCounts&) const = default;
};

/// The result of planning in the Frenet frame, with PlanFrenet or PlanLattice.
struct FrenetPlan {
  /// Status of the result. kStartBlocked: the Frenet frame is undefined at the start, or the car
  /// overlaps an obstacle. kSearchFailed: there is no candidate, or no drivable candidate within
  /// the budget.
  PlanStatus status = PlanStatus::kSearchFailed;
  std::string reason;   ///< Reason of a failure; empty if ok.
  FrenetMotion motion;  ///< Motion; empty, like the points, unless the status is kOk.
  /// Points of the motion, at most `spacing` apart, for ToReference.
  std::vector<TrajectoryPoint> points;
  double cost = 0.0;   ///< Cost C of all pieces together.
  int candidates = 0;  ///< Total number of candidates (edges of a lattice).
  /// Number of checks. A lattice may check an edge more than once.
  int checked = 0;
  int passed = 0;            ///< Number of checks that passed.
  RejectionCounts rejected;  ///< Counts of checks that failed, by reason.

  [[nodiscard]] bool ok() const { return status == PlanStatus::kOk; }
};

/// Finds the cheapest candidate motion that the car can drive.
///
/// Guarantees: the points, which are `spacing` apart, meet every limit. Between two points, the
/// clearance can be smaller by half the distance by which car and obstacle approach each other
/// between the points. The counts satisfy checked = passed + rejected.total(). The same input gives
/// the same bytes. Beyond the end of the motion, up to the horizon, only collisions are checked,
/// every `time_step`. Errors: InternalError for options out of range or a start that is not finite.
/// Cost: 0.3 ms for 525 candidates, 1 ms if all candidates are rejected.
FrenetPlan PlanFrenet(const Path& reference, const FrenetRequest& request,
                      const FrenetOptions& options);

}  // namespace trackbed
