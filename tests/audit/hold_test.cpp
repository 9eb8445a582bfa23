// Checks the plans of all planners, with all layers that replan during the run, against the limits
// of the road.
//
// Each planner drives one random route on roads of four kinds, each with one or two of three
// slopes, with and without a payload, past a box that becomes known during the run. All plans are
// checked from the rows of plan.csv: v^2 kappa, braking and driving against friction, patches and
// gravity. The check shares no code with the program (check_plan.cpp).

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <string>
#include <tuple>
#include <vector>

#include "tests/audit/checker.h"
#include "tests/audit/random_scenarios.h"
#include "tests/audit/record_run.h"
#include "tests/support/waypoint_planners.h"
#include "trackbed/core/error.h"
#include "trackbed/drive/drive.h"
#include "trackbed/planning/avoidance/avoidance.h"
#include "trackbed/planning/grid/astar_planner.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/planning/replan/along_route.h"
#include "trackbed/planning/sampling/rrt_planner.h"
#include "trackbed/planning/sampling/rrt_star_planner.h"

namespace audit {
namespace {

using namespace trackbed;

/// A layer that replans during the run.
struct Layer {
  std::string name;
  std::function<void(PlanSpec&)> add;
};

void AddDetour(PlanSpec& plan, PlannerOptions planner) {
  plan.replan.emplace().detour = std::move(planner);
}

std::vector<Layer> Layers() {
  std::vector<Layer> layers{{"none", [](PlanSpec&) {}}};
  for (const AvoiderEntry& entry : LocalPlanners()) {
    layers.push_back({entry.name, [=](PlanSpec& plan) { plan.avoid = entry.defaults; }});
  }
  for (const AlongEntry& entry : AlongMethods()) {
    layers.push_back(
        {entry.name, [=](PlanSpec& plan) { plan.replan.emplace().along = entry.defaults; }});
  }
  layers.push_back(
      {"astar", [](PlanSpec& plan) { AddDetour(plan, AStarOptions{.budget = 50000}); }});
  layers.push_back({"rrt", [](PlanSpec& plan) {
                      AddDetour(plan, RrtPlannerOptions{.trees = 2, .iterations = 500});
                    }});
  layers.push_back({"rrt_star", [](PlanSpec& plan) {
                      AddDetour(plan, RrtStarPlannerOptions{.trees = 1, .iterations = 300});
                    }});
  return layers;
}

/// Friction factors of the whole road. The last entry stands for a split road, which is slippery to
/// the left of the route.
constexpr std::array kRoads{0.15, 0.3, 0.5, 0.0};
constexpr std::array<std::array<double, 2>, 3> kGrades{{{0.0, 0.0}, {-0.08, 0.03}, {0.08, -0.05}}};

/// The random route of a planner, without other random settings. The route is long enough that the
/// box on the way does not overlap the car at the start.
Scenario RouteFor(std::size_t planner) {
  Scenario scenario = RandomScenario(planner, 0);
  for (int attempt = 1; attempt < 50; ++attempt) {
    scenario.world = World{};
    scenario.disturb = Disturbances{};
    scenario.expect = Expectations{};
    scenario.plan->avoid.reset();
    scenario.plan->replan.reset();
    scenario.mission.start.yaw.reset();
    scenario.mission.start.steering.reset();
    scenario.drive.plants = {"kinematic"};
    scenario.drive.timestep = 0.005;
    scenario.drive.control_period = 0.05;
    scenario.drive.time_limit = 20.0;
    try {
      CheckScenario(scenario);
      const CarModel car = LoadCar(scenario);
      const FeasiblePlan plan = PlanScenario(scenario, car);
      if (plan.ok() && plan->reference.path.length() > 3.0 * car.params().length) {
        return scenario;
      }
    } catch (const InputError&) {
    }
    scenario = RandomScenario(planner, attempt);
  }
  return scenario;
}

/// A box beside the middle of the route, known from some distance.
Obstacle BoxOnTheWay(const Path& path, double length) {
  const Pose2 beside = path.At(0.6 * path.length()).pose;
  const Vec2 at = ToWorld(beside, {0.0, 0.2 * length});
  Obstacle box;
  box.footprint = {{at.x(), at.y(), beside.yaw}, 0.3 * length, 0.3 * length};
  box.known_from_range = 3.0 * length;
  return box;
}

class WhatARoadHolds : public testing::TestWithParam<std::tuple<std::size_t, std::size_t>> {};

INSTANTIATE_TEST_SUITE_P(
    EveryPlannerAndLayer, WhatARoadHolds,
    testing::Combine(testing::Range<std::size_t>(0, WaypointPlanners().size()),
                     testing::Range<std::size_t>(0, Layers().size())),
    [](const testing::TestParamInfo<std::tuple<std::size_t, std::size_t>>& param) {
      return fmt::format("{}_{}", WaypointPlanners()[std::get<0>(param.param)].name,
                         Layers()[std::get<1>(param.param)].name);
    });

TEST_P(WhatARoadHolds, IsNotExceededByAnyPlan) {
  const auto [planner, layer] = GetParam();
  const Scenario route = RouteFor(planner);
  if (layer > 0 && MayGoBackwards(route.plan->global)) {
    GTEST_SKIP() << "reverse segments are not replanned";
  }
  const CarModel car = LoadCar(route);
  const FeasiblePlan alone = PlanScenario(route, car);
  ASSERT_TRUE(alone.ok()) << alone->reason;
  std::size_t planned = 0;
  for (std::size_t road = 0; road < kRoads.size(); ++road) {
    // Each layer has every second pair of a road and a slope; the next planner has the other pairs.
    for (std::size_t slope = (road + planner + layer) % 2; slope < kGrades.size(); slope += 2) {
      Scenario scenario = route;
      Layers()[layer].add(*scenario.plan);
      scenario.world.ground.grade = {kGrades[slope][0], kGrades[slope][1]};
      scenario.world.friction = kRoads[road] > 0.0 ? kRoads[road] : 0.6;
      if (kRoads[road] == 0.0) {
        const Pose2 middle = alone->reference.path.At(0.5 * alone->reference.path.length()).pose;
        const double length = car.params().length;
        // The right edge of the patch is 0.05 lengths to the right of the route. On a straight
        // route that coincides with the edge, rounding would decide which points are on the patch.
        const Vec2 left = ToWorld(middle, {0.0, 0.7 * length});
        scenario.world.friction_patches = {
            {{{left.x(), left.y(), middle.yaw}, 4.0 * length, 1.5 * length}, 0.2}};
      }
      if (layer > 0) {
        scenario.world.obstacles = {BoxOnTheWay(alone->reference.path, car.params().length)};
      }
      if ((road + slope) % 2 == 1) {
        scenario.disturb.payload = Payload{.mass = {}, .share = 0.3, .x = 0.0, .y = 0.0, .z = {}};
      }
      const Record record = RecordRun(scenario);
      planned += record.plan_ok ? 1U : 0U;
      for (const Finding& finding : Check(record)) {
        if (finding.kind.starts_with("plan_")) {
          ADD_FAILURE() << fmt::format("friction {}, grade {}, {}: [{}] {}", kRoads[road],
                                       kGrades[slope][0], kGrades[slope][1], finding.kind,
                                       finding.text);
        }
      }
    }
  }
  EXPECT_GT(planned, 0U);  // steep slopes on slippery roads are refused
}

}  // namespace
}  // namespace audit
