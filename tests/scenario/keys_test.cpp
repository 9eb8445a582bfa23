#include "trackbed/scenario/keys.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "trackbed/control/controllers.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/scenario/maneuver.h"

namespace trackbed {
namespace {

const KeySection* FindSection(const std::vector<KeySection>& sections, const std::string& key,
                              const std::string& method = "") {
  for (const KeySection& section : sections) {
    if (section.key == key && section.method == method) {
      return &section;
    }
  }
  return nullptr;
}

KeyInfo FindKey(const std::string& section, const std::string& name,
                const std::string& method = "") {
  const std::vector<KeySection> sections = ScenarioKeys();
  const KeySection* found = FindSection(sections, section, method);
  EXPECT_NE(found, nullptr) << section;
  for (const KeyInfo& key : found != nullptr ? found->keys : std::vector<KeyInfo>{}) {
    if (key.name == name) {
      return key;
    }
  }
  ADD_FAILURE() << "no key " << section << "." << name;
  return {};
}

TEST(ScenarioKeys, TellTypeUnitDefaultAndWhatIsAllowed) {
  const KeyInfo speed = FindKey("mission", "speed");
  EXPECT_EQ(speed.type, "number");
  EXPECT_EQ(speed.unit, "m/s");
  EXPECT_FALSE(speed.required);
  EXPECT_EQ(speed.fallback, "");
  EXPECT_EQ(speed.allowed, "at least 0.1 and at most 100");
  EXPECT_EQ(FindKey("drive", "plants").fallback, "[kinematic, mujoco]");
  EXPECT_EQ(FindKey("drive", "timestep").fallback, "0.002");
  EXPECT_EQ(FindKey("render", "size").fallback, "[1280, 720]");
  EXPECT_EQ(FindKey("", "control").fallback, "{method: preview}");
  EXPECT_EQ(FindKey("control", "distance", "preview").fallback, "");
  EXPECT_EQ(FindKey("plan", "constraint", "fillet").allowed, "steering_room, half_leg, none");
  EXPECT_EQ(FindKey("plan", "time_limit", "rrt").unit, "s");
  EXPECT_EQ(FindKey("plan", "time_limit", "rrt").allowed, "above 0 and at most 1000000");
  EXPECT_EQ(FindKey("plan", "time_limit", "rrt").fallback, "");
  EXPECT_EQ(FindKey("plan", "partial", "rrt").type, "true or false");
  EXPECT_EQ(FindKey("plan.avoid", "inner_width", "listing").unit, "m");
  EXPECT_EQ(FindKey("plan.avoid", "grid", "listing").fallback, "true");
  EXPECT_EQ(FindKey("world.obstacles[N].box", "length").unit, "m");
  EXPECT_TRUE(FindKey("world.obstacles[N].box", "length").required);
  EXPECT_EQ(FindKey("world.wind.gusts[N]", "shape").fallback, "one_minus_cosine");
  EXPECT_EQ(FindKey("world.wind.gusts[N].area", "length").unit, "m");
  EXPECT_EQ(FindKey("control.speed", "over_time").type, "list of knots [t, v]");
  EXPECT_TRUE(FindKey("control.speed.braking", "deceleration").required);
  EXPECT_FALSE(FindKey("expect", "mujoco").required);
}

TEST(ScenarioKeys, EachHasALineOfText) {
  for (const KeySection& section : ScenarioKeys()) {
    EXPECT_FALSE(section.text.empty()) << section.key;
    for (const KeyInfo& key : section.keys) {
      EXPECT_FALSE(key.text.empty()) << section.key << "." << key.name;
      EXPECT_EQ(key.text.find('\n'), std::string::npos) << section.key << "." << key.name;
    }
  }
}

TEST(ScenarioKeys, EveryMethodHasItsSection) {
  const std::vector<KeySection> sections = ScenarioKeys();
  for (const PlannerEntry& planner : Planners()) {
    EXPECT_NE(FindSection(sections, "plan", planner.name), nullptr) << planner.name;
  }
  for (const ControllerEntry& controller : Controllers()) {
    EXPECT_NE(FindSection(sections, "control", controller.name), nullptr) << controller.name;
  }
  for (const ManeuverEntry& maneuver : Maneuvers()) {
    EXPECT_NE(FindSection(sections, "maneuver", maneuver.name), nullptr) << maneuver.name;
  }
}

}  // namespace
}  // namespace trackbed
