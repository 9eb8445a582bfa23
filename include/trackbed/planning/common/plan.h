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

/// Defines the input and the output of planners.
namespace trackbed {

class Track;

/// Laps to drive on a closed track.
struct TrackLaps {
  /// Track of the mission; null if the mission is not on a track.
  std::shared_ptr<const Track> track{};
  int laps = 1;  ///< Number of laps of the track to drive, >= 1.
};

/// Describes the laps of a plan on a closed track.
struct PlannedLaps {
  std::shared_ptr<const Track> track{};  ///< Track of the plan; null if the plan is not on a track.
  /// Stations at which the plan crosses the start line [m]; there is one more crossing than laps.
  /// The first crossing of the start line has the station 0 if the plan begins on or beyond the
  /// start line. In a plan made during a run, crossings of the start line behind the car have
  /// negative stations.
  std::vector<double> lines{};
};

/// A route over the lanes of a road network.
struct LaneMission {
  /// Road network of the mission; null if the mission is not on roads.
  std::shared_ptr<const RoadNetwork> network{};
  /// Places on lanes that the route visits, from the first to the last.
  std::vector<LanePlace> route{};
};

/// A section of a lane-change course that has cones on either side.
struct Gate {
  int section = 0;   ///< Number of the section within the lane-change course.
  OrientedBox lane;  ///< Rectangle between the cones of the gate, with its x axis along the course.
};

/// A place at which a plan keeps the car at rest.
struct PlannedWait {
  /// Station at which the car waits [m]: 0, a cusp of the path or one of Plan::stops.
  double s = 0.0;
  double duration = 0.0;  ///< Time of the wait, from coming to rest to starting again [s], > 0.
};

/// A node of a search tree. The first node of a tree is the start, which is its own parent.
struct TreeNode {
  Vec2 position{0.0, 0.0};  ///< Position of the tree's node [m].
  std::size_t parent = 0;   ///< Index of the node's parent in the tree.
  double cost = 0.0;        ///< Length of the path along the tree from the start to the node [m].
};

/// Default of PlanRequest::max_samples; RRT* takes about 24 s for this number of samples.
inline constexpr long kMaxSamples = 2'000'000;

/// Describes a planning problem, independently of the planning method. Planners keep no state and
/// read no clock, so that the same request always yields the same plan. The only exception is a
/// planner with a time limit: such a planner reads the caller's clock, so that the plan depends on
/// the speed of the machine.
struct PlanRequest {
  VehicleParams vehicle;
  std::vector<Vec2> waypoints;  ///< Waypoints of the route, from start to goal [m].
  /// Required heading of the car at each waypoint [rad]; if empty, PlannedStops chooses the
  /// headings.
  std::vector<double> headings{};
  std::vector<OrientedBox> obstacles{};  ///< Obstacles that are known when the plan is made.
  Wind wind{};                           ///< Wind at the start of the run.
  Pose2 start;                           ///< Pose of the car at the start.
  double start_speed = 0.0;              ///< Speed of the car at the start [m/s].
  /// Steering angle of the wheels and of the actuator at the start [rad].
  double start_steering = 0.0;
  SpeedLimits speed;       ///< Speed, acceleration and deceleration of the mission.
  std::uint64_t seed = 0;  ///< Seed of the planner's random numbers.
  /// Returns the current time [s] from an arbitrary origin. Only planners with a time limit call
  /// `clock`. If `clock` is empty, planners ignore their time limits.
  std::function<double()> clock{};
  /// Maximum number of random samples that the planner may draw for all search trees together
  /// (PlanDiagnostics::samples), regardless of the planner's options. The maximum number of samples
  /// bounds the computing time of the planner, which is about 12 us per sample.
  long max_samples = kMaxSamples;
  double friction = 1.0;  ///< Friction of the road, as a factor on the tyres' friction coefficient.
  /// Patches of the road whose friction differs from `friction`.
  std::vector<FrictionPatch> friction_patches{};
  Ground ground{};       ///< Ground under the road; slopes reduce the grip.
  TrackLaps on_track{};  ///< Track and laps to drive, for planners that follow a track.
  LaneMission lanes{};   ///< Route over the lanes of roads, for planners that follow lanes.
  InfeasiblePolicy infeasible = InfeasiblePolicy::kSlowDown;
  /// Largest allowed distance of the path from each waypoint after the first [m], >= 0; nullopt: no
  /// bound. To stay within `max_waypoint_miss`, planners that round corners use smaller radii, or
  /// turn around beyond the waypoint. MakePlan rejects a plan that passes a waypoint farther away
  /// than `max_waypoint_miss` (kWaypointMissed), unless the plan is partial.
  std::optional<double> max_waypoint_miss{};
  /// The car's limits, if the planned speeds should be as high as these limits allow. If `limits`
  /// is nullopt, the planned speeds follow the mission's speed limits `speed`.
  std::optional<SpeedAtLimit> limits{};
};

/// Conditions of the road that limit a plan, and the policy for plans that exceed the car's limits.
struct RoadConditions {
  double friction = 1.0;  ///< Friction of the road (PlanRequest::friction).
  /// Road patches with a different friction (PlanRequest::friction_patches).
  std::vector<FrictionPatch> friction_patches{};
  Ground ground{};  ///< Ground under the road (PlanRequest::ground).
  InfeasiblePolicy infeasible = InfeasiblePolicy::kSlowDown;
  std::optional<SpeedAtLimit> limits{};  ///< The car's limits (PlanRequest::limits).
};

/// The output of a planner: path, speeds, steering and diagnostics. A plan whose status is not kOk
/// contains the reason of the failure, but no path.
struct Plan {
  PlanStatus status = PlanStatus::kOk;
  std::string reason;   ///< Reason why planning failed; empty if ok.
  Reference reference;  ///< Path and speeds for closed-loop controllers.
  /// Steering angle as a function of the driven distance, for open-loop runs.
  SteeringSchedule schedule;
  /// Speed profile for open-loop runs, which ends at the station at which the car stops.
  SpeedProfile schedule_speed;
  std::vector<SpeedCap> caps;  ///< Speed limits on sections of the path.
  /// Stations at which the car stops to turn its wheels, in addition to the path's cusps [m].
  std::vector<double> stops;
  /// Places at which the car waits, in the order of their stations; at every other stop of the
  /// plan, the car starts again as soon as its wheels have turned.
  std::vector<PlannedWait> waits{};
  /// Waypoints of the request, beginning with the start of the route; empty if the mission has no
  /// waypoints.
  std::vector<Vec2> waypoints;
  /// Pose at which the mission ends; the path also ends at this pose unless the path is blocked or
  /// partial.
  Pose2 goal;
  /// Reason why the path stops before the goal, such as an obstacle; empty if the path reaches the
  /// goal.
  std::string blocked;
  /// Reason why the planner's search ended before the path reached the goal; empty if the path
  /// reached the goal. Replanning during the run does not extend a partial plan, which ends before
  /// the goal.
  std::string partial;
  std::vector<Gate> gates;          ///< Gates of cones that the path passes through.
  std::vector<IsolatedTurn> turns;  ///< Turns whose open-loop error can be predicted.
  /// Remarks for the user, for example that the plan was slowed down.
  std::vector<std::string> notes;
  PlanDiagnostics diagnostics;  ///< Describes how the plan was found, for plan.json.
  /// Whether the path interpolates samples of a motion, at most 0.1 m apart. The steering schedule
  /// of a sampled path has the steering rates of the sampled motion. Between the samples, the
  /// interpolated path may require a higher steering rate than the sampled motion.
  bool sampled = false;
  PlannedLaps laps;  ///< Laps of a plan on a track.
  /// Roads whose lanes the plan follows; null if the plan does not follow lanes.
  std::shared_ptr<const RoadNetwork> roads{};
  std::vector<TreeNode> tree;  ///< Nodes of all RRT and RRT* trees, one tree after the other.

  [[nodiscard]] bool ok() const { return status == PlanStatus::kOk; }

  /// Returns the time from the start to the end of the path at the planned speeds, with all waits
  /// [s].
  [[nodiscard]] double Duration() const {
    double time = reference.speed.TimeAt(reference.path.length());
    for (const PlannedWait& wait : waits) {
      time += wait.duration;
    }
    return time;
  }
};

}  // namespace trackbed
