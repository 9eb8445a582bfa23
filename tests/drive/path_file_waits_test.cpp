#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/support/case_names.h"
#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/drive/drive.h"
#include "trackbed/planning/common/plan.h"

// Tests that a car waits where its path file says so.
namespace trackbed {
namespace {

class PathFileWaits : public ::testing::TestWithParam<std::string> {};

// The file's car waits 2 s at the start, 4 s after 8 m, and 3 s where it turns back after 16 m.
TEST_P(PathFileWaits, AreDriven) {
  const TempFolder folder;
  folder.Write("p.csv",
               "t,x,y,v\n0,0,0,0\n2,0,0,0\n6,4,0,2\n10,8,0,0\n14,8,0,0\n18,12,0,2\n22,16,0,0\n"
               "25,16,0,0\n29,14,0,-1\n33,12,0,0\n");
  const Scenario scenario = ParseScenario(
      "schema: 1\nname: waits\nmission: {speed: 2}\nplan: {method: path_file, file: p.csv, speeds: "
      "file}\ndrive: {plants: [" +
          GetParam() + "]}\n",
      "test.yaml", folder.path());
  const CarModel car = LoadCar(scenario);
  const FeasiblePlan plan = PlanScenario(scenario, car.params());
  ASSERT_TRUE(plan.ok()) << plan->reason;
  const RunLog log = SimulateScenario(scenario, car, plan, GetParam());
  EXPECT_EQ(log.status, DriveStatus::kArrived);
  // Durations for which the car is at rest near a place on the x axis. Before the car moves, and
  // after it has come to rest, it may take a second to turn its wheels or to stop.
  for (const auto& [x, duration] :
       {std::pair(0.0, 2.0), std::pair(8.0, 4.0), std::pair(16.0, 3.0)}) {
    double from = -1.0;
    double to = -1.0;
    for (const LogRow& row : log.rows) {
      if (std::abs(row.state.pose.x - x) < 0.3 && std::abs(row.state.speed) < kAtRestSpeed) {
        from = from < 0.0 ? row.state.time : from;
        to = row.state.time;
      }
    }
    EXPECT_GE(to - from, duration - 0.05) << x;
    EXPECT_LE(to - from, duration + 1.0) << x;
  }
  // The kinematic car needs as long as planned, but for a second at each of the stops.
  EXPECT_NEAR(log.rows.back().state.time, plan->Duration(), 4.0);
}

INSTANTIATE_TEST_SUITE_P(Plants, PathFileWaits, ::testing::Values("kinematic", "mujoco"),
                         kNamedByParameter);

}  // namespace
}  // namespace trackbed
