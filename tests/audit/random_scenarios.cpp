// Random scenarios for the audit, reproducible by index.
//
// The index selects planner, controller and plant in turn. A Mersenne Twister seeded by the index
// draws the rest: the car's size, the route and the start, replanning, obstacles, friction, ground,
// weather, disturbances and expectations.

#include "tests/audit/random_scenarios.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "tests/audit/dice.h"
#include "tests/support/waypoint_planners.h"
#include "trackbed/control/controllers.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/path_files/path_file.h"
#include "trackbed/planning/avoidance/avoidance.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/course/course.h"
#include "trackbed/planning/course/lane_change.h"
#include "trackbed/planning/grid/astar_planner.h"
#include "trackbed/planning/grid/hybrid_astar.h"
#include "trackbed/planning/path_file/path_file_planner.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/planning/replan/along_route.h"
#include "trackbed/planning/sampling/rrt_planner.h"
#include "trackbed/scenario/disturbances.h"

namespace audit {
namespace {

using namespace trackbed;

constexpr double kPi = 3.14159265358979323846;

/// Two thirds of the entries are the fast plants without forces; the other third has each tyre law
/// once.
constexpr std::array kPlantsInTurn{"kinematic",    "single_track",   "kinematic",
                                   "single_track", "mujoco:contact", "mujoco:magic_formula"};

std::vector<ControllerOptions> PathFollowers() {
  std::vector<ControllerOptions> options;
  for (const ControllerEntry& entry : Controllers()) {
    if (entry.needs_plan) {
      options.push_back(entry.defaults);
    }
  }
  return options;
}

struct Generator {
  Dice dice;
  Scenario scenario{};
  double size = 1.0;  ///< size of the car and its surroundings, relative to full size

  void Vehicle() {
    const std::size_t which = dice.Below(8);
    if (which < 2) {
      scenario.vehicle.model = TRACKBED_SOURCE_DIR "/tests/data/models/small_car.xml";
      size = 0.12;
    } else {
      scenario.vehicle.model = which < 4 ? "bmw320i" : "prius";
    }
  }

  void Drive(bool with_forces) {
    DriveSpec& drive = scenario.drive;
    drive.timestep = with_forces ? dice.Choose(std::array{0.001, 0.002, 0.002, 0.004, 0.005})
                                 : dice.Choose(std::array{0.001, 0.002, 0.005});
    const double period =
        dice.Choose(std::array{0.01, 0.02, 0.02, 0.02, 0.05, 0.05, 0.1, 0.2, 0.5});
    drive.control_period = drive.timestep * std::round(period / drive.timestep);
    drive.time_limit = 40.0;
    scenario.mission.speed = size < 1.0 ? dice.Logarithmic(0.2, 2.5) : dice.Logarithmic(0.5, 15.0);
    if (dice.Chance(0.2)) {
      scenario.control.speed.acceleration = dice.Between(0.5, 3.0);
      scenario.control.speed.deceleration = dice.Between(0.5, 5.0);
    }
  }

  /// Legs with random turns, mostly below a right angle, sometimes any angle.
  void Route(std::size_t fewest, bool has_headings) {
    MissionSpec& mission = scenario.mission;
    const bool close = dice.Chance(0.12);
    const std::size_t count = std::max(fewest, close ? 2 : 2 + dice.Below(3));
    double heading = dice.Between(-kPi, kPi);
    Vec2 at(dice.Between(-20.0, 20.0), dice.Between(-20.0, 20.0));
    mission.waypoints.push_back(at);
    // Short enough for the time limit, and at most 80 m.
    const double longest =
        std::min({80.0 * size, 22.0 * mission.speed + 2.0 * size}) / static_cast<double>(count - 1);
    for (std::size_t i = 1; i < count; ++i) {
      const double length = close ? dice.Between(0.5, 6.0) * size
                                  : dice.Between(0.25, 1.0) * std::max(longest, 2.0 * size);
      at += length * Vec2(std::cos(heading), std::sin(heading));
      mission.waypoints.push_back(at);
      heading += dice.Chance(0.7) ? dice.Between(-1.2, 1.2) : dice.Between(-3.0, 3.0);
    }
    if (has_headings && dice.Chance(0.6)) {
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t from = std::min(i, count - 2);
        const Vec2 leg = mission.waypoints[from + 1] - mission.waypoints[from];
        const double along = std::atan2(leg.y(), leg.x());
        mission.headings.push_back(dice.Chance(0.8) ? along + dice.Between(-0.6, 0.6)
                                                    : dice.Between(-kPi, kPi));
      }
    }
  }

  /// The default start rolls along the first leg at the mission's speed with straight wheels.
  void Start() {
    StartSpec& start = scenario.mission.start;
    if (dice.Chance(0.35)) {
      return;
    }
    if (dice.Chance(0.5)) {
      start.speed = 0.0;
    } else if (dice.Chance(0.5)) {
      start.speed = scenario.mission.speed * dice.Between(0.2, 1.8);
    }
    const StartState given = InitialState(scenario);
    if (dice.Chance(0.2)) {
      start.yaw =
          dice.Chance(0.7) ? given.pose.yaw + dice.Between(-0.6, 0.6) : dice.Between(-kPi, kPi);
    }
    if (dice.Chance(0.1)) {
      start.x = given.pose.x + size * dice.Between(-2.0, 2.0);
      start.y = given.pose.y + size * dice.Between(-2.0, 2.0);
    }
    if (dice.Chance(0.15)) {
      start.steering = dice.Between(-0.25, 0.25);
    }
  }

  void Course(CourseOptions& course) {
    const std::size_t count = 1 + dice.Below(4);
    const double sharpest = dice.Logarithmic(0.02, 0.2) / size;
    double before = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      CoursePiece piece;
      piece.length = size * dice.Between(3.0, 15.0);
      const double curvature = dice.Chance(0.3) ? 0.0 : dice.Between(-sharpest, sharpest);
      if (dice.Chance(0.5)) {
        piece.curvature = curvature;
      } else {
        piece.curvature_from = before;
        piece.curvature_to = curvature;
      }
      before = curvature;
      course.segments.push_back(piece);
    }
  }

  /// The points of a path from a different program, with some noise.
  void PathOfFile(PathFileOptions& options) {
    Pose2 pose{dice.Between(-20.0, 20.0), 0.0, dice.Between(-kPi, kPi)};
    const double step = size * dice.Between(0.3, 1.0);
    const double sharpest = dice.Logarithmic(0.02, 0.2) / size;
    double curvature = 0.0;
    PathPoints given;
    const std::size_t count = 20 + dice.Below(40);
    for (std::size_t i = 0; i < count; ++i) {
      given.points.push_back(pose.position() +
                             0.01 * step * Vec2(dice.Between(-1.0, 1.0), dice.Between(-1.0, 1.0)));
      curvature =
          std::clamp(curvature + 0.3 * sharpest * dice.Between(-1.0, 1.0), -sharpest, sharpest);
      pose.yaw += curvature * step;
      pose = {pose.x + step * std::cos(pose.yaw), pose.y + step * std::sin(pose.yaw), pose.yaw};
    }
    options.file = kPathCsv;
    options.fit.max_deviation = size * dice.Between(0.01, 0.1);
    options.path = std::make_shared<const FittedPath>(FitPath(std::move(given), options.fit));
  }

  void Planner(const PlannerEntry& entry) {
    scenario.plan = PlanSpec{};
    scenario.plan->global = entry.defaults;
    PlannerOptions& global = scenario.plan->global;
    if (auto* course = global.GetIf<CourseOptions>()) {
      Course(*course);
    } else if (auto* path = global.GetIf<PathFileOptions>()) {
      PathOfFile(*path);
    } else if (auto* lane_change = global.GetIf<LaneChangePlannerOptions>()) {
      lane_change->standard = LaneChangeStandard::kIso3888_2;
      lane_change->lead_in = dice.Between(1.0, 10.0);
      lane_change->lead_out = 2.0;
    } else if (auto* hybrid = global.GetIf<HybridAStarOptions>()) {
      hybrid->reverse = dice.Chance(0.5);
      hybrid->budget = 10000;
    } else if (auto* rrt = global.GetIf<RrtPlannerOptions>()) {
      rrt->trees = 3;
      rrt->iterations = 3000;
    } else if (auto* astar = global.GetIf<AStarOptions>()) {
      astar->budget = 100000;
    }
    if (entry.min_waypoints > 0) {
      Route(entry.min_waypoints, entry.has_headings);
    } else if (!global.Is<PathFileOptions>()) {  // the path file defines its own start
      scenario.mission.start.x = dice.Between(-20.0, 20.0);
      scenario.mission.start.yaw = dice.Between(-kPi, kPi);
    }
  }

  /// Replanning, for a fraction of the plans that only drive forward.
  void Layers() {
    PlanSpec& plan = *scenario.plan;
    if (MayGoBackwards(plan.global)) {
      return;
    }
    if (dice.Chance(0.15)) {
      std::vector<AvoiderOptions> avoiders;  // other planners may drive into known obstacles
      for (const AvoiderEntry& entry : LocalPlanners()) {
        if (entry.keeps_clear) {
          avoiders.push_back(entry.defaults);
        }
      }
      plan.avoid = avoiders[dice.Below(avoiders.size())];
    }
    if (dice.Chance(0.25)) {
      ReplanOptions replan;
      if (dice.Chance(0.8)) {
        replan.along = AlongMethods()[dice.Below(AlongMethods().size())].defaults;
      }
      if (!replan.along || dice.Chance(0.3)) {
        AStarOptions detour;
        detour.budget = 100000;
        replan.detour = detour;
      }
      plan.replan = replan;
    }
  }

  /// A point on the route, or ahead of a car without a route.
  Vec2 OnTheWay() {
    const MissionSpec& mission = scenario.mission;
    if (mission.waypoints.size() < 2) {
      const Pose2 start = InitialState(scenario).pose;
      return start.position() +
             size * dice.Between(8.0, 40.0) * Vec2(std::cos(start.yaw), std::sin(start.yaw));
    }
    const std::size_t leg = dice.Below(mission.waypoints.size() - 1);
    const double share = dice.Between(0.1, 1.0);
    return (1.0 - share) * mission.waypoints[leg] + share * mission.waypoints[leg + 1];
  }

  void Obstacles() {
    if (dice.Chance(0.45)) {
      return;
    }
    const std::size_t count = 1 + dice.Below(3);
    const Vec2 start = InitialState(scenario).pose.position();
    for (std::size_t i = 0; i < count; ++i) {
      Obstacle obstacle;
      Vec2 at = OnTheWay() + size * Vec2(dice.Between(-5.0, 5.0), dice.Between(-5.0, 5.0));
      obstacle.footprint.length = size * dice.Logarithmic(0.2, 5.0);
      obstacle.footprint.width = size * dice.Logarithmic(0.05, 3.0);
      obstacle.height = size;
      obstacle.footprint.center.yaw = dice.Between(-kPi, kPi);
      const double chance = dice.Between(0.0, 1.0);
      const double heading = dice.Between(-kPi, kPi);
      const Vec2 direction(std::cos(heading), std::sin(heading));
      if (chance < 0.2) {
        obstacle.velocity = size * dice.Between(0.2, 4.0) * direction;
        at -= obstacle.velocity * dice.Between(0.0, 8.0);
      } else if (chance < 0.4) {
        // The obstacle is so thin and fast that it can cross the car between two control periods.
        obstacle.footprint.length = size * 0.05;
        obstacle.footprint.center.yaw = heading;
        obstacle.velocity = size * dice.Between(20.0, 80.0) * direction;
        at -= obstacle.velocity * dice.Between(0.5, 8.0);
      }
      obstacle.footprint.center.x = at.x();
      obstacle.footprint.center.y = at.y();
      if (dice.Chance(0.25)) {
        obstacle.known_from_range = size * dice.Between(2.0, 30.0);
      } else if (dice.Chance(0.1)) {
        obstacle.known_from_time = dice.Between(0.0, 5.0);
      }
      if ((at - start).norm() > 7.0 * size) {
        scenario.world.obstacles.push_back(obstacle);
      }
    }
  }

  /// A grade, or a bump or banked section on the car's way. Moving obstacles require flat ground,
  /// so they suppress it.
  void Ground() {
    if (!dice.Chance(0.15)) {
      return;
    }
    trackbed::Ground& ground = scenario.world.ground;
    const double chance = dice.Between(0.0, 1.0);
    if (chance < 0.4) {
      ground.grade = {dice.Between(-0.2, 0.2), dice.Between(-0.2, 0.2)};
    }
    const Vec2 at = OnTheWay();
    const Pose2 place{at.x(), at.y(), dice.Between(-kPi, kPi)};
    if (chance >= 0.3 && chance < 0.7) {
      ground.bumps.push_back({.area = {place, 4.0 * size, 6.0 * size},
                              .height = size * dice.Between(0.02, 0.15),
                              .edge = 2.0 * size});
    }
    if (chance >= 0.6) {
      ground.side_slopes.push_back({.area = {place, 30.0 * size, 8.0 * size},
                                    .slope = dice.Between(-0.1, 0.1),
                                    .transition_length = 10.0 * size});
    }
    for (Obstacle& obstacle : scenario.world.obstacles) {
      obstacle.velocity = Vec2::Zero();
    }
  }

  void Weather() {
    if (dice.Chance(0.15)) {
      scenario.world.wind.velocity = {dice.Between(-15.0, 15.0), dice.Between(-15.0, 15.0)};
      scenario.world.wind.gusts.push_back(
          {.velocity = {dice.Between(-15.0, 15.0), dice.Between(-15.0, 15.0)},
           .from = dice.Between(0.0, 5.0),
           .duration = dice.Between(0.5, 5.0)});
    }
    if (dice.Chance(0.1)) {
      const Vec2 at = OnTheWay();
      scenario.world.friction_patches.push_back(
          {{{at.x(), at.y(), dice.Between(-kPi, kPi)}, 20.0 * size, 10.0 * size},
           dice.Between(0.15, 1.2)});
    }
  }

  /// Disturbances that the vehicle model and the controller do not know.
  void Disturbances() {
    trackbed::Disturbances& disturb = scenario.disturb;
    if (!dice.Chance(0.35)) {
      return;
    }
    if (dice.Chance(0.3)) {
      disturb.steering = {.factor = dice.Between(0.8, 1.25),
                          .delay = dice.Between(0.0, 0.2),
                          .backlash = dice.Between(0.0, 0.03)};
    }
    if (dice.Chance(0.3)) {
      disturb.noise = {.position = size * dice.Between(0.0, 0.1),
                       .heading = dice.Between(0.0, 0.03)};
    }
    if (dice.Chance(0.2)) {
      disturb.wheelbase = dice.Between(0.8, 1.25);
    }
    if (dice.Chance(0.2)) {
      disturb.speed_loss = SpeedLoss{.from = dice.Between(0.0, 8.0),
                                     .station = {},
                                     .speed = scenario.mission.speed * dice.Between(0.2, 0.9)};
    }
    if (dice.Chance(0.3)) {
      disturb.payload = Payload{.mass = {},
                                .share = dice.Between(0.05, 0.3),
                                .x = size * dice.Between(0.0, 2.0),
                                .y = size * dice.Between(-0.3, 0.3),
                                .z = {}};
    }
    if (dice.Chance(0.3)) {
      const double at = dice.Between(0.5, 8.0);
      const double side = dice.Between(-1.0, 1.0);
      // A displacement skips the poses in between, where an obstacle may be, so it is used only
      // without obstacles.
      if (scenario.world.obstacles.empty() && dice.Chance(0.5)) {
        disturb.kicks.push_back(
            {.at = at, .displacement = 0.8 * size * side, .impulse = {}, .duration = {}});
      } else {
        // An impulse of up to 1 m/s for a car of 1300 kg; mass scales with the cube of the size.
        disturb.kicks.push_back({.at = at,
                                 .displacement = {},
                                 .impulse = 1300.0 * size * size * size * side,
                                 .duration = {}});
      }
    }
  }

  void Expectations() {
    PlantExpectation& expect = scenario.expect.all;
    if (!scenario.world.obstacles.empty() && dice.Chance(0.2)) {
      expect.min_clearance = size * dice.Between(0.0, 1.0);
    }
    if (dice.Chance(0.1)) {
      expect.metrics.push_back(
          {.metric = "time", .min = {}, .max = dice.Between(5.0, 30.0), .equals = {}});
    }
  }
};

}  // namespace

std::size_t Combinations() {
  return WaypointPlanners().size() * PathFollowers().size() * kPlantsInTurn.size();
}

Scenario RandomScenario(std::size_t index, int attempt) {
  const std::vector<ControllerOptions> controllers = PathFollowers();
  const std::vector<PlannerEntry> planners = WaypointPlanners();
  const std::size_t turn = index / planners.size();
  const std::size_t place = index % planners.size();
  const PlannerEntry& planner = planners[place];
  const ControllerOptions& controller = controllers[turn % controllers.size()];
  const std::string plant =
      kPlantsInTurn[(place + turn / controllers.size()) % kPlantsInTurn.size()];
  // Adding a planner does not change the scenarios of the first planners.
  constexpr std::size_t kFirstPlanners = 8;
  const std::size_t number =
      place < kFirstPlanners ? kFirstPlanners * turn + place : 1'000'000U * place + turn;

  Generator generator{Dice(1000003U * number + static_cast<std::uint64_t>(attempt))};
  Scenario& scenario = generator.scenario;
  scenario.name = fmt::format("audit_{}", index);
  scenario.seed = number;
  scenario.control.steering = controller;
  scenario.drive.plants = {plant};
  generator.Vehicle();
  generator.Drive(plant.starts_with("mujoco"));
  generator.Planner(planner);
  generator.Start();
  generator.Layers();
  generator.Obstacles();
  if (generator.dice.Chance(0.15)) {
    scenario.world.friction = generator.dice.Between(0.15, 0.9);
  }
  if (generator.dice.Chance(0.2)) {
    scenario.expect.all.max_cross_track = generator.size * generator.dice.Between(0.1, 1.0);
  }
  generator.Ground();
  generator.Weather();
  generator.Disturbances();
  generator.Expectations();
  return scenario;
}

}  // namespace audit
