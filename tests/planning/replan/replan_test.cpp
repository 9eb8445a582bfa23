#include "trackbed/planning/replan/replan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "tests/planning/frenet_scenes.h"
#include "tests/tolerance.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/grid/hybrid_astar.h"
#include "trackbed/world/world.h"

// Tests replanning: predicted conflicts with standing and moving boxes, the choice of action
// (proceed, stop, brake, detour), and random scenes.
namespace trackbed {
namespace replan_test {

constexpr SpeedLimits kSpeed{3.0, 1.0, 2.0};
constexpr double kFront = 4.45 - 0.825;  // Front of the reference car, ahead of its rear axle [m].

Plan StraightPlan(double length, double start_speed) {
  Plan plan;
  plan.reference = {Path({0.0, 0.0, 0.0}, {{length, 0.0}}), StopAtEnd(length, start_speed, kSpeed)};
  plan.schedule_speed = plan.reference.speed;
  plan.goal = {length, 0.0, 0.0};
  return plan;
}

/// A car at 3 m/s on a straight route of 150 m, at a station of 30 m.
struct Scene {
  Driving driving;
  ReplanRequest request{.vehicle = ReferenceCar(), .speed = kSpeed};
  ReplanOptions options;

  Scene() {
    driving.route = StraightPlan(150.0, 3.0);
    driving.frame = MakeRouteFrame(ReferenceCar(), driving.route, kSpeed, 80.0);
    driving.plan = driving.route;
    driving.station = 30.0;
    driving.route_station = 30.0;
    request.car = {.pose = {30.0, 0.0, 0.0}, .speed = 3.0};
    options.along = FrenetOptions{};
    options.settings.road = {5.0, 5.0};
  }

  /// Places an obstacle across the route, `ahead` [m] before the car's front.
  void Block(double ahead, double width = 2.0) {
    request.obstacles.push_back(
        BoxAt(driving.route.reference.path, 30.0 + kFront + ahead + 1.0, 0.0, 2.0, width));
  }
  [[nodiscard]] Replanned Go() const { return Replan(request, driving, options); }

  /// Adopts a plan and advances the car along it by a distance.
  void Drive(const Replanned& next, double distance) {
    driving.plan = next.plan;
    driving.on_route = next.kind == ReplanKind::kRoute;
    driving.station = distance;
    const PathPoint at = next.plan->reference.path.At(distance);
    request.car.pose = at.pose;
    request.car.curvature = at.curvature;
    request.car.speed = next.plan->reference.speed.SpeedAt(distance);
    driving.route_station = at.pose.x;
  }
};

// --- conflicts

TEST(PredictConflict, WithWhatStandsIsWhenTheFrontGetsNear) {
  const Reference reference{Path({0.0, 0.0, 0.0}, {{150.0, 0.0}}), SpeedProfile({{0.0, 3.0}})};
  const std::vector<MovingBox> boxes{BoxAt(reference.path, 100.0, 9.0),
                                     BoxAt(reference.path, 60.0, 0.0)};
  const auto met = PredictConflict(ReferenceCar(), reference, 30.0, boxes, 0.5, 12.0);
  ASSERT_TRUE(met);
  EXPECT_EQ(met->obstacle, 1U);
  // PredictConflict samples the motion every 0.1 s, which is every 0.3 m. A conflict begins 1 cm
  // inside the safe distance.
  const double station = 59.0 - kFront - 0.5;
  EXPECT_GE(met->station, station);
  EXPECT_LE(met->station, station + 0.31);
  EXPECT_NEAR(met->time, (met->station - 30.0) / 3.0, Tolerance(1e-9));
  EXPECT_FALSE(PredictConflict(ReferenceCar(), reference, 30.0, boxes, 0.5, 8.0));
}

TEST(PredictConflict, ReckonsWithWhatMoves) {
  const Reference reference{Path({0.0, 0.0, 0.0}, {{150.0, 0.0}}), SpeedProfile({{0.0, 3.0}})};
  // A box crosses the road from the right at 1 m/s. In 8 s, the box and the car are at the same
  // place.
  std::vector<MovingBox> boxes{BoxAt(reference.path, 30.0 + 24.0, -8.0, 1.0, 1.0)};
  boxes[0].velocity = {0.0, 1.0};
  EXPECT_TRUE(PredictConflict(ReferenceCar(), reference, 30.0, boxes, 0.3, 12.0));
  // A box that crosses 5 s earlier or later causes no conflict.
  for (const double shift : {-5.0, 5.0}) {
    std::vector<MovingBox> other = boxes;
    other[0].box.center.y += shift;
    EXPECT_FALSE(PredictConflict(ReferenceCar(), reference, 30.0, other, 0.3, 12.0)) << shift;
  }
}

TEST(PredictConflict, OfACarThatStandsIsWithWhatComes) {
  Reference reference{Path({0.0, 0.0, 0.0}, {{30.0, 0.0}}), StopAtEnd(30.0, 3.0, kSpeed)};
  std::vector<MovingBox> boxes{BoxAt(reference.path, 50.0, 0.0)};
  EXPECT_FALSE(PredictConflict(ReferenceCar(), reference, 30.0, boxes, 0.5, 12.0));
  boxes[0].velocity = {-2.0, 0.0};
  const auto met = PredictConflict(ReferenceCar(), reference, 30.0, boxes, 0.5, 12.0);
  ASSERT_TRUE(met);
  EXPECT_NEAR(met->time, (49.0 - 30.0 - kFront - 0.5) / 2.0, Tolerance(0.1));
}

TEST(StandsInTurn, AsksForTheBendBesideIt) {
  const Path path({0.0, 0.0, 0.0}, {{40.0, 0.0}, {15.0, 0.1}, {40.0, 0.0}});
  const auto box = [&](double s) { return BoxAt(path, s, 0.0).box; };
  EXPECT_FALSE(StandsInTurn(ReferenceCar(), path, 0.0, box(20.0), 1.0));
  EXPECT_TRUE(StandsInTurn(ReferenceCar(), path, 0.0, box(47.0), 1.0));
  EXPECT_FALSE(StandsInTurn(ReferenceCar(), path, 0.0, box(80.0), 1.0));
  EXPECT_FALSE(StandsInTurn(ReferenceCar(), path, 60.0, box(47.0), 1.0));  // The box is behind.
}

TEST(PredictConflict, ReckonsWithAnOffset) {
  const Reference reference{Path({0.0, 0.0, 0.0}, {{150.0, 0.0}}), SpeedProfile({{0.0, 3.0}})};
  const std::vector<MovingBox> boxes{BoxAt(reference.path, 50.0, 3.0)};
  EXPECT_FALSE(PredictConflict(ReferenceCar(), reference, 30.0, boxes, 0.5, 12.0));
  EXPECT_TRUE(PredictConflict(ReferenceCar(), reference, 30.0, boxes, 0.5, 12.0, 1.2));
  EXPECT_FALSE(PredictConflict(ReferenceCar(), reference, 30.0, boxes, 0.5, 12.0, -1.2));
}

TEST(MightClear, CountsWhatIsOrComesInTheWay) {
  const Path path({0.0, 0.0, 0.0}, {{150.0, 0.0}});
  std::vector<MovingBox> boxes{BoxAt(path, 50.0, 0.0)};
  EXPECT_FALSE(MightClear(ReferenceCar(), path, 30.0, boxes, 0.5));  // a standing box
  boxes[0].velocity = {0.0, 1.0};
  EXPECT_TRUE(MightClear(ReferenceCar(), path, 30.0, boxes, 0.5));
  boxes[0].box.center.y = 20.0;  // The box has passed and moves away.
  EXPECT_FALSE(MightClear(ReferenceCar(), path, 30.0, boxes, 0.5));
  boxes[0].velocity = {0.0, -1.0};  // The box comes back across the path.
  EXPECT_TRUE(MightClear(ReferenceCar(), path, 30.0, boxes, 0.5));
}

// --- actions

TEST(Replan, KeepsARouteThatIsClear) {
  Scene scene;
  EXPECT_EQ(scene.Go().kind, ReplanKind::kKeep);
  scene.request.obstacles = {BoxAt(scene.driving.route.reference.path, 50.0, 4.0)};
  EXPECT_EQ(scene.Go().kind, ReplanKind::kKeep);
  // The conflict is beyond the look-ahead of 12 s.
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
    // The position, heading and curvature must be continuous at the start of the plan.
    const PathPoint start = next.plan->reference.path.At(0.0);
    EXPECT_NEAR(start.pose.x, scene.request.car.pose.x, Tolerance(1e-6));
    EXPECT_NEAR(start.pose.y, scene.request.car.pose.y, Tolerance(1e-6));
    EXPECT_NEAR(start.pose.yaw, scene.request.car.pose.yaw, Tolerance(1e-6));
    EXPECT_NEAR(start.curvature, scene.request.car.curvature, Tolerance(1e-5));
    EXPECT_NEAR(next.plan->reference.speed.SpeedAt(0.0), scene.request.car.speed, Tolerance(1e-6));
    scene.Drive(next, 1.5);
    nearest = std::min(nearest, Separation(FootprintAt(ReferenceCar(), scene.request.car.pose),
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
  const Path& path = next.plan->reference.path;
  EXPECT_NEAR(path.At(path.length()).pose.x, 150.0, Tolerance(1e-9));
  EXPECT_EQ(path.At(0.0).pose.y, 0.0);
  EXPECT_TRUE(next.plan->blocked.empty());
  EXPECT_EQ(DiagnosticsJson(next.plan)["replan"]["kind"], "back_on_route");
}

TEST(Replan, StopsBehindWhatItCannotPass) {
  Scene scene;
  scene.Block(14.0, 20.0);
  const Replanned next = scene.Go();
  ASSERT_EQ(next.kind, ReplanKind::kMotion);
  EXPECT_FALSE(next.plan->blocked.empty());
  const double end = 30.0 + next.plan->reference.path.length();
  EXPECT_LE(end + kFront + scene.options.settings.safe_distance, 30.0 + kFront + 14.0);
  EXPECT_EQ(next.plan->reference.speed.knots().back().speed, 0.0);
}

TEST(Replan, BrakesAsHardAsItMustWhereNoMotionIsLeft) {
  Scene scene;
  scene.Block(2.0, 20.0);  // Braking at the limit takes 9/4 m.
  const Replanned next = scene.Go();
  ASSERT_EQ(next.kind, ReplanKind::kStop);
  EXPECT_NEAR(next.plan->reference.path.length(), 2.25, Tolerance(1e-9));
  EXPECT_NE(next.plan->blocked.find("stops before the obstacle at (36.62, 0)"), std::string::npos)
      << next.plan->blocked;
}

/// Returns the distance within which the car must stop for an obstacle `ahead` [m] before its
/// front.
double RoomBefore(const Scene& scene, double ahead) {
  // The car stops 0.5 m before the conflict. A conflict begins 1 cm inside the safe distance.
  return ahead - scene.options.settings.safe_distance + 0.01 - 0.5;
}

TEST(Replan, BrakesNoHarderThanTheObstacleNeeds) {
  for (const double ahead : {1.5, 2.0, 2.6}) {
    Scene scene;
    scene.Block(ahead, 20.0);
    scene.request.max_deceleration = 8.0;
    const Replanned next = scene.Go();
    ASSERT_EQ(next.kind, ReplanKind::kStop);
    // The time of the conflict is accurate to 0.1 ms, which is 0.3 mm.
    const double room = RoomBefore(scene, ahead);
    EXPECT_NEAR(next.plan->reference.path.length(), room, Tolerance(5e-4));
    EXPECT_NEAR(next.plan->reference.speed.AccelerationAt(0.0), -std::max(2.0, 4.5 / room),
                Tolerance(0.02));
  }
}

TEST(Replan, BrakesAtTheCarsLimitWhereThatIsNotEnough) {
  Scene scene;
  scene.Block(1.0, 20.0);
  scene.request.max_deceleration = 8.0;
  const Replanned next = scene.Go();
  ASSERT_EQ(next.kind, ReplanKind::kStop);
  EXPECT_NEAR(next.plan->reference.path.length(), 4.5 / 8.0, Tolerance(1e-9));
  // On ice, the car's limit is below the mission's deceleration.
  scene.request.max_deceleration = 1.0;
  const Replanned on_ice = scene.Go();
  EXPECT_NEAR(on_ice.plan->reference.path.length(), 4.5, Tolerance(1e-9));
  EXPECT_NEAR(on_ice.plan->reference.speed.AccelerationAt(0.0), -1.0, Tolerance(1e-9));
}

TEST(Replan, BrakesForWhatComesAsHardAsThatTakes) {
  Scene scene;
  scene.request.max_deceleration = 8.0;
  scene.Block(2.0, 2.0);
  // The box crosses from the right. At its present speed, the car would be hit by the box. A car
  // that stops is not hit.
  scene.request.obstacles[0].box.center.y = -4.0;
  scene.request.obstacles[0].velocity = {0.0, 3.0};
  scene.options.settings.road = {1.0, 1.0};
  const Replanned next = scene.Go();
  if (next.kind == ReplanKind::kStop) {
    EXPECT_FALSE(PredictConflict(ReferenceCar(), next.plan->reference, 0.0, scene.request.obstacles,
                                 scene.options.settings.safe_distance, 12.0));
    EXPECT_GE(next.plan->reference.speed.AccelerationAt(0.0), -8.0 - 1e-9);
  }
}

TEST(Replan, DoesNotBrakeForWhatComesFromBehind) {
  // A box 12 m behind the car's rear axle approaches at 5 m/s on a road too narrow to pass. Braking
  // hastens the collision from behind.
  Scene scene;
  scene.request.max_deceleration = 8.0;
  scene.options.settings.road = {1.0, 1.0};
  scene.request.obstacles = {BoxAt(scene.driving.route.reference.path, 18.0, 0.0)};
  scene.request.obstacles[0].velocity = {5.0, 0.0};
  const double safe = scene.options.settings.safe_distance;
  ASSERT_TRUE(PredictConflict(ReferenceCar(), scene.driving.plan.reference, 30.0,
                              scene.request.obstacles, safe, 12.0));
  EXPECT_EQ(scene.Go().kind, ReplanKind::kKeep);
  // In a head-on approach, braking delays the collision.
  scene.request.obstacles = {BoxAt(scene.driving.route.reference.path, 60.0, 0.0)};
  scene.request.obstacles[0].velocity = {-5.0, 0.0};
  EXPECT_EQ(scene.Go().kind, ReplanKind::kStop);
}

TEST(Replan, AsksForNoMoreThanTheLimitBeyondThePlansEnd) {
  // The car is 0.4 m before the goal, and an impact has pushed it to 3 m/s. The rest of the path is
  // too short to stop on.
  Scene scene;
  scene.request.strayed = true;
  scene.driving.station = 149.6;
  scene.driving.route_station = 149.6;
  scene.request.car = {.pose = {149.6, 0.0, 0.0}, .speed = 3.0};
  scene.request.max_deceleration = 6.0;
  scene.request.obstacles.push_back(
      BoxAt(scene.driving.route.reference.path, 149.6 + kFront + 1.7, 0.0, 1.0, 20.0));
  const Replanned next = scene.Go();
  ASSERT_EQ(next.kind, ReplanKind::kStop);
  EXPECT_NEAR(next.plan->reference.path.length(), 0.75, Tolerance(1e-9));
}

TEST(Replan, BrakesFromBehindTheStartOfThePlan) {
  // An impact has thrown the car back behind the start of its plan.
  for (const double speed : {0.0, 1.0, 3.0}) {
    for (const double behind : {0.05, 0.4, 1.5}) {
      Scene scene;
      scene.driving.station = -behind;
      scene.driving.route_station = -behind;
      scene.request.strayed = true;
      scene.request.car = {.pose = {-behind, 0.0, 0.0}, .speed = speed};
      scene.request.max_deceleration = 8.0;
      scene.request.obstacles.push_back(
          BoxAt(scene.driving.route.reference.path, -behind + kFront + 1.1, 0.0, 1.0, 20.0));
      const Replanned next = scene.Go();
      ASSERT_EQ(next.kind, ReplanKind::kStop) << speed << " m/s, " << behind << " m";
      const Path& path = next.plan->reference.path;
      EXPECT_NEAR(path.At(0.0).pose.x, -behind, Tolerance(1e-12));
      EXPECT_NEAR(path.At(path.length()).pose.x, -behind + path.length(), Tolerance(1e-12));
      EXPECT_NEAR(path.length(), 0.5 * speed * speed / 8.0, Tolerance(1e-9));
    }
  }
}

TEST(Replan, TakesADetourWhereNoMotionLeadsPast) {
  Scene scene;
  scene.Block(25.0, 12.0);
  HybridAStarOptions planner;
  planner.reverse = false;
  scene.options.detour = planner;
  const Replanned next = scene.Go();
  ASSERT_EQ(next.kind, ReplanKind::kRoute) << DiagnosticsJson(next.plan).dump();
  EXPECT_EQ(DiagnosticsJson(next.plan)["replan"]["kind"], "detour");
  EXPECT_TRUE(next.plan->blocked.empty());
  // Without a penalty for collisions, the detour is too long to be worth it. The car then keeps the
  // motion along its route.
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
  EXPECT_EQ(DiagnosticsJson(next.plan)["replan"]["along"]["kind"], "follow");
}

TEST(Replan, StartsFromTheCarThatHasStrayed) {
  Scene scene;
  scene.request.strayed = true;
  scene.request.car = {.pose = {30.0, 0.8, 0.1}, .curvature = 0.02, .speed = 2.5};
  const Replanned next = scene.Go();
  ASSERT_EQ(next.kind, ReplanKind::kMotion);
  const PathPoint start = next.plan->reference.path.At(0.0);
  EXPECT_NEAR(start.pose.y, 0.8, Tolerance(1e-9));
  EXPECT_NEAR(start.pose.yaw, 0.1, Tolerance(1e-9));
  EXPECT_NEAR(start.curvature, 0.02, Tolerance(1e-5));
  EXPECT_NEAR(next.plan->reference.speed.SpeedAt(0.0), 2.5, Tolerance(1e-9));
}

TEST(Replan, KeepsItsLastMetersToTheGoal) {
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
  scene.Drive(next, next.plan->reference.path.length());
  scene.request.car.speed = 0.0;
  // The route is free again.
  scene.request.obstacles.clear();
  next = scene.Go();
  ASSERT_EQ(next.kind, ReplanKind::kRoute);
  EXPECT_EQ(next.plan->reference.speed.SpeedAt(0.0), 0.0);
  EXPECT_GT(next.plan->reference.speed.SpeedAt(20.0), 2.9);
}

/// Returns a random scene. The car is near its plan, and may be before the start or beyond the end
/// of the plan, as after an impact.
Scene RandomScene(std::mt19937& random) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Scene scene;
  scene.driving.on_route = between(0.0, 1.0) < 0.5;
  scene.driving.station = between(0.0, 1.0) < 0.5 ? between(-2.0, 2.0) : between(20.0, 151.0);
  scene.driving.route_station = scene.driving.station;
  scene.request.strayed = between(0.0, 1.0) < 0.7;
  scene.request.car = {.pose = {scene.driving.station, between(-2.0, 2.0), between(-0.6, 0.6)},
                       .curvature = between(-0.15, 0.15),
                       .speed = between(0.0, 1.0) < 0.3 ? 0.0 : between(0.0, 5.0)};
  scene.request.max_deceleration = between(0.0, 1.0) < 0.2 ? 0.0 : between(1.0, 9.0);
  const int boxes = 1 + static_cast<int>(between(0.0, 3.0));
  for (int i = 0; i < boxes; ++i) {
    scene.request.obstacles.push_back(
        BoxAt(scene.driving.route.reference.path, scene.driving.station + between(-3.0, 20.0),
              between(-3.0, 3.0), between(0.3, 4.0), between(0.3, 15.0)));
    if (between(0.0, 1.0) < 0.3) {
      scene.request.obstacles.back().velocity = {between(-3.0, 3.0), between(-2.0, 2.0)};
    }
  }
  if (between(0.0, 1.0) < 0.3) {
    scene.driving.plan.blocked = "stopped before";
  }
  return scene;
}

TEST(Replan, AnswersWhereverTheCarIs) {
  std::mt19937 random(7);
  int stops = 0;
  for (int i = 0; i < 300; ++i) {
    SCOPED_TRACE(i);
    Scene scene = RandomScene(random);
    if (i % 3 == 1) {
      scene.options.along = LatticeOptions{};
    }
    if (i % 10 == 2) {
      HybridAStarOptions planner;
      planner.reverse = false;
      scene.options.detour = planner;
    }
    Replanned next;
    ASSERT_NO_THROW(next = scene.Go());
    if (next.kind != ReplanKind::kStop) {
      continue;
    }
    ++stops;
    const SpeedProfile& speed = next.plan->reference.speed;
    const double hardest = std::max(scene.request.max_deceleration, kSpeed.deceleration);
    EXPECT_EQ(speed.knots().back().speed, 0.0);
    for (const SpeedProfile::Knot& knot : speed.knots()) {
      // The tolerance allows for rounding in a few operations on numbers below 200.
      EXPECT_GE(speed.AccelerationAt(knot.s), -hardest - Tolerance(1e-9));
    }
    // Planning can continue from the end of the new plan.
    scene.Drive(next, next.plan->reference.path.length());
    scene.request.car.speed = 0.0;
    EXPECT_NO_THROW(static_cast<void>(scene.Go()));
  }
  EXPECT_GT(stops, 20);
}

TEST(Replan, IsTheSameEveryTime) {
  Scene scene;
  scene.Block(22.0);
  EXPECT_EQ(scene.Go().plan->reference.path.segments(), scene.Go().plan->reference.path.segments());
}

TEST(Replan, NeedsAMethod) {
  Scene scene;
  scene.options.along.reset();
  EXPECT_THROW(static_cast<void>(scene.Go()), InternalError);
}

TEST(Replan, NamesItsKinds) {
  EXPECT_STREQ(ToString(ReplanKind::kKeep), "keep");
  EXPECT_STREQ(ToString(ReplanKind::kMotion), "motion");
  EXPECT_STREQ(ToString(ReplanKind::kRoute), "route");
  EXPECT_STREQ(ToString(ReplanKind::kStop), "stop");
}

}  // namespace replan_test
}  // namespace trackbed
