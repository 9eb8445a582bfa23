#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/vehicle/reference_car.h"
#include "trackbed/drive/drive.h"
#include "trackbed/planning/common/plan.h"

// The note of a plan that a controller without feedback drives.
namespace trackbed {
namespace open_loop_note_test {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

std::vector<std::string> NotesOf(const std::string& method, const std::string& plants,
                                 const std::string& goal) {
  const Scenario scenario = ParseScenario(
      fmt::format("schema: 1\nname: open_loop\n"
                  "mission: {{speed: 5, waypoints: [[0, 0], [60, 0], {}]}}\n"
                  "plan: {{method: dubins}}\ncontrol: {{method: {}}}\ndrive: {{plants: {}}}\n",
                  goal, method, plants),
      "open_loop.yaml", "");
  return PlanScenario(scenario, ReferenceCar())->notes;
}

TEST(OpenLoopNote, NamesPlantsWithTyresThatSlip) {
  EXPECT_THAT(NotesOf("schedule", "[kinematic, \"mujoco:magic_formula\"]", "[60, 60]"),
              Contains(HasSubstr("as in mujoco:magic_formula, the car leaves its path")));
}

TEST(OpenLoopNote, IsAbsentWhereNothingSlips) {
  const auto note = HasSubstr("corrects no error");
  EXPECT_THAT(NotesOf("schedule", "[kinematic]", "[60, 60]"), Not(Contains(note)));
  EXPECT_THAT(NotesOf("schedule", "[mujoco]", "[120, 0]"), Not(Contains(note)));
  EXPECT_THAT(NotesOf("preview", "[mujoco]", "[60, 60]"), Not(Contains(note)));
}

}  // namespace open_loop_note_test
}  // namespace trackbed
