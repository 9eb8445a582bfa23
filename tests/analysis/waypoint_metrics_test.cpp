// Tests the distances of plans and runs from waypoints, on artificial logs and in scenarios.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/tolerance.h"
#include "trackbed/analysis/metric_registry.h"
#include "trackbed/analysis/run.h"
#include "trackbed/control/steering_controller.h"

namespace trackbed {
namespace waypoint_metrics_test {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// A car that drives from (0, 0) to (10, 0) and then to (10, 10), with a log row every 5 m and 5 s.
RunLog AroundACorner() {
  RunLog log{.plant = "made_up", .configurations = Table({"t_s"})};
  for (const Vec2& at : {Vec2(0, 0), Vec2(5, 0), Vec2(10, 0), Vec2(10, 5), Vec2(10, 10)}) {
    LogRow row;
    row.state.time = 5.0 * static_cast<double>(log.rows.size());
    row.state.distance = row.state.time;
    row.state.pose = {at.x(), at.y(), 0.0};
    log.rows.push_back(row);
  }
  return log;
}

PlantMetrics MeasureNear(const RunLog& log, const std::vector<Vec2>& waypoints) {
  Plan plan;
  plan.reference.path = Path({}, {{.length = 10.0}});
  plan.waypoints = waypoints;
  VehicleParams vehicle;
  vehicle.wheelbase = 2.5;
  return Measure(log, plan, vehicle, 0.02, StationSource::kProjection);
}

TEST(WaypointMetrics, AreThoseOfTheLinesBetweenLogRows) {
  const PlantMetrics metrics = MeasureNear(AroundACorner(), {{0, 50}, {2, 1}, {13, 7}, {10, 10}});
  ASSERT_TRUE(metrics.waypoint_miss.has_value());
  // (13, 7) is 3 m from the point (10, 7), which the car passes after 17 m. The plan ends at
  // (10, 0), and is farthest from (10, 10).
  EXPECT_EQ(metrics.waypoint_miss->waypoint, 2);
  EXPECT_NEAR(metrics.waypoint_miss->max, 3.0, Tolerance(1e-12));
  EXPECT_NEAR(metrics.waypoint_miss->max_s, 17.0, Tolerance(1e-12));
  EXPECT_NEAR(metrics.waypoint_miss->max_t, 17.0, Tolerance(1e-12));
  EXPECT_NEAR(metrics.waypoint_miss->planned, 10.0, Tolerance(1e-12));
  const nlohmann::ordered_json json = ToJson(metrics)["waypoint_miss"];
  EXPECT_NEAR(json["max"].get<double>(), 3.0, Tolerance(1e-12));
  EXPECT_EQ(json["waypoint"], 2);
}

TEST(WaypointMetrics, EndAtTheFirstContact) {
  RunLog log = AroundACorner();
  log.contact_time = 12.0;
  EXPECT_NEAR(MeasureNear(log, {{0, 0}, {10, 10}}).waypoint_miss->max, 10.0, Tolerance(1e-12));
}

TEST(WaypointMetrics, AreMissingWithoutWaypoints) {
  EXPECT_FALSE(MeasureNear(AroundACorner(), {}).waypoint_miss.has_value());
}

RunResult Drive(const std::string& plan, const std::string& waypoints) {
  return RunScenario(
      ParseScenario("schema: 1\nname: miss\nmission: {speed: 3, waypoints: " + waypoints +
                        "}\nplan: " + plan + "\ndrive: {plants: [kinematic], time_limit: 400}\n",
                    "miss.yaml", "."));
}

const char* const kHairpin = "[[0, 0], [60, 0], [0, 20]]";

TEST(WaypointMetrics, NoteAWaypointThatIsMissedByACarLength) {
  const RunResult far = Drive("{method: fillet}", "[[0, 0], [300, 0], [0, 40]]");
  ASSERT_EQ(far.metrics.size(), 1U);
  const WaypointMissMetrics& miss = *far.metrics[0].waypoint_miss;
  EXPECT_EQ(miss.waypoint, 1);
  EXPECT_GT(miss.planned, 100.0);
  EXPECT_NEAR(miss.max, miss.planned, Tolerance(0.5));  // a controlled car leaves its path by less
  EXPECT_THAT(far.verdict.notes,
              Contains(HasSubstr("plan: waypoint 1 at (300, 0) is missed by 1")));
  const RunResult near = Drive("{method: fillet}", "[[0, 0], [60, 0], [90, 20]]");
  EXPECT_LT(near.metrics[0].waypoint_miss->planned, 4.0);
  EXPECT_THAT(near.verdict.notes, Not(Contains(HasSubstr("is missed"))));
}

TEST(WaypointMetrics, OfSearchesAreAtMostACarLengthUnlessAsked) {
  for (const std::string method : {"astar", "rrt", "rrt_star"}) {
    const RunResult run = Drive("{method: " + method + "}", kHairpin);
    ASSERT_TRUE(run.plan.ok()) << method << ": " << run.plan->reason;
    EXPECT_LE(run.metrics[0].waypoint_miss->planned, run.vehicle.length) << method;
    EXPECT_TRUE(run.verdict.passed) << method;
  }
  const RunResult free = Drive("{method: astar, max_waypoint_miss: 100}", kHairpin);
  EXPECT_GT(free.metrics[0].waypoint_miss->planned, 20.0);
  EXPECT_THAT(free.verdict.notes, Contains(HasSubstr("plan: waypoint 1 at (60, 0) is missed by")));
}

TEST(WaypointMetrics, OfFilletAreBoundedIfAsked) {
  const RunResult refused =
      Drive("{method: fillet, max_waypoint_miss: 4}", "[[0, 0], [300, 0], [0, 40]]");
  EXPECT_EQ(refused.plan->status, PlanStatus::kWaypointMissed);
  EXPECT_THAT(refused.plan->reason, HasSubstr("waypoint 1 at (300, 0) is missed by "));
  // In this hairpin, the smallest arc has no room on legs of 60 m, whatever the bound.
  const RunResult tight = Drive("{method: fillet, max_waypoint_miss: 4}", kHairpin);
  EXPECT_EQ(tight.plan->status, PlanStatus::kTurnTooTight);
  EXPECT_THAT(tight.plan->reason, HasSubstr("turn of 161.6 deg at waypoint 1"));
  const RunResult near =
      Drive("{method: fillet, max_waypoint_miss: 4}", "[[0, 0], [60, 0], [60, 60]]");
  ASSERT_TRUE(near.plan.ok()) << near.plan->reason;
  EXPECT_LE(near.metrics[0].waypoint_miss->planned, 4.0 + Tolerance(1e-9));
}

}  // namespace waypoint_metrics_test
}  // namespace trackbed
