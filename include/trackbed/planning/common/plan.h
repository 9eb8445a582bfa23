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

/// What a planner is asked, and what it answers.
namespace trackbed {

class Track;

/// Laps on a closed track, to be planned.
struct TrackLaps {
  std::shared_ptr<const Track> track{};  ///< none: not on a track
  int laps = 1;                          ///< >= 1
};

/// Laps on a closed track as planned.
struct PlannedLaps {
  std::shared_ptr<const Track> track{};  ///< none: not on a track
  /// Stations of the plan where it crosses the start line [m]: one more than laps. The first one is
  /// 0 when the plan begins on the line or after it. Those behind a car that has come back onto its
  /// line are negative.
  std::vector<double> lines{};
};

/// A route over the lanes of a road network.
struct LaneMission {
  std::shared_ptr<const RoadNetwork> network{};  ///< none: not on roads
  std::vector<LanePlace> route{};                ///< from its first place to its last
};

/// A section of a course with cones on either side.
struct Gate {
  int section = 0;   ///< its number in the course
  OrientedBox lane;  ///< its x axis along the course
};

/// A node of a search tree; the first one is the start, its own parent.
struct TreeNode {
  Vec2 position{0.0, 0.0};  ///< [m]
  std::size_t parent = 0;   ///< index in the tree
  double cost = 0.0;        ///< length of the path from the start along the tree [m]
};

/// Default of PlanRequest::max_samples: about 24 s of RRT*.
inline constexpr long kMaxSamples = 2'000'000;

/// What is to be reached, by whatever method. Planners keep no state and have no clock of their
/// own: the same values give the same plan. Only a planner with a time limit looks at the caller's
/// clock, and with one its plan depends on how fast the machine is.
struct PlanRequest {
  VehicleParams vehicle;
  std::vector<Vec2> waypoints;  ///< [m]
  /// Of the car at each waypoint [rad]; none: along the legs, see PlannedStops.
  std::vector<double> headings{};
  std::vector<OrientedBox> obstacles{};  ///< that are known
  Wind wind{};                           ///< as it blows when the run begins
  Pose2 start;                           ///< where the car is
  double start_speed = 0.0;              ///< [m/s]
  double start_steering = 0.0;           ///< of wheels and actuator there [rad]
  SpeedLimits speed;                     ///< the mission's speed and how to change it
  std::uint64_t seed = 0;                ///< of every random choice
  /// The time now [s], from any beginning; asked by planners with a time limit alone. Empty: time
  /// limits are not kept.
  std::function<double()> clock{};
  /// Random samples that the planner may draw in all its trees, whatever its options say: a bound
  /// of its work, about 12 us each. See PlanDiagnostics::samples.
  long max_samples = kMaxSamples;
  double friction = 1.0;                          ///< of the road, a factor on the tyres' own
  std::vector<FrictionPatch> friction_patches{};  ///< where it is another
  Ground ground{};                                ///< whose slopes take of what the road holds
  TrackLaps on_track{};                           ///< for planners that follow a track
  LaneMission lanes{};                            ///< for planners that follow lanes
  InfeasiblePolicy infeasible = InfeasiblePolicy::kSlowDown;
  /// How speeds at the car's limit are found; none: they follow `speed`.
  std::optional<SpeedAtLimit> limits{};
};

/// The road that a plan is held to, and what becomes of one that asks more of the car.
struct RoadConditions {
  double friction = 1.0;                          ///< as PlanRequest::friction
  std::vector<FrictionPatch> friction_patches{};  ///< likewise
  Ground ground{};                                ///< likewise
  InfeasiblePolicy infeasible = InfeasiblePolicy::kSlowDown;
  std::optional<SpeedAtLimit> limits{};  ///< as PlanRequest::limits
};

/// What a planner gives back. With any status but kOk there is a reason and no path.
struct Plan {
  PlanStatus status = PlanStatus::kOk;
  std::string reason;           ///< for people; empty when ok
  Reference reference;          ///< for closed-loop controllers
  SteeringSchedule schedule;    ///< for the open loop, over the distance driven
  SpeedProfile schedule_speed;  ///< likewise: ends where the open loop is to stop
  std::vector<SpeedCap> caps;   ///< stretches of the path that it takes more slowly
  std::vector<double> stops;    ///< where it stops on the way, besides its cusps, to turn the
                                ///< wheels on the spot [m]
  Pose2 goal;  ///< where the mission ends: the path too, unless it is blocked or partial
  /// Why the path ends before the goal, for people; empty when it does not.
  std::string blocked;
  /// Why the path leads only part of the way, for people, when a search for more of it was ended;
  /// empty when it leads to the goal. Whatever plans again on the way leads no further either.
  std::string partial;
  std::vector<Gate> gates;          ///< that it leads through
  std::vector<IsolatedTurn> turns;  ///< whose cost to an open-loop run can be told
  std::vector<std::string> notes;   ///< what to know of it, for people: that it was slowed down
  PlanDiagnostics diagnostics;      ///< how it was found, for plan.json
  /// Whether the path interpolates samples of a motion at most 0.1 m apart: `schedule` then has its
  /// steering rate, between the samples the path may bend faster.
  bool sampled = false;
  PlannedLaps laps;            ///< of a plan on a track
  std::vector<TreeNode> tree;  ///< of every RRT or RRT* that was used, one after the other

  [[nodiscard]] bool ok() const { return status == PlanStatus::kOk; }
};

}  // namespace trackbed
