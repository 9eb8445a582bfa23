#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/world/world.h"

// Tests obstacles that move through poses.
namespace trackbed {
namespace {

/// A box that drives 10 m east in 2 s, turns left by 0.4 rad within 1 s while it moves 3 m north,
/// and stands for 1 s.
Obstacle Turning() {
  Obstacle box{.footprint = {{-10.0, 2.0, 0.1}, 4.0, 2.0}};
  box.motion = {{0.0, {-10.0, 2.0, 0.1}},
                {2.0, {0.0, 2.0, 0.1}},
                {3.0, {0.0, 5.0, 0.5}},
                {4.0, {0.0, 5.0, 0.5}}};
  return box;
}

void ExpectPose(const Pose2& pose, const Pose2& wanted) {
  // Sums of a few numbers below 100 have errors of a few 1e-14.
  EXPECT_NEAR(pose.x, wanted.x, Tolerance(1e-12));
  EXPECT_NEAR(pose.y, wanted.y, Tolerance(1e-12));
  EXPECT_NEAR(pose.yaw, wanted.yaw, Tolerance(1e-12));
}

TEST(ObstacleMotion, IsLinearBetweenPoses) {
  const Obstacle box = Turning();
  ExpectPose(FootprintAt(box, 0.0).center, {-10.0, 2.0, 0.1});
  ExpectPose(FootprintAt(box, 0.5).center, {-7.5, 2.0, 0.1});
  ExpectPose(FootprintAt(box, 2.0).center, {0.0, 2.0, 0.1});
  ExpectPose(FootprintAt(box, 2.25).center, {0.0, 2.75, 0.2});
  ExpectPose(FootprintAt(box, 3.5).center, {0.0, 5.0, 0.5});
  const ObstacleMotion turning = MotionAt(box, 2.5);
  EXPECT_NEAR(turning.velocity.x(), 0.0, Tolerance(1e-12));
  EXPECT_NEAR(turning.velocity.y(), 3.0, Tolerance(1e-12));
  EXPECT_NEAR(turning.yaw_rate, 0.4, Tolerance(1e-12));
}

TEST(ObstacleMotion, GoesOnBeyondTheEndsWithoutRotation) {
  Obstacle box = Turning();
  box.motion.erase(box.motion.begin());
  box.motion.pop_back();
  // The only piece is from 2 s to 3 s, at 3 m/s northward.
  box.footprint.center = {0.0, -4.0, 0.1};
  ExpectPose(FootprintAt(box, 0.0).center, {0.0, -4.0, 0.1});
  ExpectPose(FootprintAt(box, 5.0).center, {0.0, 11.0, 0.5});
  EXPECT_EQ(MotionAt(box, 5.0).yaw_rate, 0.0);
  EXPECT_NEAR(MotionAt(box, 5.0).velocity.y(), 3.0, Tolerance(1e-12));
}

TEST(ObstacleMotion, TurnsTheShorterWay) {
  Obstacle box{.footprint = {{0.0, 0.0, 3.0}, 4.0, 2.0}};
  box.motion = {{0.0, {0.0, 0.0, 3.0}}, {1.0, {0.0, 0.0, -3.0}}};
  // From 3 rad to -3 rad, the shorter turn is 2 pi - 6 to the left.
  EXPECT_NEAR(FootprintAt(box, 0.5).center.yaw, kPi, Tolerance(1e-12));
}

TEST(ObstacleMotion, EndsWhenTheObstacleIsGone) {
  Obstacle box = Turning();
  box.until = 3.5;
  const World world{.obstacles = {box}};
  const Pose2 car{0.0, 5.0, 0.5};
  EXPECT_EQ(Clearance(world, ReferenceCar(), car, 3.5), 0.0);
  EXPECT_GT(*Clearance(world, ReferenceCar(), car, 3.6), 9e5);
  EXPECT_TRUE(box.moves());
}

TEST(ObstacleMotion, IsTheMotionOfAConstantVelocity) {
  Obstacle steady{.footprint = {{3.0, 4.0, 0.7}, 4.0, 2.0}};
  steady.velocity = {2.0, -1.0};
  Obstacle through = steady;
  through.velocity = Vec2::Zero();
  through.motion = {{1.0, {5.0, 3.0, 0.7}}, {4.0, {11.0, 0.0, 0.7}}};
  for (double time = 0.0; time < 8.0; time += 0.37) {
    ExpectPose(FootprintAt(through, time).center, FootprintAt(steady, time).center);
  }
}

TEST(ObstacleMotion, IsWithinTheBoundOfTheClosestApproach) {
  // Compares ApproachBetween with the smallest clearance of 2001 samples in time, between which the
  // car and the fastest corner of a box move by at most 2 cm. The true smallest clearance is at
  // most 2 cm below the smallest sample, and the result of ApproachBetween is at most 5 mm or 1 %
  // above the true smallest clearance.
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 100; ++i) {
    Obstacle box{
        .footprint = {{8.0 * unit(random), 8.0 * unit(random), 3.0 * unit(random)}, 3.0, 0.3}};
    double time = 0.0;
    Pose2 pose = box.footprint.center;
    for (int k = 0; k < 5; ++k) {
      box.motion.push_back({time, pose});
      time += 0.3;
      pose = {pose.x + 2.0 * unit(random), pose.y + 2.0 * unit(random), pose.yaw + unit(random)};
    }
    const World world{.obstacles = {box}};
    const Pose2 from{6.0 * unit(random), 6.0 * unit(random), unit(random)};
    const Pose2 to{from.x + 4.0 * unit(random), from.y + 4.0 * unit(random),
                   from.yaw + unit(random)};
    const auto at = [&](double share) {
      const Pose2 car{std::lerp(from.x, to.x, share), std::lerp(from.y, to.y, share),
                      std::lerp(from.yaw, to.yaw, share)};
      return ClearanceSample{car, 1.2 * share, *Clearance(world, ReferenceCar(), car, 1.2 * share)};
    };
    double least = at(0.0).clearance;
    for (int k = 1; k <= 2000; ++k) {
      least = std::min(least, at(k / 2000.0).clearance);
    }
    const double found = ApproachBetween(world, ReferenceCar(), at(0.0), at(1.0)).clearance;
    EXPECT_GE(found, least - 0.02) << i;
    EXPECT_LE(found, least + std::max(0.005, 0.01 * least)) << i;
  }
}

}  // namespace
}  // namespace trackbed
