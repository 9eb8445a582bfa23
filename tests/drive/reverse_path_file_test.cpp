#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/drive/drive.h"
#include "trackbed/planning/common/plan.h"

// Paths with reverse pieces from files, driven: the car parks where the file ends.
namespace trackbed {
namespace {

/// The car drives past a gap, backs into the gap on two arcs, and then drives a little ahead.
Path ParallelParking() {
  return Path({0.0, 0.0, 0.0}, {{.length = 6.0},
                                {.length = 3.5, .curvature = -0.13, .direction = -1},
                                {.length = 3.5, .curvature = 0.13, .direction = -1},
                                {.length = 0.8}});
}

/// A file of the path with points 0.2 m apart. `kind`: "speed", "gear" or "yaw".
std::string FileOf(const Path& path, const std::string& kind) {
  std::string text = "x,y," + kind + "\n";
  for (const Stations& leg : SplitIntoLegs(path)) {
    const int direction = path.At(0.5 * (leg.from + leg.to)).direction;
    const double count = std::ceil((leg.to - leg.from) / 0.2);
    for (double i = leg.from == 0.0 ? 0.0 : 1.0; i <= count; i += 1.0) {
      const Pose2 pose = path.At(std::lerp(leg.from, leg.to, i / count)).pose;
      const std::string cell = kind == "speed"  ? fmt::format("{}", i == count ? 0 : direction)
                               : kind == "gear" ? (direction > 0 ? "D" : "R")
                                                : fmt::format("{}", pose.yaw);
      text += fmt::format("{},{},{}\n", pose.x, pose.y, cell);
    }
  }
  return text;
}

class ReversePathFile : public ::testing::TestWithParam<std::string> {};

TEST_P(ReversePathFile, Parks) {
  const Path path = ParallelParking();
  const Pose2 goal = path.At(path.length()).pose;
  for (const std::string kind : {"speed", "gear", "yaw"}) {
    SCOPED_TRACE(kind);
    const TempFolder folder;
    folder.Write("p.csv", FileOf(path, kind));
    const Scenario scenario = ParseScenario(
        fmt::format("schema: 1\nname: park\nmission: {{speed: 1, start: {{speed: 0}}}}\n"
                    "plan: {{method: path_file, file: p.csv, speeds: {}}}\n"
                    "drive: {{plants: [{}]}}\n",
                    kind == "speed" ? "file" : "mission", GetParam()),
        "test.yaml", folder.path());
    const CarModel car = LoadCar(scenario);
    const FeasiblePlan plan = PlanScenario(scenario, car.params());
    ASSERT_TRUE(plan.ok()) << plan->reason;
    EXPECT_EQ(SplitIntoLegs(plan->reference.path).size(), 3U);
    const RunLog log = SimulateScenario(scenario, car, plan, GetParam());
    EXPECT_EQ(log.status, DriveStatus::kArrived);
    const Pose2& end = log.rows.back().state.pose;
    // Over a leg of 0.8 m or more, the fit may move the path by 0.05 m, which changes the heading
    // at the last point. The speed controller stops within 0.1 m.
    EXPECT_LE((end.position() - goal.position()).norm(), Tolerance(0.1));
    EXPECT_LE(std::abs(AngleDifference(end.yaw, goal.yaw)), Tolerance(0.06));
    for (const LogRow& row : log.rows) {
      EXPECT_LE(std::abs(row.tracking->cross_track), 0.1);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Plants, ReversePathFile, ::testing::Values("kinematic", "mujoco"),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace trackbed
