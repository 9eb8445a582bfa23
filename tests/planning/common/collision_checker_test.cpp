#include "trackbed/planning/common/collision_checker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/planning/poses.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/error.h"
#include "trackbed/world/world.h"

namespace trackbed {
namespace {

std::vector<OrientedBox> RandomBoxes(Random& random, int count, double reach) {
  std::vector<OrientedBox> boxes;
  for (int i = 0; i < count; ++i) {
    boxes.push_back(
        {RandomPose(random, reach), random.Uniform(0.3, 6.0), random.Uniform(0.3, 6.0)});
  }
  return boxes;
}

TEST(CollisionChecker, TellsTheRoomOfEveryPose) {
  Random random(1);
  const std::vector<OrientedBox> boxes = RandomBoxes(random, 30, 60.0);
  const CollisionChecker clear(ReferenceCar(), boxes, 0.4);
  for (int i = 0; i < 5000; ++i) {
    const Pose2 pose = RandomPose(random, 80.0);
    double nearest = CollisionChecker::kMaxClearance;
    for (const OrientedBox& box : boxes) {
      nearest = std::min(nearest, Separation(FootprintAt(ReferenceCar(), pose), box) - 0.4);
    }
    ASSERT_NEAR(clear.Clearance(pose), nearest, Tolerance(1e-12));
  }
}

TEST(CollisionChecker, TellsTheRoomOfASmallCarAmongManyWalls) {
  // The boxes are long walls and small blocks, as in maps. The small car, 0.45 m long, must find
  // gaps of 0.45 m.
  Random random(3);
  VehicleParams car = ReferenceCar();
  for (double* length : {&car.wheelbase, &car.length, &car.width, &car.rear_overhang}) {
    *length *= 0.1;
  }
  std::vector<OrientedBox> boxes;
  for (int i = 0; i < 200; ++i) {
    boxes.push_back({RandomPose(random, 10.0), random.Uniform(0.05, i % 10 == 0 ? 15.0 : 0.3),
                     random.Uniform(0.05, 0.3)});
  }
  const CollisionChecker clear(car, boxes, 0.05);
  EXPECT_EQ(clear.farthest(), car.length);
  int near_ones = 0;
  for (int i = 0; i < 5000; ++i) {
    const Pose2 pose = RandomPose(random, 12.0);
    double nearest = car.length;
    for (const OrientedBox& box : boxes) {
      nearest = std::min(nearest, Separation(FootprintAt(car, pose), box) - 0.05);
    }
    near_ones += nearest > 0.0 && nearest < car.length ? 1 : 0;
    ASSERT_NEAR(clear.Clearance(pose), nearest, Tolerance(1e-12));
    ASSERT_NEAR(clear.Clearance(pose, 0.1), std::min(nearest, 0.1), Tolerance(1e-12));
    ASSERT_EQ(clear.IsFree(pose), nearest >= 0.0);
  }
  EXPECT_GT(near_ones, 500);
}

TEST(CollisionChecker, FindsTheFirstPlaceThatIsTooNear) {
  Random random(2);
  int blocked_ones = 0;
  for (int i = 0; i < 200; ++i) {
    const CollisionChecker clear(ReferenceCar(), RandomBoxes(random, 6, 25.0), 0.2);
    const Path path(RandomPose(random, 10.0), {{.length = random.Uniform(1.0, 20.0),
                                                .curvature = random.Uniform(-0.19, 0.19),
                                                .direction = i % 2 == 0 ? 1 : -1},
                                               {.length = 10.0}});
    const std::optional<double> blocked = clear.FirstBlocked(path);
    blocked_ones += blocked ? 1 : 0;
    // FirstBlocked checks the path every 2 cm. Within half of this step, the farthest corner of the
    // car moves by 0.01 m x (1 + 0.2 x 3.7) = 0.01 m x 1.75.
    const double missed = 0.01 * 1.75;
    const double end = blocked ? *blocked - 0.02 : path.length();
    for (double s = 0.0; s < end; s += 0.005) {
      ASSERT_GE(clear.Clearance(path.At(s).pose), -Tolerance(missed)) << s << " of " << end;
    }
    if (blocked) {
      EXPECT_LT(clear.Clearance(path.At(*blocked).pose), 0.0);
    }
    const Segment& first = path.segments().front();
    EXPECT_EQ(clear.IsFree(path.At(0.0).pose, first), !blocked || *blocked > first.length);
  }
  EXPECT_GT(blocked_ones, 50);
  EXPECT_LT(blocked_ones, 190);
}

TEST(CollisionChecker, SkipsOnlyLooksThatChangeNothing) {
  // With few boxes, the checker skips tests on long stretches. With many copies of the same boxes,
  // the checker does all tests. With few and with many copies of the boxes, the checker must return
  // exactly the same station.
  Random random(4);
  int blocked_ones = 0;
  for (int i = 0; i < 200; ++i) {
    const std::vector<OrientedBox> few = RandomBoxes(random, 4, 400.0);
    std::vector<OrientedBox> many;
    for (int copy = 0; copy < 5; ++copy) {
      many.insert(many.end(), few.begin(), few.end());
    }
    const CollisionChecker skips(ReferenceCar(), few, 0.2);
    const CollisionChecker looks(ReferenceCar(), many, 0.2);
    const Vec2 to = few.front().center.position();
    const Pose2 from = RandomPose(random, 500.0);
    const Vec2 way = to - from.position();
    // The path leads straight toward one of the boxes, or along an arc near the box.
    const Segment segment{.length = way.norm(), .curvature = random.Uniform(-1e-4, 1e-4)};
    const Pose2 start{from.x, from.y, std::atan2(way.y(), way.x())};
    const std::optional<double> blocked = skips.FirstBlocked(Path(start, {segment}));
    EXPECT_EQ(blocked, looks.FirstBlocked(Path(start, {segment})));
    EXPECT_EQ(skips.IsFree(start, segment), looks.IsFree(start, segment));
    blocked_ones += blocked ? 1 : 0;
  }
  EXPECT_GT(blocked_ones, 50);
}

TEST(CollisionChecker, TakesBoxesThousandsOfKilometersApart) {
  // A grid of bins of 4 m over the whole area would have 10^11 bins.
  const std::vector<OrientedBox> boxes{{{0.0, 0.0, 0.0}, 2.0, 2.0}, {{1e6, 1e6, 0.5}, 2.0, 2.0}};
  const CollisionChecker clear(ReferenceCar(), boxes, 0.5);
  for (const OrientedBox& box : boxes) {
    EXPECT_FALSE(clear.IsFree(box.center));
    EXPECT_TRUE(clear.IsFree({box.center.x + 20.0, box.center.y, 0.0}));
  }
  EXPECT_EQ(clear.Clearance({5e5, 5e5, 0.0}), CollisionChecker::kMaxClearance);
}

TEST(CollisionChecker, RefusesPosesAndBoxesThatAreNoNumbers) {
  const OrientedBox box{{10.0, 0.0, 0.0}, 2.0, 2.0};
  const CollisionChecker clear(ReferenceCar(), {box}, 0.5);
  for (const double bad : {std::nan(""), HUGE_VAL}) {
    EXPECT_THROW((void)clear.IsFree(Pose2{bad, 0.0, 0.0}), PreconditionError);
    EXPECT_THROW((void)clear.IsFree(Pose2{0.0, 0.0, bad}), PreconditionError);
    OrientedBox other = box;
    other.center.y = bad;
    EXPECT_THROW(CollisionChecker(ReferenceCar(), {box, other}, 0.5), PreconditionError);
    other = box;
    other.width = bad;
    EXPECT_THROW(CollisionChecker(ReferenceCar(), {box, other}, 0.5), PreconditionError);
  }
}

TEST(CollisionChecker, FindsABoxInTheWayOfACarOfAMillimeter) {
  VehicleParams car = ReferenceCar();
  for (double* length : {&car.wheelbase, &car.length, &car.width, &car.rear_overhang}) {
    *length *= 1e-4;
  }
  // The path is shorter than 2 cm, and the box is in its middle.
  const CollisionChecker clear(car, {{{5e-3, 0.0, 0.0}, 1e-3, 1e-3}}, 3e-5);
  EXPECT_TRUE(clear.FirstBlocked(Path({}, {{.length = 1e-2}})).has_value());
  EXPECT_FALSE(clear.IsFree(Pose2{}, Segment{.length = 1e-2}));
}

TEST(CollisionChecker, LetsTheCarLeaveItsStart) {
  Random random(11);
  for (int i = 0; i < 500; ++i) {
    const std::vector<OrientedBox> boxes = RandomBoxes(random, 5, 8.0);
    const Pose2 start{random.Uniform(-5.0, 5.0), random.Uniform(-5.0, 5.0),
                      random.Uniform(-3.0, 3.0)};
    const Pose2 other{random.Uniform(-5.0, 5.0), random.Uniform(-5.0, 5.0),
                      random.Uniform(-3.0, 3.0)};
    constexpr double kDistance = 0.7;
    const CollisionChecker clear(ReferenceCar(), boxes, kDistance, start);
    bool overlaps = false;
    double expected = CollisionChecker::kMaxClearance;
    for (const OrientedBox& box : boxes) {
      const double at_start = Separation(FootprintAt(ReferenceCar(), start), box);
      overlaps = overlaps || at_start < 0.0;
      expected = std::min(expected,
                          Separation(FootprintAt(ReferenceCar(), other), box) -
                              (at_start < kDistance ? std::max(0.5 * at_start, 0.0) : kDistance));
    }
    EXPECT_EQ(clear.IsFree(start), !overlaps);
    EXPECT_NEAR(clear.Clearance(other), expected, Tolerance(1e-12));
  }
}

TEST(CollisionChecker, IsFreeWithoutBoxes) {
  const CollisionChecker clear(ReferenceCar(), {}, 0.5);
  EXPECT_EQ(clear.Clearance({}), CollisionChecker::kMaxClearance);
  EXPECT_FALSE(clear.FirstBlocked(Path({}, {{.length = 100.0}})));
}

}  // namespace
}  // namespace trackbed
