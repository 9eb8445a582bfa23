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
  std::shared_ptr<const Track> track{};  ///< Track; none: not on a track.
  int laps = 1;                          ///< Number of laps, >= 1.
};

/// Laps of a plan on a closed track.
struct PlannedLaps {
  std::shared_ptr<const Track> track{};  ///< Track; none: not on a track.
  /// Stations of the plan at which it crosses the start line [m]: one more than laps. The first
  /// station is 0 if the plan begins on or after the line. Crossings behind a car that has returned
  /// to its line are negative.
  std::vector<double> lines{};
};

/// A route over the lanes of a road network.
struct LaneMission {
  std::shared_ptr<const RoadNetwork> network{};  ///< Road network; none: not on roads.
  std::vector<LanePlace> route{};  ///< Places of the route, from the first to the last.
};

/// A section of a course with cones on either side.
struct Gate {
  int section = 0;   ///< Number of the section in the course.
  OrientedBox lane;  ///< Lane between the cones, with the x axis along the course.
};

/// A node of a search tree. The first node is the start and its own parent.
struct TreeNode {
  Vec2 position{0.0, 0.0};  ///< Position [m].
  std::size_t parent = 0;   ///< Index of the parent in the tree.
  double cost = 0.0;        ///< Length of the path from the start along the tree [m].
};

/// Default of PlanRequest::max_samples: about 24 s of RRT*.
inline constexpr long kMaxSamples = 2'000'000;

/// The planning problem, independent of the method. Planners keep no state and read no clock: the
/// same values give the same plan. Only a planner with a time limit reads the caller's clock; its
/// plan then depends on the speed of the machine.
struct PlanRequest {
  VehicleParams vehicle;
  std::vector<Vec2> waypoints;  ///< Points of the route [m].
  /// Heading of the car at each waypoint [rad]; empty: along the legs, see PlannedStops.
  std::vector<double> headings{};
  std::vector<OrientedBox> obstacles{};  ///< Known obstacles.
  Wind wind{};                           ///< Wind at the start of the run.
  Pose2 start;                           ///< Pose of the car.
  double start_speed = 0.0;              ///< Speed of the car [m/s].
  double start_steering = 0.0;           ///< Angle of wheels and actuator at the start [rad].
  SpeedLimits speed;                     ///< The mission's speed, acceleration and deceleration.
  std::uint64_t seed = 0;                ///< Seed of all random choices.
  /// Returns the current time [s] from an arbitrary origin. Only planners with a time limit call
  /// `clock`. If empty, time limits are ignored.
  std::function<double()> clock{};
  /// Maximum number of random samples that the planner may draw in all its trees, regardless of its
  /// options. The maximum bounds the work, which is about 12 us per sample. See
  /// PlanDiagnostics::samples.
  long max_samples = kMaxSamples;
  double friction = 1.0;  ///< Friction of the road, a factor on the tyres' friction.
  std::vector<FrictionPatch> friction_patches{};  ///< Patches with another factor.
  Ground ground{};                                ///< Ground, whose slopes reduce the grip.
  TrackLaps on_track{};                           ///< Laps, for planners that follow a track.
  LaneMission lanes{};  ///< Route over lanes, for planners that follow lanes.
  InfeasiblePolicy infeasible = InfeasiblePolicy::kSlowDown;
  /// Speeds at the car's limit; nullopt: speeds follow `speed`.
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
  std::string reason;           ///< Reason of a failure; empty if ok.
  Reference reference;          ///< Path and speed for closed-loop controllers.
  SteeringSchedule schedule;    ///< Open-loop steering over the driven distance.
  SpeedProfile schedule_speed;  ///< Open-loop speed; ends where the open loop is to stop.
  std::vector<SpeedCap> caps;   ///< Sections driven at a lower speed.
  std::vector<double> stops;    ///< Stops besides the cusps, to turn the wheels at rest [m].
  Pose2 goal;  ///< End of the mission, and of the path unless it is blocked or partial.
  /// Why the path ends before the goal; else empty.
  std::string blocked;
  /// Why the path ends early because a search was ended; empty if the path reaches the goal.
  /// Replanning during the run does not extend a partial plan.
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
