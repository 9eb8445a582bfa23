#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/path/reference.h"
#include "trackbed/planning/common/plan_diagnostics.h"
#include "trackbed/planning/common/plan_status.h"
#include "trackbed/planning/common/planner_options.h"
#include "trackbed/planning/common/speed_at_limit.h"
#include "trackbed/planning/common/turn_prediction.h"
#include "trackbed/road_network/lane_route.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/steering_schedule.h"
#include "trackbed/world/road.h"
#include "trackbed/world/wind.h"

/// Input and output of planners.
namespace trackbed {

class Track;

/// Laps to drive on a closed track.
struct TrackLaps {
  std::shared_ptr<const Track> track{};  ///< Track; null if the mission is not on a track.
  int laps = 1;                          ///< Number of laps, >= 1.
};

/// Laps of a plan on a closed track.
struct PlannedLaps {
  std::shared_ptr<const Track> track{};  ///< Track; null if the plan is not on a track.
  /// Stations at which the plan crosses the start line [m]: one more than the number of laps. The
  /// first station is 0 if the plan begins on or beyond the start line. In a plan made during a
  /// run, crossings behind the car have negative stations.
  std::vector<double> lines{};
};

/// A route over the lanes of a road network.
struct LaneMission {
  /// Road network; null if the mission is not on roads.
  std::shared_ptr<const RoadNetwork> network{};
  std::vector<LanePlace> route{};  ///< Places of the route, from the first to the last.
};

/// A section of a course with cones on either side.
struct Gate {
  int section = 0;   ///< Number of the section in the course.
  OrientedBox lane;  ///< Lane between the cones, with the x axis along the course.
};

/// A node of a search tree. The first node of a tree is the start, which is its own parent.
struct TreeNode {
  Vec2 position{0.0, 0.0};  ///< Position [m].
  std::size_t parent = 0;   ///< Index of the parent in the tree.
  double cost = 0.0;        ///< Length of the path from the start along the tree [m].
};

/// Default of PlanRequest::max_samples; RRT* takes about 24 s for this number.
inline constexpr long kMaxSamples = 2'000'000;

/// Describes the planning problem, independent of the method. Planners keep no state and read no
/// clock: the same request gives the same plan. Only a planner with a time limit reads the caller's
/// clock, so that its plan depends on the speed of the machine.
struct PlanRequest {
  VehicleParams vehicle;
  std::vector<Vec2> waypoints;  ///< Points of the route [m].
  /// Heading of the car at each waypoint [rad]; empty: the headings follow the legs, see
  /// PlannedStops.
  std::vector<double> headings{};
  std::vector<OrientedBox> obstacles{};  ///< Known obstacles.
  Wind wind{};                           ///< Wind at the start of the run.
  Pose2 start;                           ///< Pose of the car.
  double start_speed = 0.0;              ///< Speed of the car [m/s].
  double start_steering = 0.0;  ///< Steering angle of wheels and actuator at the start [rad].
  SpeedLimits speed;            ///< The mission's speed, acceleration and deceleration.
  std::uint64_t seed = 0;       ///< Seed of all random choices.
  /// Returns the current time [s] from an arbitrary origin. Only planners with a time limit call
  /// `clock`. If `clock` is empty, time limits are ignored.
  std::function<double()> clock{};
  /// Maximum number of random samples that the planner may draw in all its trees
  /// (PlanDiagnostics::samples), regardless of its options. The maximum bounds the computing time,
  /// which is about 12 us per sample.
  long max_samples = kMaxSamples;
  double friction = 1.0;  ///< Friction of the road, a factor on the tyres' friction.
  std::vector<FrictionPatch> friction_patches{};  ///< Patches of the road with another friction.
  Ground ground{};       ///< Ground under the road; slopes reduce the grip.
  TrackLaps on_track{};  ///< Laps on a track, for planners that follow a track.
  LaneMission lanes{};   ///< Route over lanes, for planners that follow lanes.
  InfeasiblePolicy infeasible = InfeasiblePolicy::kSlowDown;
  /// The car's limits, for a plan with speeds at these limits. If nullopt, the speeds follow
  /// `speed`.
  std::optional<SpeedAtLimit> limits{};
};

/// The conditions of the road that limit a plan, and the policy for plans that exceed the limits.
struct RoadConditions {
  double friction = 1.0;                          ///< Same as PlanRequest::friction.
  std::vector<FrictionPatch> friction_patches{};  ///< Same as PlanRequest::friction_patches.
  Ground ground{};                                ///< Same as PlanRequest::ground.
  InfeasiblePolicy infeasible = InfeasiblePolicy::kSlowDown;
  std::optional<SpeedAtLimit> limits{};  ///< Same as PlanRequest::limits.
};

/// The output of a planner. If the status is not kOk, there is a reason and no path.
struct Plan {
  PlanStatus status = PlanStatus::kOk;
  std::string reason;         ///< Reason of a failure; empty if ok.
  Reference reference;        ///< Path and speed for closed-loop controllers.
  SteeringSchedule schedule;  ///< Open-loop steering over the driven distance.
  /// Speed in an open-loop run; ends at the station at which the run stops.
  SpeedProfile schedule_speed;
  std::vector<SpeedCap> caps;  ///< Sections that the car drives at a lower speed.
  /// Stations, besides the cusps, at which the car stops to turn its wheels [m].
  std::vector<double> stops;
  /// End of the mission; also the end of the path, unless the path is blocked or partial.
  Pose2 goal;
  /// Reason why the path ends before the goal; else empty.
  std::string blocked;
  /// Reason why a search was ended before the path reached the goal; else empty. Replanning during
  /// the run does not extend a partial plan.
  std::string partial;
  std::vector<Gate> gates;          ///< Gates that the path passes through.
  std::vector<IsolatedTurn> turns;  ///< Turns whose open-loop error can be predicted.
  /// Remarks for the user, for example that the plan was slowed down.
  std::vector<std::string> notes;
  PlanDiagnostics diagnostics;  ///< How the plan was found, for plan.json.
  /// Whether the path interpolates samples of a motion at most 0.1 m apart. The schedule then has
  /// the steering rate of the motion; between the samples, the path may need a higher rate.
  bool sampled = false;
  PlannedLaps laps;            ///< Laps of a plan on a track.
  std::vector<TreeNode> tree;  ///< Nodes of all RRT and RRT* trees, one tree after the other.

  [[nodiscard]] bool ok() const { return status == PlanStatus::kOk; }
};

}  // namespace trackbed
