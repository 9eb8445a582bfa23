#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/vehicle/reference_car.h"
#include "trackbed/drive/drive.h"
#include "trackbed/planning/common/plan.h"

// Tests the note about a start that faces away from the path.
namespace trackbed {
namespace turn_round_note_test {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<std::string> Notes(double yaw, const std::string& obstacles) {
  const Scenario scenario = ParseScenario(
      fmt::format("schema: 1\nname: round\nvehicle: {{model: prius}}\n"
                  "mission: {{waypoints: [[0, 0], [60, 0], [60, 60]], start: {{yaw: {}, speed: "
                  "0}}, speed: 3}}\n"
                  "plan: {{method: fillet, infeasible: allow}}\nworld: {{obstacles: [{}]}}\n",
                  yaw, obstacles),
      "round.yaml", "");
  const FeasiblePlan plan = PlanScenario(scenario, ReferenceCar());
  EXPECT_TRUE(plan.ok()) << plan->reason;
  return plan->notes;
}

TEST(TurnRoundNote, SaysTheSideAndTheRadius) {
  // The smallest turning radius of the reference car is 5.1 m.
  EXPECT_THAT(
      Notes(3.1, ""),
      Contains(HasSubstr("178 deg off) and turns round to the right, on a radius of 5.1 m")));
  EXPECT_THAT(Notes(-2.0, ""), Contains(HasSubstr("115 deg off) and turns round to the left")));
  EXPECT_THAT(Notes(1.5, ""), Not(Contains(HasSubstr("turns round"))));
}

TEST(TurnRoundNote, SaysThatRoomIsMissing) {
  // A car that faces -x has +y on its right. The car turns about the point (-1, 5.1). Its outer
  // front corner moves on the radius hypot(5.1 + 1.725/2, 4.45 - 0.825) = 7 m, so the leftmost
  // point of this corner is near x = -8.
  const std::string in_the_way = "{box: {x: -6, y: 5, yaw: 0, length: 2, width: 2, height: 1}}";
  EXPECT_THAT(Notes(3.1, in_the_way),
              Contains(AllOf(HasSubstr("but meets an obstacle after"), HasSubstr("reeds_shepp"))));
  const std::string on_the_other_side =
      "{box: {x: -6, y: -8, yaw: 0, length: 2, width: 2, height: 1}}";
  EXPECT_THAT(Notes(3.1, on_the_other_side), Not(Contains(HasSubstr("but meets an obstacle"))));
}

}  // namespace turn_round_note_test
}  // namespace trackbed
