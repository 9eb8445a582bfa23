#include "src/analysis/road_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "tests/analysis/small_car.h"
#include "tests/road_network/documents.h"
#include "tests/tolerance.h"
#include "trackbed/analysis/run.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed {
namespace {

/// A log with one row per pose, a second apart.
RunLog LogThrough(const std::vector<Pose2>& poses) {
  RunLog log{.plant = "made_up", .configurations = Table({"t_s"})};
  for (std::size_t i = 0; i < poses.size(); ++i) {
    LogRow row;
    row.state.time = static_cast<double>(i);
    row.state.pose = poses[i];
    log.rows.push_back(row);
  }
  return log;
}

std::optional<MetricReading> MarginOf(const RoadNetwork& roads, const std::vector<Pose2>& poses) {
  Plan plan;
  plan.roads = std::make_shared<const RoadNetwork>(roads);
  const RunLog log = LogThrough(poses);
  const VehicleParams car = SmallCar();
  return SmallestRoadMargin({log, plan, car});
}

TEST(RoadMargin, IsTheDistanceOfTheFootprintFromTheNearerEdge) {
  // Lanes of 3.5 m on both sides of the x axis.
  const RoadNetwork roads = ParseNetwork(RoadText{}.Xml());
  const auto margin = MarginOf(roads, {{10.0, 0.0, 0.0}, {40.0, -1.75, 0.0}, {70.0, 2.0, 0.0}});
  ASSERT_TRUE(margin);
  EXPECT_NEAR(std::get<double>(margin->value), 3.5 - 2.0 - 0.9, Tolerance(1e-9));
  EXPECT_EQ(margin->at.t, 2.0);
  // Across the road, the front of the car is 3 m ahead of its rear axle.
  const auto across = MarginOf(roads, {{50.0, 2.0, 0.5 * kPi}});
  ASSERT_TRUE(across);
  EXPECT_NEAR(std::get<double>(across->value), 3.5 - 5.0, Tolerance(1e-9));
}

TEST(RoadMargin, HasNoEdgeAtTheEndsOfARoad) {
  const RoadNetwork roads = ParseNetwork(RoadText{}.Xml());
  const auto margin = MarginOf(roads, {{0.0, -1.75, 0.0}, {98.0, -1.75, 0.0}});
  ASSERT_TRUE(margin);
  EXPECT_NEAR(std::get<double>(margin->value), 1.75 - 0.9, Tolerance(1e-9));
}

TEST(RoadMargin, FollowsACurve) {
  RoadText curve;
  curve.geometry =
      "<geometry s=\"0\" x=\"0\" y=\"0\" hdg=\"0\" length=\"100\"><arc curvature=\"0.02\"/>"
      "</geometry>";
  // The car is on the right lane of a bend around (0, 50), at the radius 50 m + 1.75 m. The front
  // right corner is farthest outside.
  const double radius = 51.75;
  const Pose2 pose{radius * std::sin(1.0), 50.0 - radius * std::cos(1.0), 1.0};
  const auto margin = MarginOf(ParseNetwork(curve.Xml()), {pose});
  ASSERT_TRUE(margin);
  const double corner = std::hypot(radius + 0.9, 3.0);
  // The border of radius 53.5 m consists of chords, which are 0.535 m long.
  EXPECT_NEAR(std::get<double>(margin->value), 53.5 - corner,
              Tolerance(0.535 * 0.535 / (8.0 * 53.5) + 1e-9));
}

TEST(RoadMargin, TakesTheWiderOfTwoRoadsThatOverlap) {
  RoadText across;
  across.id = "2";
  across.geometry =
      "<geometry s=\"0\" x=\"50\" y=\"-50\" hdg=\"1.5707963267948966\" length=\"100\"><line/>"
      "</geometry>";
  const RoadNetwork roads = ParseNetwork(RoadText{}.Xml() + across.Xml());
  // Where the roads cross, no point of the car is beyond the edges of both.
  const auto margin = MarginOf(roads, {{50.0, 1.0, 0.5 * kPi}});
  ASSERT_TRUE(margin);
  EXPECT_NEAR(std::get<double>(margin->value), 3.5 - 0.9, Tolerance(1e-9));
}

TEST(RoadMargin, NeedsAPlanAlongLanes) {
  const RunLog log = LogThrough({{0.0, 0.0, 0.0}});
  const VehicleParams car = SmallCar();
  EXPECT_FALSE(SmallestRoadMargin({log, Plan{}, car}));
}

TEST(MinClearance, JudgesTheEdgesOfTracksAndRoads) {
  for (const char* name : {"roads/crossing", "tracks/kidney_center"}) {
    for (const char* bound : {"0.01", "100"}) {
      const RunResult run = RunScenario(ReadScenario(
          std::filesystem::path(TRACKBED_SOURCE_DIR) / "scenarios" / (std::string(name) + ".yaml"),
          {std::string("expect={min_clearance: ") + bound + "}",
           "drive.plants=[kinematic, single_track]"}));
      std::size_t checks = 0;
      for (const Check& check : run.verdict.checks) {
        if (check.name == "clearance from the edges") {
          ++checks;
          EXPECT_EQ(check.met, bound == std::string("0.01")) << name << ", " << bound;
        }
      }
      EXPECT_EQ(checks, run.metrics.size()) << name;
      EXPECT_EQ(run.verdict.passed, bound == std::string("0.01")) << name;
    }
  }
}

}  // namespace
}  // namespace trackbed
