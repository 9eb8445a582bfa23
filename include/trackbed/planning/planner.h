#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "trackbed/path/reference.h"
#include "trackbed/planning/corners.h"
#include "trackbed/planning/course.h"
#include "trackbed/planning/fillet.h"
#include "trackbed/planning/hybrid_astar.h"
#include "trackbed/planning/lane_change.h"
#include "trackbed/planning/rrt_star.h"
#include "trackbed/planning/turn_prediction.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/steering_schedule.h"
#include "trackbed/world/road.h"
#include "trackbed/world/wind.h"

/// One interface and one table for everything that plans.
namespace trackbed {

/// What becomes of a plan that asks more of the car than it can do; see feasibility.h.
enum class InfeasiblePolicy {
  kSlowDown,  ///< driven more slowly where that helps, else refused
  kRefuse,    ///< no plan
  kAllow,     ///< driven as it is, to see what happens
};

/// What is to be reached, by whatever method. Planners keep no state and have no clock of their
/// own: the same values give the same plan. Only a planner with a time limit looks at the caller's
/// clock, and with one its plan depends on how fast the machine is.
struct PlanRequest {
  VehicleParams vehicle;
  std::vector<Vec2> waypoints;  ///< [m]
  /// Of the car at each waypoint [rad]; none: along the legs, see StopsOf.
  std::vector<double> headings{};
  std::vector<OrientedBox> obstacles{};  ///< that are known
  Wind wind{};                           ///< as it blows when the drive begins
  Pose2 start;                           ///< where the car is
  double start_speed = 0.0;              ///< [m/s]
  double start_steering = 0.0;           ///< of wheels and actuator there [rad]
  SpeedLimits speed;                     ///< the mission's speed and how to change it
  std::uint64_t seed = 0;                ///< of every random choice
  /// The time now [s], from any beginning; asked by planners with a time limit alone. Empty: time
  /// limits are not kept.
  std::function<double()> clock{};
  double friction = 1.0;                          ///< of the road, a factor on the tyres' own
  std::vector<FrictionPatch> friction_patches{};  ///< where it is another
  InfeasiblePolicy infeasible = InfeasiblePolicy::kSlowDown;
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
  std::vector<Gate> gates;         ///< that it leads through
  std::vector<LoneTurn> turns;     ///< whose cost to an open-loop drive can be told
  std::vector<std::string> notes;  ///< what to know of it, for people: that it was slowed down
  nlohmann::json diagnostics;      ///< the method's own findings, as in plan.json
  std::vector<RrtStarNode> tree;   ///< of every RRT or RRT* that was used, one after the other

  [[nodiscard]] bool ok() const { return status == PlanStatus::kOk; }
};

/// The shortest curves between the stops of a route, of Dubins (dubins.h).
struct DubinsOptions {
  std::optional<double> radius;  ///< of every arc [m]; none: a tenth more than the car's smallest
  double safe_distance = 0.3;    ///< of the outline from obstacles [m], >= 0
  double min_speed = 0.3;        ///< no step of curvature is taken more slowly [m/s]
};

/// And of Reeds and Shepp (reeds_shepp.h).
struct ReedsSheppOptions {
  std::optional<double> radius;
  double safe_distance = 0.3;
  double min_speed = 0.3;
};

/// A* from waypoint to waypoint (astar.h), its corners rounded or refused (corners.h).
struct AStarOptions {
  Corners corners = Corners::kRound;
  double safe_distance = 0.3;  ///< of the outline from obstacles [m], >= 0
  double corner_room = 1.0;    ///< that the search keeps besides, for rounded corners [m], >= 0
  double cell = 0.5;           ///< [m], > 0
  double margin = 10.0;        ///< around waypoints and obstacles [m], within which to look
  double min_speed = 0.5;      ///< no corner is taken more slowly [m/s]
  int budget = 1000000;        ///< cells to look at, for each leg, >= 0
};

/// RRT from waypoint to waypoint (rrt.h), smoothed in the wind (smoothing.h), the points left out
/// that make it no better, its corners rounded or refused (corners.h). Of several trees the way
/// that the comparator prefers (comparator.h), of those that the car can drive. Where none reaches
/// the goal and a partial path is taken (Plan::partial), the one that gets nearest to the first
/// waypoint not reached: to its tree's node nearest to that, or, where the car cannot stand there
/// because its front reaches further than its rear axle, to the last node before at which it can.
struct RrtPlannerOptions {
  Corners corners = Corners::kRound;
  double safe_distance = 0.3;      ///< of the outline from obstacles [m], >= 0
  double corner_room = 1.0;        ///< that the trees keep besides, for rounded corners [m], >= 0
  double margin = 10.0;            ///< around waypoints and obstacles [m], within which to sample
  double lead_in = 4.0;            ///< straight on from the start, at most [m], >= 0; 0: none
  double min_speed = 0.5;          ///< no corner is taken more slowly [m/s]
  int trees = 10;                  ///< > 0
  int iterations = 10000;          ///< samples at most, for each leg of each tree, >= 0
  double expand_distance = 2.0;    ///< length of an edge at most [m], > 0
  double goal_bias = 0.05;         ///< share of samples at the goal, 0 to 1
  double data_weight = 0.1;        ///< alpha of the smoothing
  double smoothness_weight = 0.4;  ///< beta; 0 < alpha + 2 beta < 1
  double corner_cost = 5.0;        ///< of a corner, in meters of way [m], >= 0
  double wind_weight = 1.0;        ///< k_w: how much wind counts, in meters of way, >= 0
  /// After this time by PlanRequest::clock [s] no tree grows any more, > 0; none: no limit.
  /// Smoothing and rounding come on top of it.
  std::optional<double> time_limit{};
  /// Whether a partial path is taken; none: if there is a time limit.
  std::optional<bool> partial{};
};

/// The options of one planner; which alternative it holds says which planner is meant.
using PlannerOptions =
    std::variant<FilletOptions, LaneChangePlannerOptions, CourseOptions, DubinsOptions,
                 ReedsSheppOptions, AStarOptions, HybridAStarOptions, RrtPlannerOptions>;

struct PlannerEntry {
  const char* name;
  const char* summary;
  PlannerOptions defaults;
  std::size_t fewest_waypoints;  ///< that it can plan with; 0: it needs no route
  bool keeps_clear = false;      ///< it knows obstacles and keeps clear of them itself
  bool has_headings = false;     ///< it leads through the waypoints with headings
  bool goes_backwards = false;   ///< it may
  bool searches = false;         ///< as long as its budget lasts; so it finds ways round
  bool has_ties = false;         ///< of ways that cost the same it takes any, mirrored or not
  bool is_random = false;        ///< another seed, another plan
};

/// Every planner there is.
const std::vector<PlannerEntry>& Planners();

/// The name of the planner that `options` belong to.
const char* PlannerName(const PlannerOptions& options);

/// The entry of the planner that `options` belong to.
const PlannerEntry& PlannerFor(const PlannerOptions& options);

/// Whether a plan with these options may lead backwards somewhere.
bool MayGoBackwards(const PlannerOptions& options);

/// Whether a plan with these options may lead only part of the way (Plan::partial).
bool MayBePartial(const PlannerOptions& options);

/// How many waypoints the planner that `options` belong to needs.
std::size_t FewestWaypoints(const PlannerOptions& options);

/// Where a route leads through: the car's start, then every waypoint but the first, with its
/// heading; without given ones along the last leg at the goal, and from the stop before to the stop
/// after on the way.
std::vector<Pose2> StopsOf(const PlanRequest& request);

/// Plans with the planner that `options` belong to, and makes the plan feasible (feasibility.h).
/// Never throws for a mission that cannot be planned; InternalError for one that the caller should
/// have refused (a non-finite number).
Plan MakePlan(const PlanRequest& request, const PlannerOptions& options);

}  // namespace trackbed
