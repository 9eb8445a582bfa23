#include "trackbed/analysis/plan_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/drive/drive.h"

// The rows of plan.csv, and plans that are read again from them.
namespace trackbed {
namespace plan_table_test {

// A car starts at rest after 1.5 s, stops after 4 m, waits 3 s, and stops after 10 m. At 1 m/s^2
// and at most 2 m/s, it takes 2 s to the middle of the first 4 m and 2 s to their end, and then 2 s
// for 2 m, 1 s for 2 m at 2 m/s and 2 s for the last 2 m.
TEST(PlanTable, HasTheTimesOfStopsAndWaits) {
  Plan plan;
  plan.reference.path = Path({}, {{.length = 10.0}});
  plan.stops = {4.0};
  plan.waits = {{0.0, 1.5}, {4.0, 3.0}};
  plan.reference.speed =
      StopAtCusps(plan.reference.path, 0.0,
                  {.speed = 2.0, .acceleration = 1.0, .deceleration = 1.0}, {}, plan.stops);
  const Table table = PlanTable(plan);
  const std::vector<double> s = table.Column("s_m");
  const std::vector<double> t = table.Column("t_s");
  std::vector<double> waits;  // stations of two successive rows at the same place
  for (std::size_t i = 0; i < s.size(); ++i) {
    if (i > 0 && s[i] == s[i - 1]) {
      waits.push_back(s[i]);
      continue;
    }
    double expected = 13.5 - std::sqrt(2.0 * std::max(0.0, 10.0 - s[i]));
    if (s[i] == 0.0) {
      expected = 0.0;
    } else if (s[i] <= 2.0) {
      expected = 1.5 + std::sqrt(2.0 * s[i]);
    } else if (s[i] <= 4.0) {
      expected = 5.5 - std::sqrt(2.0 * (4.0 - s[i]));
    } else if (s[i] <= 6.0) {
      expected = 8.5 + std::sqrt(2.0 * (s[i] - 4.0));
    } else if (s[i] <= 8.0) {
      expected = 10.5 + 0.5 * (s[i] - 6.0);
    }
    // Next to a stop, a rounding error of 1e-15 m changes the time by its root, 3e-8 s.
    EXPECT_NEAR(t[i], expected, Tolerance(1e-7)) << "at " << s[i];
  }
  EXPECT_EQ(waits, (std::vector<double>{0.0, 4.0}));
  EXPECT_NEAR(t.back(), plan.Duration(), Tolerance(1e-9));
}

FeasiblePlan PlanFile(const TempFolder& folder, const std::string& file) {
  const Scenario scenario = ParseScenario(
      "schema: 1\nname: again\nmission: {speed: 2}\nplan: {method: path_file, file: " + file +
          ", speeds: file}\n",
      "test.yaml", folder.path());
  return PlanScenario(scenario, LoadCar(scenario).params());
}

// The file's car waits 2 s at the start, 4 s after 8 m, and 3 s where it turns back after 16 m.
TEST(PlanTable, KeepsTheWaitsOfAPathFile) {
  const TempFolder folder;
  folder.Write("p.csv",
               "t,x,y,v\n0,0,0,0\n2,0,0,0\n6,4,0,2\n10,8,0,0\n14,8,0,0\n18,12,0,2\n22,16,0,0\n"
               "25,16,0,0\n29,14,0,-1\n33,12,0,0\n");
  const FeasiblePlan first = PlanFile(folder, "p.csv");
  ASSERT_TRUE(first.ok()) << first->reason;
  ASSERT_EQ(first->waits.size(), 3U);
  folder.Write("plan.csv", PlanTable(*first).ToCsv());
  const FeasiblePlan again = PlanFile(folder, "plan.csv");
  ASSERT_TRUE(again.ok()) << again->reason;
  ASSERT_EQ(again->waits.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    // The second fit may move a station by max_deviation.
    EXPECT_NEAR(again->waits[i].s, first->waits[i].s, Tolerance(0.05));
    EXPECT_NEAR(again->waits[i].duration, first->waits[i].duration, Tolerance(1e-6));
  }
}

}  // namespace plan_table_test
}  // namespace trackbed
