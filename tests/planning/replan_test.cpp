#include "trackbed/planning/replan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/planning/frenet_scenes.h"
#include "tests/tolerance.h"
#include "trackbed/core/error.h"
#include "trackbed/world/world.h"

namespace trackbed {
namespace {

constexpr SpeedLimits kSpeed{3.0, 1.0, 2.0};
constexpr double kFront = 4.45 - 0.825;  // of the seed car, ahead of its rear axle [m]

Plan StraightPlan(double length, double start_speed) {
  Plan plan;
  plan.reference = {Path({0.0, 0.0, 0.0}, {{length, 0.0}}), StopAtEnd(length, start_speed, kSpeed)};
  plan.schedule_speed = plan.reference.speed;
  plan.goal = {length, 0.0, 0.0};
  return plan;
}

/// On a straight route of 150 m, 30 m from its start, at 3 m/s.
struct Scene {
  Driving driving;
  ReplanRequest request{.vehicle = SeedCar(), .speed = kSpeed};
  ReplanOptions options;

  Scene() {
    driving.route = StraightPlan(150.0, 3.0);
    driving.frame = FrameOf(SeedCar(), driving.route, kSpeed, 80.0);
    driving.plan = driving.route;
    driving.station = 30.0;
    driving.route_station = 30.0;
    request.car = {.pose = {30.0, 0.0, 0.0}, .speed = 3.0};
    options.along = FrenetOptions{};
    options.settings.road = {5.0, 5.0};
  }

  /// Across the way, `ahead` of the car's front.
  void Block(double ahead, double width = 2.0) {
    request.obstacles.push_back(
        BoxAt(driving.route.reference.path, 30.0 + kFront + ahead + 1.0, 0.0, 2.0, width));
  }
  [[nodiscard]] Replanned Go() const { return Replan(request, driving, options); }

  /// Takes a plan up, and drives it for a distance.
  void Drive(const Replanned& next, double distance) {
    driving.plan = next.plan;
    driving.on_route = next.kind == ReplanKind::kRoute;
    driving.station = distance;
    const PathPoint at = next.plan.reference.path.At(distance);
    request.car.pose = at.pose;
    request.car.curvature = at.curvature;
    request.car.speed = next.plan.reference.speed.SpeedAt(distance);
    driving.route_station = at.pose.x;
  }
};

// --- encounters

TEST(FirstEncounter, WithWhatStandsIsWhenTheFrontGetsNear) {
  const Reference reference{Path({0.0, 0.0, 0.0}, {{150.0, 0.0}}), SpeedProfile({{0.0, 3.0}})};
  const std::vector<MovingBox> boxes{BoxAt(reference.path, 100.0, 9.0),
                                     BoxAt(reference.path, 60.0, 0.0)};
  const auto met = FirstEncounter(SeedCar(), reference, 30.0, boxes, 0.5, 12.0);
  ASSERT_TRUE(met);
  EXPECT_EQ(met->obstacle, 1U);
  // Looked at every 0.1 s, that is 0.3 m; a centimetre too near is near enough.
  const double station = 59.0 - kFront - 0.5;
  EXPECT_GE(met->station, station);
  EXPECT_LE(met->station, station + 0.31);
  EXPECT_NEAR(met->time, (met->station - 30.0) / 3.0, Tolerance(1e-9));
  EXPECT_FALSE(FirstEncounter(SeedCar(), reference, 30.0, boxes, 0.5, 8.0));
}

TEST(FirstEncounter, ReckonsWithWhatMoves) {
  const Reference reference{Path({0.0, 0.0, 0.0}, {{150.0, 0.0}}), SpeedProfile({{0.0, 3.0}})};
  // Crosses from the right at 1 m/s, over the path 8 s from now, where the car then is.
  std::vector<MovingBox> boxes{BoxAt(reference.path, 30.0 + 24.0, -8.0, 1.0, 1.0)};
  boxes[0].velocity = {0.0, 1.0};
  EXPECT_TRUE(FirstEncounter(SeedCar(), reference, 30.0, boxes, 0.3, 12.0));
  // 5 s earlier or later it does no harm.
  for (const double shift : {-5.0, 5.0}) {
    std::vector<MovingBox> other = boxes;
    other[0].box.centre.y += shift;
    EXPECT_FALSE(FirstEncounter(SeedCar(), reference, 30.0, other, 0.3, 12.0)) << shift;
  }
}

TEST(FirstEncounter, OfACarThatStandsIsWithWhatComes) {
  Reference reference{Path({0.0, 0.0, 0.0}, {{30.0, 0.0}}), StopAtEnd(30.0, 3.0, kSpeed)};
  std::vector<MovingBox> boxes{BoxAt(reference.path, 50.0, 0.0)};
  EXPECT_FALSE(FirstEncounter(SeedCar(), reference, 30.0, boxes, 0.5, 12.0));
  boxes[0].velocity = {-2.0, 0.0};
  const auto met = FirstEncounter(SeedCar(), reference, 30.0, boxes, 0.5, 12.0);
  ASSERT_TRUE(met);
  EXPECT_NEAR(met->time, (49.0 - 30.0 - kFront - 0.5) / 2.0, Tolerance(0.1));
}

TEST(StandsInTurn, AsksForTheBendBesideIt) {
  const Path path({0.0, 0.0, 0.0}, {{40.0, 0.0}, {15.0, 0.1}, {40.0, 0.0}});
  const auto box = [&](double s) { return BoxAt(path, s, 0.0).box; };
  EXPECT_FALSE(StandsInTurn(SeedCar(), path, 0.0, box(20.0), 1.0));
  EXPECT_TRUE(StandsInTurn(SeedCar(), path, 0.0, box(47.0), 1.0));
  EXPECT_FALSE(StandsInTurn(SeedCar(), path, 0.0, box(80.0), 1.0));
  EXPECT_FALSE(StandsInTurn(SeedCar(), path, 60.0, box(47.0), 1.0));  // it is behind
}

TEST(FirstEncounter, ReckonsWithAnOffset) {
  const Reference reference{Path({0.0, 0.0, 0.0}, {{150.0, 0.0}}), SpeedProfile({{0.0, 3.0}})};
  const std::vector<MovingBox> boxes{BoxAt(reference.path, 50.0, 3.0)};
  EXPECT_FALSE(FirstEncounter(SeedCar(), reference, 30.0, boxes, 0.5, 12.0));
  EXPECT_TRUE(FirstEncounter(SeedCar(), reference, 30.0, boxes, 0.5, 12.0, 1.2));
  EXPECT_FALSE(FirstEncounter(SeedCar(), reference, 30.0, boxes, 0.5, 12.0, -1.2));
}

TEST(MayClear, CountsWhatIsOrComesInTheWay) {
  const Path path({0.0, 0.0, 0.0}, {{150.0, 0.0}});
  std::vector<MovingBox> boxes{BoxAt(path, 50.0, 0.0)};
  EXPECT_FALSE(MayClear(SeedCar(), path, 30.0, boxes, 0.5));  // it stands
  boxes[0].velocity = {0.0, 1.0};
  EXPECT_TRUE(MayClear(SeedCar(), path, 30.0, boxes, 0.5));
  boxes[0].box.centre.y = 20.0;  // and is gone
  EXPECT_FALSE(MayClear(SeedCar(), path, 30.0, boxes, 0.5));
  boxes[0].velocity = {0.0, -1.0};  // or comes back
  EXPECT_TRUE(MayClear(SeedCar(), path, 30.0, boxes, 0.5));
}

// --- what comes of it

TEST(Replan, KeepsARouteThatIsClear) {
  Scene scene;
  EXPECT_EQ(scene.Go().kind, ReplanKind::kKeep);
  scene.request.obstacles = {BoxAt(scene.driving.route.reference.path, 50.0, 4.0)};
  EXPECT_EQ(scene.Go().kind, ReplanKind::kKeep);
  // Beyond the look-ahead of 12 s.
  scene.Block(40.0);
  EXPECT_EQ(scene.Go().kind, ReplanKind::kKeep);
}

TEST(Replan, LeadsPastAndBackOntoTheRoute) {
  Scene scene;
  scene.Block(22.0);
  Replanned next = scene.Go();
  ASSERT_EQ(next.kind, ReplanKind::kMotion);
  bool back = false;
  double nearest = 1e9;
  for (int look = 0; look < 80 && !back; ++look) {
    // Nothing jumps.
    const PathPoint start = next.plan.reference.path.At(0.0);
    EXPECT_NEAR(start.pose.x, scene.request.car.pose.x, Tolerance(1e-6));
    EXPECT_NEAR(start.pose.y, scene.request.car.pose.y, Tolerance(1e-6));
    EXPECT_NEAR(start.pose.yaw, scene.request.car.pose.yaw, Tolerance(1e-6));
    EXPECT_NEAR(start.curvature, scene.request.car.curvature, Tolerance(1e-5));
    EXPECT_NEAR(next.plan.reference.speed.SpeedAt(0.0), scene.request.car.speed, Tolerance(1e-6));
    scene.Drive(next, 1.5);
    nearest = std::min(nearest, Separation(OutlineAt(SeedCar(), scene.request.car.pose),
                                           scene.request.obstacles[0].box));
    const Replanned now = scene.Go();
    if (now.kind == ReplanKind::kKeep) {
      scene.driving.station = 3.0;
      continue;
    }
    next = now;
    back = next.kind == ReplanKind::kRoute;
  }
  EXPECT_TRUE(back);
  EXPECT_GE(nearest, scene.options.settings.safe_distance - 0.01);
  const Path& path = next.plan.reference.path;
  EXPECT_NEAR(path.At(path.length()).pose.x, 150.0, Tolerance(1e-9));
  EXPECT_EQ(path.At(0.0).pose.y, 0.0);
  EXPECT_TRUE(next.plan.blocked.empty());
  EXPECT_EQ(next.plan.diagnostics["replan"]["kind"], "back_on_route");
}

TEST(Replan, StopsBehindWhatItCannotPass) {
  Scene scene;
  scene.Block(14.0, 20.0);
  const Replanned next = scene.Go();
  ASSERT_EQ(next.kind, ReplanKind::kMotion);
  EXPECT_FALSE(next.plan.blocked.empty());
  const double end = 30.0 + next.plan.reference.path.length();
  EXPECT_LE(end + kFront + scene.options.settings.safe_distance, 30.0 + kFront + 14.0);
  EXPECT_EQ(next.plan.reference.speed.knots().back().speed, 0.0);
}

TEST(Replan, BrakesAsHardAsItMustWhereNoMotionIsLeft) {
  Scene scene;
  scene.Block(2.0, 20.0);  // braking at the limit takes 9/4 m
  const Replanned next = scene.Go();
  ASSERT_EQ(next.kind, ReplanKind::kStop);
  EXPECT_NEAR(next.plan.reference.path.length(), 2.25, Tolerance(1e-9));
  EXPECT_NE(next.plan.blocked.find("stops before the obstacle at (36.62, 0)"), std::string::npos)
      << next.plan.blocked;
}

TEST(Replan, TakesADetourWhereNoMotionLeadsPast) {
  Scene scene;
  scene.Block(25.0, 12.0);
  HybridAStarOptions planner;
  planner.reverse = false;
  scene.options.detour = planner;
  const Replanned next = scene.Go();
  ASSERT_EQ(next.kind, ReplanKind::kRoute) << next.plan.diagnostics.dump();
  EXPECT_EQ(next.plan.diagnostics["replan"]["kind"], "detour");
  EXPECT_TRUE(next.plan.blocked.empty());
  // Without a penalty it is not worth the way: the motion that stops or goes on for now is.
  scene.options.comparator = DetourChoice{.comparator = {.collision_penalty = 0.0}};
  EXPECT_EQ(scene.Go().kind, ReplanKind::kMotion);
}

TEST(Replan, DoesNotGoRoundWhatMovesOn) {
  Scene scene;
  scene.options.settings.road = {1.5, 1.5};
  HybridAStarOptions planner;
  planner.reverse = false;
  scene.options.detour = planner;
  scene.Block(12.0, 1.8);
  scene.request.obstacles[0].velocity = {1.0, 0.0};
  const Replanned next = scene.Go();
  ASSERT_EQ(next.kind, ReplanKind::kMotion);
  EXPECT_EQ(next.plan.diagnostics["replan"]["along"]["kind"], "follow");
}

TEST(Replan, StartsFromTheCarThatHasStrayed) {
  Scene scene;
  scene.request.strayed = true;
  scene.request.car = {.pose = {30.0, 0.8, 0.1}, .curvature = 0.02, .speed = 2.5};
  const Replanned next = scene.Go();
  ASSERT_EQ(next.kind, ReplanKind::kMotion);
  const PathPoint start = next.plan.reference.path.At(0.0);
  EXPECT_NEAR(start.pose.y, 0.8, Tolerance(1e-9));
  EXPECT_NEAR(start.pose.yaw, 0.1, Tolerance(1e-9));
  EXPECT_NEAR(start.curvature, 0.02, Tolerance(1e-5));
  EXPECT_NEAR(next.plan.reference.speed.SpeedAt(0.0), 2.5, Tolerance(1e-9));
}

TEST(Replan, KeepsItsLastMetresToTheGoal) {
  Scene scene;
  scene.driving.on_route = false;
  scene.driving.station = 149.5;
  scene.request.car.pose.x = 149.5;
  EXPECT_EQ(scene.Go().kind, ReplanKind::kKeep);
}

TEST(Replan, TriesAgainWhenItWasStuck) {
  Scene scene;
  scene.Block(8.0, 20.0);
  Replanned next = scene.Go();
  scene.Drive(next, next.plan.reference.path.length());
  scene.request.car.speed = 0.0;
  // The way is free again.
  scene.request.obstacles.clear();
  next = scene.Go();
  ASSERT_EQ(next.kind, ReplanKind::kRoute);
  EXPECT_EQ(next.plan.reference.speed.SpeedAt(0.0), 0.0);
  EXPECT_GT(next.plan.reference.speed.SpeedAt(20.0), 2.9);
}

TEST(Replan, IsTheSameEveryTime) {
  Scene scene;
  scene.Block(22.0);
  EXPECT_EQ(scene.Go().plan.reference.path.segments(), scene.Go().plan.reference.path.segments());
}

TEST(Replan, NeedsAMethod) {
  Scene scene;
  scene.options.along.reset();
  EXPECT_THROW(scene.Go(), InternalError);
}

TEST(Replan, NamesItsKinds) {
  EXPECT_STREQ(ToString(ReplanKind::kKeep), "keep");
  EXPECT_STREQ(ToString(ReplanKind::kMotion), "motion");
  EXPECT_STREQ(ToString(ReplanKind::kRoute), "route");
  EXPECT_STREQ(ToString(ReplanKind::kStop), "stop");
}

}  // namespace
}  // namespace trackbed
