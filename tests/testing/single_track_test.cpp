// Whole scenarios on the linear single-track car, compared with the kinematic car and MuJoCo's.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tolerance.h"
#include "trackbed/testing/scenario_testing.h"

namespace trackbed {
namespace single_track_test {

std::filesystem::path File(const std::string& name) {
  return std::filesystem::path(TRACKBED_SOURCE_DIR) / "scenarios" / (name + ".yaml");
}

TEST(SingleTrack, DrivesAPlanLikeTheOthersAtWalkingSpeed) {
  const RunResult run =
      RunScenario(File("winding"),
                  {"drive.plants=[kinematic, single_track, 'mujoco:magic_formula']", "expect={}"});
  EXPECT_THAT(run, ReachesGoal(0.5));
  EXPECT_THAT(run, TracksWithin(0.15));
  // Turns of 29 m give 0.33 m/s^2. The rear tyres, with a cornering stiffness of 20 times their
  // load, slip by 1.7 mrad, which a preview of 2.5 m takes for a path offset of 4.2 mm. Understeer
  // of 1.1 %, K u^2/L, adds 1.1 % of 2.5^2/(2 x 29) m, 1.2 mm. Half as much again where turns begin
  // and end.
  EXPECT_THAT(run, StaysWithin("kinematic", "single_track", Tolerance(0.008)));
  // MuJoCo's servo lags by 10 ms: up to 1.5 mrad at the wheels, which is 1.5 mm over 3 m of road
  // and preview. The camber thrust of its tyres has a smaller effect.
  EXPECT_THAT(run, StaysWithin("single_track", "mujoco:magic_formula", Tolerance(0.002)));
}

TEST(SingleTrack, UndersteersAsMujocosCarOnItsTyresDoes) {
  const RunResult run = RunScenario(
      File("steering_circle"), {"drive.plants=[kinematic, single_track, 'mujoco:magic_formula']",
                                "expect={}", "mission.speed=15", "mission.duration=8",
                                "control.steering=0.02", "mission.start.steering=0.02"});
  // 120 m at 1.3 m/s^2 are 0.7 rad of turn. The Prius's tyres lose 1 % of stiffness there and get
  // camber thrust from body roll: 1.5 % of yaw rate is 10 mrad at the end, half of that on average.
  EXPECT_THAT(run, StaysWithin("single_track", "mujoco:magic_formula", Tolerance(0.6)));
  // Without slip the turn is tighter by K u^2/L, 27 %.
  EXPECT_THAT(run, testing::Not(StaysWithin("kinematic", "single_track", 5.0)));
}

}  // namespace single_track_test
}  // namespace trackbed
