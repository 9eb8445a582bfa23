#include "src/drive/replanning_monitor.h"

#include <gtest/gtest.h>

#include "tests/drive/unicycle.h"
#include "trackbed/drive/drive.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed {
namespace {

constexpr double kDelay = 0.9;  ///< default delay of the avoider [s]

VehicleParams Prius() {
  static const VehicleParams vehicle =
      CarModel(ComposeScene(FindModel("prius", ""), {}), "prius").params();
  return vehicle;
}

/// A plan of 100 m along x at 3 m/s.
FeasiblePlan StraightPlan() {
  const Scenario scenario = ParseScenario(
      "schema: 1\nname: straight\nmission: {speed: 3, waypoints: [[0, 0], [100, 0]]}\n"
      "plan: {method: dubins}\ncontrol: {method: preview}\n",
      "straight.yaml", ".");
  return PlanScenario(scenario, Prius());
}

Obstacle BoxAt(double x, double y) {
  return {.footprint = {{x, y, 0.0}, 2.0, 2.0}};
}

ReplanningMonitor::Options OptionsWith(const std::vector<Obstacle>& obstacles) {
  ReplanningMonitor::Options options;
  options.replanning.limits = kUnicycleLimits;
  options.vehicle = Prius();
  options.world.obstacles = obstacles;
  return options;
}

ReplanningMonitor::Options Avoiding(const std::vector<Obstacle>& obstacles) {
  ReplanningMonitor::Options options = OptionsWith(obstacles);
  options.replanning.avoid.emplace();
  return options;
}

/// Calls `monitor` in every control period from 0 to `end` [s] for a car that follows the plan at 3
/// m/s. Returns the time of the first new plan [s], or nullopt if there is no new plan.
std::optional<double> FirstPlan(ReplanningMonitor& monitor, const Plan& plan, double end) {
  for (long tick = 0; 0.02 * static_cast<double>(tick) <= end; ++tick) {
    VehicleState state;
    state.time = 0.02 * static_cast<double>(tick);
    state.speed = 3.0;
    state.pose = {3.0 * state.time, 0.0, 0.0};
    if (monitor.Update(state, plan, {.s = state.pose.x})) {
      return state.time;
    }
  }
  return std::nullopt;
}

TEST(ReplanningMonitor, AvoidsWhatBecomesKnownAfterTheDelay) {
  Obstacle box = BoxAt(70.0, 0.0);
  box.known_from_time = 1.0;
  const FeasiblePlan plan = StraightPlan();
  ReplanningMonitor monitor(Avoiding({box}), plan);
  // The monitor must make the new plan in the first control period at or after 1.9 s.
  const std::optional<double> time = FirstPlan(monitor, plan, 4.0);
  ASSERT_TRUE(time);
  EXPECT_NEAR(*time, 1.0 + kDelay, 1e-9);
  EXPECT_FALSE(monitor.IsWaiting());
}

TEST(ReplanningMonitor, AvoidsEachObstacleOnce) {
  Obstacle box = BoxAt(70.0, 0.0);
  box.known_from_time = 1.0;
  const FeasiblePlan plan = StraightPlan();
  ReplanningMonitor monitor(Avoiding({box}), plan);
  VehicleState state;
  state.speed = 3.0;
  int plans = 0;
  for (const double time : {0.0, 1.0, 2.0, 2.02, 3.0}) {
    state.time = time;
    state.pose.x = 3.0 * time;
    plans += monitor.Update(state, plan, {.s = state.pose.x}) ? 1 : 0;
  }
  EXPECT_EQ(plans, 1);
}

TEST(ReplanningMonitor, KnowsAnObstacleFromItsRangeOn) {
  Obstacle box = BoxAt(60.0, 0.0);
  box.known_from_range = 40.0;
  const FeasiblePlan plan = StraightPlan();
  ReplanningMonitor monitor(Avoiding({box}), plan);
  // The near side of the obstacle is at 59 m. The obstacle becomes known when the front of the car
  // is 40 m before it.
  const VehicleParams car = Prius();
  const double known = (59.0 - 40.0 - (car.length - car.rear_overhang)) / 3.0;
  const std::optional<double> time = FirstPlan(monitor, plan, 10.0);
  ASSERT_TRUE(time);
  // Detection and delay may each end up to one control period late.
  EXPECT_GE(*time, known + kDelay - 1e-9);
  EXPECT_LE(*time, known + kDelay + 0.04);
}

TEST(ReplanningMonitor, LeavesThePlanWhereNothingIsInItsWay) {
  Obstacle beside = BoxAt(50.0, 15.0);
  beside.known_from_time = 1.0;
  const FeasiblePlan plan = StraightPlan();
  ReplanningMonitor monitor(Avoiding({beside}), plan);
  EXPECT_FALSE(FirstPlan(monitor, plan, 4.0));
  // The initial plan already avoids obstacles that are known from the start.
  ReplanningMonitor from_start(Avoiding({BoxAt(70.0, 0.0)}), plan);
  EXPECT_FALSE(FirstPlan(from_start, plan, 4.0));
}

TEST(ReplanningMonitor, WaitsBehindWhatMayClearOnly) {
  // The car is at rest behind a box, on a road that is too narrow to pass. The monitor waits only
  // if the box drives away.
  for (const bool leaves : {true, false}) {
    Obstacle box = BoxAt(10.0, 0.0);
    box.velocity = leaves ? Vec2(0.2, 0.0) : Vec2::Zero();
    ReplanningMonitor::Options options = OptionsWith({box});
    ReplanOptions& replan = options.replanning.replan.emplace();
    replan.settings.road = {1.6, 1.6};
    replan.along.emplace();
    Plan plan = PlanAlongRoute({{.length = 30.0}}, 0.0);
    ReplanningMonitor monitor(options, Drivable(plan));
    VehicleState state;
    state.pose.x = 4.0;
    for (const double time : {0.0, 0.5, 1.0}) {
      state.time = time;
      if (std::optional<FeasiblePlan> next = monitor.Update(state, plan, {.s = 4.0})) {
        plan = *next;
        plan.reference.path = Path({}, {{.length = 4.01}});  // the car stands at its end
      }
    }
    EXPECT_EQ(monitor.IsWaiting(), leaves);
  }
}

TEST(IsForAvoider, IsWhatStandsInATurnWhereThereAreTwo) {
  const Path path({}, {{.length = 40.0}, {.length = 15.0, .curvature = 0.1}, {.length = 40.0}});
  const OrientedBox on_straight{{20.0, 0.0, 0.0}, 2.0, 2.0};
  const OrientedBox in_turn{path.At(47.0).pose, 2.0, 2.0};
  ReplanningConfig avoid;
  avoid.avoid.emplace();
  ReplanningConfig replan;
  replan.replan.emplace();
  ReplanningConfig both = avoid;
  both.replan.emplace();
  const auto is_for = [&](const ReplanningConfig& config, const OrientedBox& box) {
    return IsForAvoider(config, Prius(), path, 0.0, box);
  };
  EXPECT_TRUE(is_for(avoid, on_straight));
  EXPECT_TRUE(is_for(avoid, in_turn));
  EXPECT_FALSE(is_for(replan, on_straight));
  EXPECT_FALSE(is_for(replan, in_turn));
  EXPECT_FALSE(is_for(both, on_straight));
  EXPECT_TRUE(is_for(both, in_turn));
}

}  // namespace
}  // namespace trackbed
