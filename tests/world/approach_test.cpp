#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/error.h"
#include "trackbed/world/world.h"

namespace trackbed {
namespace {

ClearanceSample Sample(const World& world, const Pose2& pose, double time) {
  return {pose, time, *Clearance(world, ReferenceCar(), pose, time)};
}

ClosestApproach Between(const World& world, const Pose2& from, const Pose2& to, double time) {
  return ApproachBetween(world, ReferenceCar(), Sample(world, from, 0.0), Sample(world, to, time));
}

TEST(ApproachBetween, FindsAThinWallThatTheCarJumpsOver) {
  // In 0.5 s at 30 m/s the car moves by 15 m and passes a wall that is 0.2 m thick. The wall
  // touches the car neither at the start nor at the end of this motion.
  const VehicleParams car = ReferenceCar();
  const double front = car.length - car.rear_overhang;
  const World world{.obstacles = {{.footprint = {{front + 5.0, 0.0, 0.0}, 0.2, 3.0}}}};
  const ClosestApproach hit = Between(world, {}, {15.0, 0.0, 0.0}, 0.5);
  EXPECT_EQ(hit.clearance, 0.0);
  // ApproachBetween may return any time at which the car overlaps the wall. The overlap begins when
  // the car's front reaches the wall.
  EXPECT_GE(hit.time, 4.9 / 30.0 - 1e-12);
  EXPECT_LE(hit.time, (5.1 + car.length) / 30.0);
}

TEST(ApproachBetween, FindsAThinBoxThatJumpsOverTheCar) {
  Obstacle box{.footprint = {{1.0, -10.0, 0.0}, 0.1, 0.1}};
  box.velocity = {0.0, 40.0};
  const World world{.obstacles = {box}};
  EXPECT_EQ(Between(world, {}, {}, 0.5).clearance, 0.0);
}

TEST(ApproachBetween, IsTheSmallestOfManySamples) {
  // Compares ApproachBetween with the minimum clearance of 1001 sampled poses, where the motion
  // between consecutive samples is at most 1 cm. The true minimum may be 5 mm below the minimum of
  // the samples. The result may be 5 mm or 1 % above the true minimum.
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int hits = 0;
  for (int i = 0; i < 200; ++i) {
    World world;
    for (int k = 0; k < 3; ++k) {
      Obstacle box{.footprint = {{6.0 * unit(random), 6.0 * unit(random), 3.0 * unit(random)},
                                 0.3 + std::abs(unit(random)),
                                 0.2}};
      box.velocity = {4.0 * unit(random), 4.0 * unit(random)};
      world.obstacles.push_back(box);
    }
    const Pose2 from{8.0 * unit(random), 8.0 * unit(random), unit(random)};
    const Pose2 to{from.x + 2.0 * unit(random), from.y + 2.0 * unit(random),
                   from.yaw + 0.2 * unit(random)};
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k <= 1000; ++k) {
      const double share = k / 1000.0;
      const Pose2 pose{std::lerp(from.x, to.x, share), std::lerp(from.y, to.y, share),
                       std::lerp(from.yaw, to.yaw, share)};
      least = std::min(least, *Clearance(world, ReferenceCar(), pose, 0.5 * share));
    }
    const double found = Between(world, from, to, 0.5).clearance;
    EXPECT_LE(found, least + std::max(5e-3, 1e-2 * least)) << i;
    EXPECT_GE(found, least - 5e-3) << i;
    hits += least == 0.0 ? 1 : 0;
  }
  EXPECT_GT(hits, 10);  // The random motions contain hits and misses.
  EXPECT_LT(hits, 190);
}

TEST(ApproachBetween, EndsForMotionsOfACarThatDiverges) {
  const World world{.obstacles = {{.footprint = {{30.0, 5.0, 0.3}, 2.0, 1.0}}}};
  const ClosestApproach far =
      ApproachBetween(world, ReferenceCar(), {{}, 0.0, 20.0}, {{1e10, 0.0, 1e10}, 1.0, 1e10});
  EXPECT_LE(far.clearance, 20.0);
  for (const double bad : {std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(
        ApproachBetween(world, ReferenceCar(), {{}, 0.0, 20.0}, {{bad, 0.0, 0.0}, 1.0, 20.0}),
        PreconditionError);
  }
}

TEST(ApproachBetween, NeedsObstacles) {
  EXPECT_THROW(ApproachBetween({}, ReferenceCar(), {}, {}), InternalError);
}

}  // namespace
}  // namespace trackbed
