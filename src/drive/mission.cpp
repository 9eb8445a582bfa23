#include "src/drive/mission.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "src/drive/plan_remedies.h"
#include "src/drive/replanning_monitor.h"
#include "src/drive/scenario_parts.h"
#include "trackbed/control/controllers.h"
#include "trackbed/core/angle.h"
#include "trackbed/drive/start_overlap.h"
#include "trackbed/planning/avoidance/avoidance.h"
#include "trackbed/planning/common/collision_checker.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/long_leg.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/waypoint_miss.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/road_network/open_drive.h"
#include "trackbed/scenario/initial_state.h"
#include "trackbed/vehicle/steering_reach.h"

// Plans the mission of a scenario before the run.
// 1. Refuses a start at which the car overlaps an obstacle (StartOverlap).
// 2. Makes the PlanRequest from the scenario's waypoints, road, limits, and obstacles known at the
//    start.
// 3. MakePlan calls the planner and checks whether the car can drive the plan. If planning fails,
//    PlanRemedies finds changes of the mission that lead to a plan.
// 4. Adds notes to the plan on slow turns, missed waypoints, obstacles on the path, turning round
//    at the start, and control without feedback.
// 5. With plan.avoid, PlanAround changes the plan so that it passes around the known obstacles.
namespace trackbed {
namespace {

/// Adds a note to the plan if a turn is slower than the mission's speed and the plan has no other
/// notes.
void NoteSlowTurns(FeasiblePlan& plan, double speed) {
  const auto slowest =
      std::min_element(plan->caps.begin(), plan->caps.end(),
                       [](const SpeedCap& a, const SpeedCap& b) { return a.speed < b.speed; });
  // Fraction of the mission's speed below which a turn is reported as slower.
  constexpr double kNotedFraction = 0.99;
  if (plan->notes.empty() && slowest != plan->caps.end() &&
      slowest->speed < kNotedFraction * speed) {
    plan.AddNote(fmt::format("speed reduced to {:.3g} m/s in a turn at s = {:.4g} m",
                             slowest->speed, slowest->from));
  }
}

/// Adds a note to the plan if plans made during the run would omit its stops or waits.
void NoteStops(FeasiblePlan& plan, const Scenario& scenario) {
  std::vector<double> stations = plan->stops;
  for (const PlannedWait& wait : plan->waits) {
    stations.push_back(wait.s);
  }
  if (stations.empty() || (!scenario.plan->avoid && !scenario.plan->replan)) {
    return;
  }
  std::sort(stations.begin(), stations.end());
  stations.erase(std::unique(stations.begin(), stations.end()), stations.end());
  plan.AddNote(
      fmt::format("plans that {} makes around obstacles do not stop or wait at s = {:.4g} m",
                  scenario.plan->avoid ? "plan.avoid" : "plan.replan", fmt::join(stations, ", ")));
}

/// Adds to the plan the notes about the file of the track or roads.
void NoteInputs(FeasiblePlan& plan, const Scenario& scenario) {
  if (scenario.mission.track) {
    for (const std::string& note : scenario.mission.track->notes) {
      plan.AddNote(fmt::format("{}: {}", scenario.mission.track->file, note));
    }
  }
  if (scenario.world.road_network && scenario.world.road_network->data) {
    for (const std::string& note : scenario.world.road_network->data->network.notes) {
      plan.AddNote(fmt::format("{}: {}", scenario.world.road_network->file, note));
    }
  }
}

/// Adds a note to the plan if the path hits an obstacle, which may happen with planners that ignore
/// obstacles.
void NoteObstacle(FeasiblePlan& plan, const VehicleParams& vehicle,
                  const std::vector<OrientedBox>& known) {
  const CollisionChecker touching(vehicle, known, 0.0);
  if (const std::optional<double> s = touching.FirstBlocked(plan->reference.path)) {
    plan.AddNote(fmt::format("the path hits an obstacle at s = {:.4g} m", *s));
  }
}

/// Adds a note to the plan if the path passes a waypoint at a distance of more than a car length.
/// NoteMissedWaypoint adds no note to a blocked or partial plan, which already states where the
/// plan ends.
void NoteMissedWaypoint(FeasiblePlan& plan, const VehicleParams& vehicle) {
  const auto miss = LargestWaypointMiss(plan->reference.path, plan->waypoints);
  if (miss && miss->distance > vehicle.length && plan->blocked.empty() && plan->partial.empty()) {
    plan.AddNote(fmt::format(
        "{} is missed by {:.4g} m, at s = {:.4g} m; plan.max_waypoint_miss bounds this distance",
        DescribeWaypoint(miss->waypoint, miss->at), miss->distance, miss->station));
  }
}

/// Adds a note to the plan if the path makes a long detour between two successive waypoints. A long
/// detour exceeds the straight line by at least a full circle with the car's smallest turning
/// radius. NoteLongLeg adds no note in a world with obstacles, around which detours are common.
void NoteLongLeg(FeasiblePlan& plan, const VehicleParams& vehicle, const Scenario& scenario,
                 const std::vector<OrientedBox>& known) {
  if (vehicle.kind != VehicleKind::kSteered || !known.empty() || !plan->blocked.empty() ||
      !plan->partial.empty()) {
    return;
  }
  const double circle = 2.0 * kPi * vehicle.min_turning_radius();
  if (const auto leg = LongestLeg(plan->reference.path, plan->waypoints, circle)) {
    const auto describe = [&](std::size_t i) { return DescribeWaypoint(i, plan->waypoints[i]); };
    plan.AddNote(fmt::format(
        "the path from {} to {} is about {:.3g} m long instead of {:.3g} m: the car turns on a "
        "radius of at least {:.3g} m, and its wheels need time to turn; move these waypoints "
        "apart, or leave one of them out{}",
        describe(leg->to - 1), describe(leg->to), leg->length, leg->straight,
        vehicle.min_turning_radius(),
        scenario.mission.headings.empty() ? "" : ", or change mission.headings"));
  }
}

/// Adds a note to the plan if the run's time limit ends before the plan.
void NoteTimeLimit(FeasiblePlan& plan, double time_limit) {
  const double duration = plan->Duration();
  if (duration >= time_limit) {
    plan.AddNote(fmt::format(
        "the plan takes {:.5g} s, but drive.time_limit ends the run after {:.5g} s; set "
        "drive.time_limit: {:.0f}",
        duration, time_limit, std::ceil(1.1 * duration)));
  }
}

bool IsStraight(const Path& path) {
  const std::vector<Segment>& segments = path.segments();
  return std::all_of(segments.begin(), segments.end(), [](const Segment& segment) {
    return segment.curvature == 0.0 && segment.sharpness == 0.0 && segment.sharpness_rate == 0.0;
  });
}

/// Adds a note to the plan if a controller without feedback drives bends on tyres that slip.
void NoteOpenLoop(FeasiblePlan& plan, const Scenario& scenario) {
  const ControllerEntry& controller = ControllerFor(scenario.control.steering);
  std::vector<std::string> slipping = scenario.drive.plants;
  std::erase(slipping, "kinematic");
  if (!controller.needs_plan || controller.station != StationSource::kOdometer ||
      slipping.empty() || IsStraight(plan->reference.path)) {
    return;
  }
  plan.AddNote(fmt::format(
      "the controller {} corrects no error: where tyres slip, as in {}, the car leaves its path "
      "in bends and may miss its goal; control: {{method: preview}} corrects errors",
      controller.name, fmt::join(slipping, ", ")));
}

/// Returns the path of a car that turns round to the shorter side until it has the heading of the
/// path point `to`. On the returned path, the wheels turn from straight ahead to full lock at their
/// maximum rate.
Path TurnRoundPath(const VehicleParams& vehicle, const StartState& start, const PathPoint& to,
                   double speed) {
  const double turn = AngleDifference(to.pose.yaw, start.pose.yaw);
  const double reach = SteeringReach(vehicle, 0.0);
  const double tightest = CurvatureForSteering(vehicle, reach);
  const double curvature = to.direction * std::copysign(tightest, turn);
  const double ramp = speed * reach / vehicle.steering_rate;
  const double arc = std::abs(turn) / tightest - 0.5 * ramp;
  std::vector<Segment> segments{
      {.length = ramp, .direction = to.direction, .sharpness = curvature / ramp}};
  if (arc > 0.0) {
    segments.push_back({.length = arc, .curvature = curvature, .direction = to.direction});
  }
  return {start.pose, segments};
}

/// If the car starts with its back to the path, adds a note on where it turns round, and whether an
/// obstacle is in its way.
void NoteTurnRound(FeasiblePlan& plan, const VehicleParams& vehicle, const StartState& start,
                   const SpeedControlOptions& speed, const std::vector<OrientedBox>& known) {
  if (plan->reference.path.length() == 0.0 || vehicle.kind != VehicleKind::kSteered) {
    return;
  }
  const PathPoint to = plan->reference.path.At(0.0);
  const double turn = AngleDifference(to.pose.yaw, start.pose.yaw);
  if (std::cos(turn) >= 0.0) {
    return;
  }
  // Assume the speed that the speed control holds before the path's start: the start speed plus
  // `acceleration`/`gain` of the speed control.
  const Path path =
      TurnRoundPath(vehicle, start, to, std::abs(start.speed) + speed.acceleration / speed.gain);
  std::string note = fmt::format(
      "the car starts with its back to the path ({:.0f} deg off) and turns round to the {}, on a "
      "radius of {:.4g} m",
      std::abs(turn) * 180.0 / kPi, turn > 0.0 ? "left" : "right", vehicle.min_turning_radius());
  if (const std::optional<double> s = CollisionChecker(vehicle, known, 0.0).FirstBlocked(path)) {
    note += fmt::format(
        ", but meets an obstacle after {:.3g} m: start farther away from it, or let "
        "plan.global: {{method: reeds_shepp}} turn round in reverse gear",
        *s);
  }
  plan.AddNote(std::move(note));
}

/// Returns the maximum distance of the path from the waypoints [m], or nullopt if the distance is
/// not limited.
std::optional<double> MaxWaypointMiss(const PlanSpec& plan, const VehicleParams& vehicle) {
  const bool is_bounded = PlannerFor(plan.global).bounds_waypoint_miss && vehicle.length > 0.0;
  return plan.max_waypoint_miss || !is_bounded ? plan.max_waypoint_miss
                                               : std::optional(vehicle.length);
}

/// Returns the obstacles and walls that are known at the start. In a run with replanning, skips
/// moving obstacles, because the replanner handles them.
std::vector<OrientedBox> KnownAtStart(const Scenario& scenario, const VehicleParams& vehicle,
                                      const Pose2& start) {
  std::vector<OrientedBox> known;
  for (const Obstacle& obstacle : scenario.world.obstacles) {
    const bool for_later = obstacle.moves() && scenario.plan->replan;
    if (!for_later && IsKnown(obstacle, 0.0, FootprintAt(vehicle, start))) {
      known.push_back(obstacle.footprint);
    }
  }
  const std::vector<OrientedBox>& walls = MapWalls(scenario.world);
  known.insert(known.end(), walls.begin(), walls.end());
  return known;
}

/// Returns the distinct friction coefficients in a world.
std::vector<double> Roads(const World& world) {
  std::vector<double> roads{world.friction};
  for (const FrictionPatch& patch : world.friction_patches) {
    if (std::find(roads.begin(), roads.end(), patch.friction) == roads.end()) {
      roads.push_back(patch.friction);
    }
  }
  return roads;
}

/// Returns a failed plan with the given status and the reason `reason`.
FeasiblePlan Refused(PlanStatus status, std::string reason, const PlanRequest& request) {
  Plan plan;
  plan.status = status;
  plan.reason = std::move(reason);
  return MakeFeasible(std::move(plan), request);
}

/// Adds to the failure reason of a plan the changes of the scenario that lead to a plan.
FeasiblePlan WithRemedies(FeasiblePlan plan, const PlanRequest& request, const Scenario& scenario) {
  const std::vector<std::string> remedies =
      PlanRemedies(plan->status, request, *scenario.plan, MapWalls(scenario.world));
  return remedies.empty()
             ? std::move(plan)
             : Refused(plan->status, fmt::format("{}; {}", plan->reason, fmt::join(remedies, "; ")),
                       request);
}

/// Returns the plan of a mission without a path: a car that drives at the mission's speed.
FeasiblePlan WithoutPath(const Scenario& scenario, const VehicleParams& vehicle) {
  Plan plan;
  plan.reference.speed = SpeedProfile({{0.0, MissionSpeed(scenario)}});
  plan.schedule_speed = plan.reference.speed;
  return MakeFeasible(std::move(plan), RequestOn({}, vehicle, MakeSpeedLimits(scenario)));
}

/// Returns the data for planning speeds at the car's limit, or nullopt if the mission does not ask
/// for such speeds. The function `diagram` returns the g-g-v diagram for given friction
/// coefficients.
std::optional<SpeedAtLimit> LimitsFor(const Scenario& scenario, const DiagramOfRoads& diagram) {
  const auto& profile = scenario.mission.speed_profile;
  const auto* limits = profile ? std::get_if<LimitProfileOptions>(&*profile) : nullptr;
  if (limits == nullptr || !scenario.plan) {
    return std::nullopt;
  }
  return SpeedAtLimit{diagram(Roads(scenario.world)), *limits, scenario.world.ground};
}

}  // namespace

FeasiblePlan PlanMission(const Scenario& scenario, const VehicleParams& vehicle,
                         const DiagramOfRoads& diagram) {
  std::optional<SpeedAtLimit> limits = LimitsFor(scenario, diagram);
  const StartState start = InitialState(scenario, vehicle);
  if (std::string why = StartOverlap(scenario, vehicle); !why.empty()) {
    return Refused(PlanStatus::kStartBlocked, std::move(why),
                   RequestOn({}, vehicle, MakeSpeedLimits(scenario)));
  }
  if (!scenario.plan) {
    return WithoutPath(scenario, vehicle);
  }
  std::vector<OrientedBox> known = KnownAtStart(scenario, vehicle, start.pose);
  const auto begin = std::chrono::steady_clock::now();
  const PlanRequest request{
      .vehicle = vehicle,
      .waypoints = scenario.mission.waypoints,
      .headings = scenario.mission.headings,
      .obstacles = known,
      .wind = scenario.world.wind,
      .start = start.pose,
      .start_speed = start.speed,
      .start_steering = start.steering,
      .speed = MakeSpeedLimits(scenario),
      .seed = scenario.seed,
      .clock =
          [begin] {
            return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
          },
      .friction = scenario.world.friction,
      .friction_patches = scenario.world.friction_patches,
      .ground = scenario.world.ground,
      .on_track = TrackOf(scenario),
      .lanes = LaneMissionOf(scenario),
      .infeasible = scenario.plan->infeasible,
      .max_waypoint_miss = MaxWaypointMiss(*scenario.plan, vehicle),
      .limits = std::move(limits)};
  FeasiblePlan plan = MakePlan(request, scenario.plan->global);
  if (!plan.ok()) {
    return WithRemedies(std::move(plan), request, scenario);
  }
  NoteSlowTurns(plan, request.speed.speed);
  NoteTurnRound(plan, vehicle, start, scenario.control.speed, known);
  NoteStops(plan, scenario);
  if (!scenario.plan->avoid) {
    NoteOpenLoop(plan, scenario);
    if (!scenario.plan->replan) {
      NoteObstacle(plan, vehicle, known);
    }
    NoteMissedWaypoint(plan, vehicle);
    NoteLongLeg(plan, vehicle, scenario, known);
    NoteTimeLimit(plan, scenario.drive.time_limit);
    NoteInputs(plan, scenario);
    return plan;
  }
  std::erase_if(known, [&](const OrientedBox& box) {
    return !IsForAvoider(MakeReplanningConfig(scenario), vehicle, plan->reference.path, 0.0, box);
  });
  plan = PlanAround({.vehicle = vehicle,
                     .plan = plan,
                     .speed = MakeSpeedLimits(scenario),
                     .obstacles = known,
                     .station = 0.0,
                     .station_speed = start.speed,
                     .car = {},
                     .seed = scenario.seed,
                     .road = {.friction = request.friction,
                              .friction_patches = request.friction_patches,
                              .ground = request.ground,
                              .infeasible = request.infeasible,
                              .limits = request.limits}},
                    *scenario.plan->avoid);
  if (plan.ok()) {
    NoteOpenLoop(plan, scenario);
    NoteMissedWaypoint(plan, vehicle);
    NoteTimeLimit(plan, scenario.drive.time_limit);
    NoteInputs(plan, scenario);
  }
  return plan;
}

}  // namespace trackbed
