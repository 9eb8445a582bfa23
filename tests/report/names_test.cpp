#include "trackbed/report/names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace trackbed {
namespace {

TEST(NameOfMetric, SaysWhatPeopleSay) {
  EXPECT_EQ(NameOfMetric("cross_track.max").label, "Maximum cross-track error");
  EXPECT_EQ(NameOfMetric("cross_track.max").unit, "m");
  EXPECT_TRUE(NameOfMetric("cross_track.max").headline);
  EXPECT_FALSE(NameOfMetric("cross_track.rms").headline);
  EXPECT_EQ(NameOfMetric("turns[1].heading_deficit").label, "Turn 2: heading deficit");
  EXPECT_EQ(NameOfMetric("turns[1].heading_deficit").unit, "rad");
  EXPECT_EQ(NameOfMetric("maneuver.margin").label, "Maneuver: minimum gate margin");
  EXPECT_EQ(NameOfMetric("maneuver.margin").unit, "m");
  EXPECT_EQ(NameOfMetric("maneuver.understeer_gradient").unit, "rad s²/m");
  // A metric registered by another program uses its path as label.
  EXPECT_EQ(NameOfMetric("other.metric").label, "other.metric");
}

TEST(NameOfOutput, SaysOfWhichPlant) {
  EXPECT_EQ(NameOfOutput("metrics.mujoco:contact.goal_distance").label,
            "Distance to the goal (mujoco:contact)");
  EXPECT_EQ(NameOfOutput("metrics.*.goal_distance").label, "Distance to the goal");
  EXPECT_EQ(NameOfOutput("metrics.kinematic.cross_track.max_s").label,
            "cross_track.max_s (kinematic)");
  EXPECT_EQ(NameOfOutput("between.kinematic.mujoco.position.max").label,
            "Maximum distance (kinematic – mujoco)");
  EXPECT_EQ(NameOfOutput("between.kinematic.mujoco.heading.max").unit, "rad");
  EXPECT_EQ(NameOfOutput("plan.length_m").unit, "m");
  EXPECT_EQ(NameOfOutput("verdict.passed").label, "verdict.passed");
}

TEST(NameOfKey, HasTheUnitOfTheKeyTable) {
  EXPECT_EQ(NameOfKey("mission.speed").unit, "m/s");
  EXPECT_EQ(NameOfKey("seed").unit, "");
  EXPECT_EQ(NameOfKey("control.distance").unit, "m");
  EXPECT_EQ(NameOfKey("mission.waypoints[1]").label, "mission.waypoints[1]");
  // The keys are those of a list element, and of a section in a list element.
  EXPECT_EQ(NameOfKey("world.wind.gusts[0].y").unit, "m/s");
  EXPECT_EQ(NameOfKey("world.obstacles[12].known_from.range").unit, "m");
}

}  // namespace
}  // namespace trackbed
