// Compares whole scenarios on the linear single-track car with the kinematic car and MuJoCo's.

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
  // Turns of radius 29 m cause a lateral acceleration of 0.33 m/s^2. The cornering stiffness of the
  // rear tyres is 20 times their load, so their slip angle is 1.7 mrad. With a preview distance of
  // 2.5 m, this is equivalent to an offset from the path of 4.2 mm. Understeer of K u^2/L = 1.1 %
  // adds 1.1 % of 2.5^2/(2 x 29) m to this offset, which is 1.2 mm. At the beginning and the end of
  // a turn, the offset is larger by half.
  EXPECT_THAT(run, StaysWithin("kinematic", "single_track", Tolerance(0.008)));
  // MuJoCo's servo lags by 10 ms, so the steering angle errs by up to 1.5 mrad while the wheels
  // turn. The feedback compensates this error at an offset of 2.5^2/(2 x 2.7) m x 1.5 mrad, which
  // is 1.7 mm. From a turn to the left to one to the right, the wheels turn twice in the same
  // direction, so the offset may double. The camber thrust of the tyres has a smaller effect.
  EXPECT_THAT(run, StaysWithin("single_track", "mujoco:magic_formula", Tolerance(0.0035)));
}

TEST(SingleTrack, UndersteersAsMujocosCarOnItsTyresDoes) {
  const RunResult run = RunScenario(
      File("steering_circle"), {"drive.plants=[kinematic, single_track, 'mujoco:magic_formula']",
                                "expect={}", "mission.speed=15", "mission.duration=8",
                                "control.steering=0.02", "mission.start.steering=0.02"});
  // Over 120 m at 1.3 m/s^2, the car turns by 0.7 rad. At this acceleration, the tyres of the Prius
  // lose 1 % of their stiffness, and body roll causes camber thrust. Both change the yaw rate by
  // 1.5 %, and the heading by 10 mrad at the end and 5 mrad on average.
  EXPECT_THAT(run, StaysWithin("single_track", "mujoco:magic_formula", Tolerance(0.6)));
  // Without slip the turn is tighter by K u^2/L, 27 %.
  EXPECT_THAT(run, testing::Not(StaysWithin("kinematic", "single_track", 5.0)));
}

}  // namespace single_track_test
}  // namespace trackbed
