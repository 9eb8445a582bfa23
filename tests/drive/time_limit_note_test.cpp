#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/vehicle/reference_car.h"
#include "trackbed/drive/drive.h"
#include "trackbed/planning/common/plan.h"

// Tests the note about a plan that takes longer than the run may.
namespace trackbed {
namespace time_limit_note_test {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

/// Returns the notes of a plan that leads straight on for 800 m at 1 m/s, from 1 m/s to rest. With
/// the default deceleration of 1.5 m/s^2, the last 1/3 m takes 2/3 s, so the plan takes 800 1/3 s.
std::vector<std::string> Notes(double time_limit) {
  const Scenario scenario = ParseScenario(
      fmt::format("schema: 1\nname: slow\nvehicle: {{model: prius}}\nmission: {{speed: 1}}\n"
                  "plan: {{method: straight, length: 800}}\ndrive: {{time_limit: {}}}\n",
                  time_limit),
      "slow.yaml", "");
  const FeasiblePlan plan = PlanScenario(scenario, ReferenceCar());
  EXPECT_TRUE(plan.ok()) << plan->reason;
  return plan->notes;
}

TEST(TimeLimitNote, NamesTheLimitThatIsLongEnough) {
  // 1.1 x 800.33 s, rounded up to a second
  EXPECT_THAT(Notes(600.0),
              Contains(HasSubstr("takes 800.33 s, but drive.time_limit ends the run after 600 s; "
                                 "set drive.time_limit: 881")));
  EXPECT_THAT(Notes(881.0), Not(Contains(HasSubstr("time_limit"))));
}

}  // namespace time_limit_note_test
}  // namespace trackbed
