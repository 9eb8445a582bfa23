#include "src/control/turn_round.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "src/control/tracking.h"
#include "tests/control/loop.h"
#include "tests/tolerance.h"
#include "trackbed/control/pure_pursuit.h"
#include "trackbed/core/angle.h"

// A target behind the car: full lock on the shorter side until the car faces its path.
namespace trackbed {
namespace turn_round_test {

Path Straight(int direction = 1) {
  return {{}, {{300.0, 0.0, direction}}};
}

/// Calls the controller for a car beside a straight.
class Car {
 public:
  Car(const ControllerOptions& options, const Path& path)
      : controller_(MakeSteeringController(options)),
        reference_{path, SpeedProfile({{0.0, 3.0}})} {}

  double Steer(const Pose2& pose, double speed = 3.0) {
    const double station = reference_.path.Project(pose, {0.0, 60.0}).s;
    VehicleState state;
    state.pose = pose;
    state.speed = speed;
    return controller_->Steer({.vehicle = car_,
                               .reference = reference_,
                               .schedule = {},
                               .state = state,
                               .station = station,
                               .period = 0.02});
  }

 private:
  VehicleParams car_ = ReferenceCar();
  std::unique_ptr<SteeringController> controller_;
  Reference reference_;
};

class TurnsRound : public ::testing::TestWithParam<ControllerEntry> {};

TEST_P(TurnsRound, FromAnyHeadingAndOffset) {
  // While the wheels turn to full lock, the car drives at most v delta_max/omega. On the circle of
  // full lock, the car moves away from any line by at most one more radius. From an offset of 3 m,
  // the controllers may first drive toward the path for at most their preview distance.
  const VehicleParams car = ReferenceCar();
  const double speed = 1.0;
  const double turning = speed * car.steering_limit / car.steering_rate + car.min_turning_radius();
  for (int eighth = -3; eighth <= 4; ++eighth) {
    for (const double offset : {0.0, 3.0}) {
      SCOPED_TRACE(fmt::format("{} eighths of a turn, {} m", eighth, offset));
      LoopSetup setup;
      setup.path = Straight();
      setup.start = {50.0, offset, eighth * kPi / 4.0};
      setup.speed = speed;
      setup.duration = 80.0;
      const std::vector<LoopRow> rows = Loop(GetParam().defaults, setup);
      double rearmost = setup.start.x;
      for (const LoopRow& row : rows) {
        rearmost = std::min(rearmost, row.state.pose.x);
      }
      EXPECT_GT(rearmost, setup.start.x - turning);
      EXPECT_LT(LargestOffset(rows, rows.size() * 9 / 10), 0.1);
      EXPECT_LT(std::abs(rows.back().tracking.heading_error), 0.05);
    }
  }
}

TEST_P(TurnsRound, ToOneSideUnderNoise) {
  // The sign of the heading error jumps between two measurements; the side of the turn must not.
  Car car(GetParam().defaults, Straight());
  const double first = car.Steer({50.0, 0.0, kPi - 0.02});
  ASSERT_NE(first, 0.0);
  double last = first;
  for (int i = 0; i < 20; ++i) {
    const double noise = (i % 2 == 0 ? 0.04 : -0.04) - 0.001 * i;
    const double command = car.Steer({50.0, 0.0, kPi + noise});
    EXPECT_GE(std::abs(command), std::abs(last));
    EXPECT_GT(command * first, 0.0);
    last = command;
  }
}

TEST_P(TurnsRound, ToTheShorterSideInBothGears) {
  // The shorter side is the left if the car must turn to the left by slightly less than pi. A car
  // in reverse turns its heading to the left with its wheels to the right.
  for (const int direction : {1, -1}) {
    for (const double side : {1.0, -1.0}) {
      SCOPED_TRACE(fmt::format("direction {}, side {}", direction, side));
      Car car(GetParam().defaults, Straight(direction));
      const Pose2 start = Straight(direction).At(50.0).pose;
      const double command =
          car.Steer({start.x, start.y, start.yaw - side * (kPi - 0.1)}, direction * 3.0);
      EXPECT_GT(direction * side * command, 0.0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Feedback, TurnsRound, ::testing::ValuesIn(FollowersWithFewSamples()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(TurnRound, StepsToFullLockAndEndsWhenTheTargetIsNotBehind) {
  const VehicleParams car = ReferenceCar();
  Car pursuit(PurePursuitOptions{.distance = 4.0}, Straight());
  for (const double yaw : {1.6, 2.0, 3.0, 3.14159}) {
    EXPECT_EQ(pursuit.Steer({50.0, 0.0, yaw}), -car.steering_limit) << yaw;
  }
  // On the path, the angle is u = -psi. For headings psi within 90 degrees, the law is that of pure
  // pursuit.
  EXPECT_NEAR(pursuit.Steer({50.0, 0.0, 0.2}),
              -std::atan(2.0 * car.wheelbase * std::sin(0.2) / 4.0), Tolerance(1e-11));
}

TEST(TurnRound, LeavesAHairpinToTheLaw) {
  // A hairpin of radius 2 m, whose legs are 4 m apart. 1 m before the hairpin, the first point of
  // the path at a distance of 7 m is on the returning leg behind the car, at the angle u with sin u
  // = 4/7.
  const Path hairpin{{}, {{20.0, 0.0, 1}, {2.0 * kPi, 0.5, 1}, {40.0, 0.0, 1}}};
  Car car(PurePursuitOptions{.distance = 7.0}, hairpin);
  const VehicleParams params = ReferenceCar();
  EXPECT_NEAR(car.Steer({19.0, 0.0, 0.0}), std::atan(2.0 * params.wheelbase * (4.0 / 7.0) / 7.0),
              Tolerance(1e-10));
}

}  // namespace turn_round_test
}  // namespace trackbed
