#include "trackbed/planning/replan/along_route.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <variant>
#include <vector>

#include "src/planning/replan/passing.h"
#include "tests/planning/drivable.h"
#include "tests/planning/frenet_scenes.h"
#include "tests/tolerance.h"
#include "tests/track/rings.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/fillet/fillet.h"
#include "trackbed/track/track.h"
#include "trackbed/world/world.h"

// Tests both methods of planning along a route (Frenet and lattice) in scenes with standing and
// moving boxes, the search for a leader, and the smoothed route frame.
namespace trackbed {
namespace {

constexpr double kExtension = 80.0;  // [m]

Plan PlanOn(const Path& path, double speed) {
  Plan plan;
  plan.reference = {path, SpeedProfile({{0.0, speed}})};
  plan.schedule_speed = plan.reference.speed;
  plan.goal = path.At(path.length()).pose;
  return plan;
}

/// A car on a straight route of 200 m, at a station of 40 m.
struct Scene {
  RouteFrame frame =
      MakeRouteFrame(ReferenceCar(), PlanOn(StraightRoad(), 3.0), {3.0, 2.0, 3.0}, kExtension);
  AlongRequest request{.vehicle = ReferenceCar(),
                       .speed = {3.0, 2.0, 3.0},
                       .wanted = 3.0,
                       .start = {},
                       .obstacles = {}};
  AlongSettings settings;

  Scene() {
    request.start.s = 40.0;
    request.start.s_rate = 3.0;
  }
};

double Front() {
  return ReferenceCar().length - ReferenceCar().rear_overhang;
}

class EveryAlongMethod : public testing::TestWithParam<AlongEntry> {};
INSTANTIATE_TEST_SUITE_P(Planning, EveryAlongMethod, testing::ValuesIn(AlongMethods()),
                         [](const auto& of) { return std::string(of.param.name); });

/// Expects that a plan ends at rest, that its stations and times increase, and that it keeps the
/// limits.
void ExpectEndsAtRest(const Scene& scene, const AlongPlan& plan) {
  ASSERT_FALSE(plan.points.empty());
  EXPECT_NEAR(plan.points.back().motion.speed, 0.0, Tolerance(1e-9));
  EXPECT_EQ(plan.points.front().frenet.s, scene.request.start.s);
  for (std::size_t i = 1; i < plan.points.size(); ++i) {
    const TrajectoryPoint& point = plan.points[i];
    EXPECT_GT(point.t, plan.points[i - 1].t);
    EXPECT_GE(point.distance, plan.points[i - 1].distance);
    // Sampled motions may exceed the limits by 5 %.
    EXPECT_LE(point.motion.speed, 1.05 * scene.request.speed.speed + 1e-9);
    EXPECT_GE(point.motion.acceleration, -scene.request.speed.deceleration * 1.05);
  }
}

TEST_P(EveryAlongMethod, GoesOnAtItsSpeedWhereNothingIsInTheWay) {
  const Scene scene;
  const AlongPlan plan =
      PlanAlongRoute(scene.frame, scene.request, scene.settings, GetParam().defaults);
  ASSERT_EQ(plan.kind, ManeuverType::kProceed) << plan.found.reason;
  EXPECT_FALSE(plan.to_goal);
  const FrenetState end = plan.found.motion.At(plan.found.motion.duration());
  EXPECT_NEAR(end.s_rate, 3.0, Tolerance(1e-9));
  EXPECT_NEAR(end.d, 0.0, Tolerance(1e-9));
  ExpectEndsAtRest(scene, plan);
  // After the motion, braking from 3 m/s takes v^2/(2 a) = 1.5 m.
  EXPECT_NEAR(plan.points.back().frenet.s - end.s, 1.5, Tolerance(1e-9));
}

TEST_P(EveryAlongMethod, LeadsPastWhatStandsInAWideRoad) {
  Scene scene;
  scene.settings.road = {6.0, 6.0};
  scene.request.obstacles = {BoxAt(scene.frame.path, 66.0, 0.0)};
  const AlongPlan plan =
      PlanAlongRoute(scene.frame, scene.request, scene.settings, GetParam().defaults);
  ASSERT_EQ(plan.kind, ManeuverType::kProceed) << plan.found.reason;
  ExpectEndsAtRest(scene, plan);
  FrenetLimits limits = std::visit([](const auto& own) { return own.limits; }, GetParam().defaults);
  limits.safe_distance = scene.settings.safe_distance;
  ExpectDrivable(scene.frame.path,
                 {.vehicle = scene.request.vehicle,
                  .speed = scene.request.speed,
                  .road = scene.settings.road,
                  .start = scene.request.start,
                  .goal = KeepSpeed{3.0},
                  .obstacles = scene.request.obstacles},
                 limits, plan.found);
}

TEST_P(EveryAlongMethod, StopsItsGapBehindWhatStandsInANarrowRoad) {
  Scene scene;
  scene.settings.road = {1.5, 1.5};
  scene.settings.gap = 2.0;
  // The stop is 12.5 m ahead. A motion of 8 s that brakes from 3 m/s to rest covers about 12 m.
  const double stop = scene.request.start.s + 12.5;
  scene.request.obstacles = {BoxAt(scene.frame.path, stop + Front() + 2.0 + 1.0, 0.0)};
  const AlongPlan plan =
      PlanAlongRoute(scene.frame, scene.request, scene.settings, GetParam().defaults);
  ASSERT_EQ(plan.kind, ManeuverType::kStop) << plan.found.reason;
  ExpectEndsAtRest(scene, plan);
  // The plan must end at the stop, or at one of the station offsets before the stop.
  EXPECT_LE(plan.points.back().frenet.s, stop + Tolerance(1e-6));
  EXPECT_GE(plan.points.back().frenet.s, stop - 4.0);
}

TEST_P(EveryAlongMethod, ApproachesWhatStandsTooFarAwayToStopThere) {
  Scene scene;
  scene.settings.road = {1.5, 1.5};
  scene.request.wanted = 3.0;
  scene.request.obstacles = {BoxAt(scene.frame.path, 40.0 + 20.0 + Front(), 0.0)};
  // Motions of up to 4 s, and lattice layers that end 8 m ahead, cannot reach a stop 16 m ahead.
  // The options contain no slower motions, which might stop there.
  AlongOptions options = GetParam().defaults;
  if (auto* frenet = std::get_if<FrenetOptions>(&options)) {
    frenet->end_times = {2.0, 3.0, 4.0};
  } else {
    std::get<LatticeOptions>(options).layers = 2;
    std::get<LatticeOptions>(options).spacing = 4.0;
  }
  const AlongPlan plan = PlanAlongRoute(scene.frame, scene.request, scene.settings, options);
  EXPECT_EQ(plan.kind, ManeuverType::kApproach) << plan.found.reason;
  ExpectEndsAtRest(scene, plan);
  // The end of the motion must be clear of the box, even if this motion is the only one found.
  const double front = plan.points.back().frenet.s + Front();
  EXPECT_LT(front + scene.settings.safe_distance, 40.0 + 20.0 + Front() - 1.0);
}

TEST_P(EveryAlongMethod, NeverLeadsToWhereItCannotStop) {
  // The car drives fast toward a wall, from all distances. If a plan is found, it must end at rest
  // before the wall.
  Scene scene;
  scene.settings.road = {1.5, 1.5};
  scene.request.speed = {15.0, 2.0, 3.0};
  scene.request.wanted = 15.0;
  scene.request.start.s_rate = 15.0;
  int found = 0;
  for (double ahead = 20.0; ahead < 120.0; ahead += 5.0) {
    scene.request.obstacles = {BoxAt(scene.frame.path, 40.0 + Front() + ahead + 1.0, 0.0)};
    const AlongPlan plan =
        PlanAlongRoute(scene.frame, scene.request, scene.settings, GetParam().defaults);
    if (plan.ok()) {
      ++found;
      EXPECT_LE(plan.points.back().frenet.s + scene.settings.safe_distance, 40.0 + ahead + 0.01);
      EXPECT_NEAR(plan.points.back().motion.speed, 0.0, Tolerance(1e-9));
    }
  }
  EXPECT_GE(found, 10);
}

TEST_P(EveryAlongMethod, DoesNotLeadPastANearGoal) {
  // From 3 m/s, stopping takes at least 3^2/(2 x 3) = 1.5 m. From a shorter distance, the planner
  // must not find a plan.
  for (double left = 4.0; left >= -4.0; left -= 0.25) {
    for (const double offset : {0.0, 0.3, -1.0}) {
      Scene scene;
      scene.request.start.s = scene.frame.goal - left;
      scene.request.start.d = offset;
      const AlongPlan plan =
          PlanAlongRoute(scene.frame, scene.request, scene.settings, GetParam().defaults);
      if (plan.ok()) {
        EXPECT_GT(left, 1.5);
        EXPECT_LE(plan.points.back().frenet.s, scene.frame.goal + 0.05) << left << " m left";
      }
    }
  }
}

TEST_P(EveryAlongMethod, LeavesRoomToReturnToTheRouteBeforeTheGoal) {
  // Two arcs with the smallest turning radius r move a car sideways by d on the length sqrt(d (4 r
  // - d)). Braking from 12 m/s at 2 m/s^2 takes 36 m, longer than the motions of the planner. A
  // motion at constant speed must therefore leave room for braking.
  const double radius = ReferenceCar().wheelbase / std::tan(ReferenceCar().steering_limit);
  int found = 0;
  for (double left = 80.0; left >= 0.0; left -= 4.0) {
    for (const double offset : {0.0, 1.0, -2.0}) {
      Scene scene;
      scene.settings.road = {4.0, 4.0};
      scene.request.speed = {12.0, 2.0, 2.0};
      scene.request.wanted = 12.0;
      scene.request.start = {.s = scene.frame.goal - left, .s_rate = 12.0, .d = offset};
      scene.request.obstacles = {BoxAt(scene.frame.path, scene.frame.goal - 30.0, 0.0)};
      const AlongPlan plan =
          PlanAlongRoute(scene.frame, scene.request, scene.settings, GetParam().defaults);
      if (!plan.ok()) {
        continue;
      }
      const FrenetState stop = plan.points.back().frenet;
      const double beside = std::max(std::abs(stop.d) - 0.05, 0.0);
      EXPECT_LE(stop.s + std::sqrt(beside * (4.0 * radius - beside)), scene.frame.goal + 0.05)
          << left << " m left, offset " << offset;
      found += plan.to_goal ? 0 : 1;
    }
  }
  EXPECT_GE(found, 5);
}

TEST_P(EveryAlongMethod, BrakesNoFasterThroughABendThanTheWheelsTurn) {
  // At 5 m/s, the wheels would have to turn at 2.7 m x 5 m/s x 0.025 1/m^2 = 0.34 rad/s in the
  // clothoid, faster than their limit of 0.15 rad/s. From some of these starts, a motion at 5 m/s
  // ends before the bend. The car must not brake only in the bend.
  int found = 0;
  for (double start = 20.0; start <= 55.0; start += 2.5) {
    Scene scene;
    scene.frame.path = Path({}, {{.length = 60.0},
                                 {.length = 4.0, .sharpness = 0.025},
                                 {.length = 150.0, .curvature = 0.1}});
    scene.frame.goal = scene.frame.path.length() - kExtension;
    scene.request.speed = {5.0, 2.0, 3.0};
    scene.request.wanted = 5.0;
    scene.request.start.s = start;
    scene.request.start.s_rate = 5.0;
    const AlongPlan plan =
        PlanAlongRoute(scene.frame, scene.request, scene.settings, GetParam().defaults);
    if (!plan.ok()) {
      continue;
    }
    ++found;
    for (std::size_t i = 1; i < plan.points.size(); ++i) {
      const auto steering = [&](std::size_t j) {
        return std::atan(ReferenceCar().wheelbase * plan.points[j].motion.curvature);
      };
      EXPECT_LE(std::abs(steering(i) - steering(i - 1)),
                1.000001 * ReferenceCar().steering_rate * (plan.points[i].t - plan.points[i - 1].t))
          << "from " << start << " at " << plan.points[i].frenet.s;
    }
  }
  EXPECT_GT(found, 0);
}

TEST_P(EveryAlongMethod, FollowsWhatMovesSlowlyInANarrowRoad) {
  Scene scene;
  scene.settings.road = {1.5, 1.5};
  scene.settings.gap = 2.0;
  scene.settings.time_gap = 1.0;
  scene.request.obstacles = {BoxAt(scene.frame.path, 52.0, 0.0)};
  scene.request.obstacles[0].velocity = {1.5, 0.0};
  const AlongPlan plan =
      PlanAlongRoute(scene.frame, scene.request, scene.settings, GetParam().defaults);
  ASSERT_EQ(plan.kind, ManeuverType::kFollow) << plan.found.reason;
  ExpectEndsAtRest(scene, plan);
  const double duration = plan.found.motion.duration();
  const FrenetState end = plan.found.motion.At(duration);
  if (std::holds_alternative<FrenetOptions>(GetParam().defaults)) {
    EXPECT_NEAR(end.s_rate, 1.5, Tolerance(1e-9));
    // The car follows the leader's rear end at the gap and the time gap, or up to one station
    // offset farther behind.
    const double wanted = 51.0 + 1.5 * (duration - 1.0) - Front() - 2.0;
    EXPECT_LE(end.s, wanted + Tolerance(1e-9));
    EXPECT_GE(end.s, wanted - 4.0 - Tolerance(1e-9));
  }
}

TEST_P(EveryAlongMethod, StopsAtTheEndOfTheRoute) {
  Scene scene;
  scene.request.start.s = scene.frame.goal - 12.0;
  const AlongPlan plan =
      PlanAlongRoute(scene.frame, scene.request, scene.settings, GetParam().defaults);
  ASSERT_EQ(plan.kind, ManeuverType::kProceed) << plan.found.reason;
  EXPECT_TRUE(plan.to_goal);
  // All station offsets end before the goal. No station offset has a lower cost than the goal
  // itself.
  EXPECT_NEAR(plan.points.back().frenet.s, scene.frame.goal, Tolerance(1e-6));
  EXPECT_NEAR(plan.points.back().motion.speed, 0.0, Tolerance(1e-9));
}

TEST_P(EveryAlongMethod, GivesNothingWhereItTouches) {
  Scene scene;
  scene.request.obstacles = {BoxAt(scene.frame.path, 41.0, 0.0)};
  const AlongPlan plan =
      PlanAlongRoute(scene.frame, scene.request, scene.settings, GetParam().defaults);
  EXPECT_EQ(plan.kind, ManeuverType::kNone);
  EXPECT_FALSE(plan.ok());
  EXPECT_EQ(plan.found.status, PlanStatus::kStartBlocked);
  EXPECT_TRUE(plan.points.empty());
}

TEST_P(EveryAlongMethod, IsTheSameEveryTime) {
  Scene scene;
  scene.request.obstacles = {BoxAt(scene.frame.path, 66.0, 0.4)};
  const AlongPlan first =
      PlanAlongRoute(scene.frame, scene.request, scene.settings, GetParam().defaults);
  EXPECT_EQ(first.points,
            PlanAlongRoute(scene.frame, scene.request, scene.settings, GetParam().defaults).points);
}

TEST(PlanAlongRoute, RefusesWhatMakesNoSense) {
  Scene scene;
  scene.request.wanted = 4.0;
  EXPECT_THROW(PlanAlongRoute(scene.frame, scene.request, scene.settings, FrenetOptions{}),
               InternalError);
}

TEST_P(EveryAlongMethod, RefusesToTryNoSpeed) {
  const Scene scene;
  AlongOptions options = GetParam().defaults;
  std::visit([](auto& own) { own.speed_factors.clear(); }, options);
  EXPECT_THROW(PlanAlongRoute(scene.frame, scene.request, scene.settings, options), InternalError);
}

// --- the leader

TEST(LeaderIn, IsTheNearestInTheLane) {
  const Path path = StraightRoad();
  AlongRequest request{.vehicle = ReferenceCar(), .speed = {3.0, 2.0, 3.0}, .wanted = 3.0};
  request.start.s = 20.0;
  const AlongSettings settings{.safe_distance = 0.5};
  const double room = 0.5 * ReferenceCar().width + 0.5;
  // An obstacle 1.5 m wide does not reach into the lane if its center is more than 0.75 m + room
  // beside the path.
  request.obstacles = {BoxAt(path, 60.0, 0.0), BoxAt(path, 40.0, 0.75 + room + 0.01),
                       BoxAt(path, 10.0, 0.0), BoxAt(path, 50.0, -(0.75 + room - 0.01))};
  request.obstacles[3].velocity = {2.0, 5.0};
  const auto leader = LeaderIn(path, request, settings, 200.0);
  ASSERT_TRUE(leader);
  EXPECT_EQ(leader->obstacle, 3U);
  EXPECT_NEAR(leader->rear, 49.0, Tolerance(1e-12));
  EXPECT_NEAR(leader->speed, 2.0, Tolerance(1e-12));
  EXPECT_NEAR(leader->left, -(room - 0.01), Tolerance(1e-12));
  EXPECT_NEAR(leader->right, -(room - 0.01) - 1.5, Tolerance(1e-12));
  // The rear end of the leader, at the station 49 m, is beyond this limit.
  EXPECT_FALSE(LeaderIn(path, request, settings, 48.0));
}

// --- the frame

TEST(MakeRouteFrame, OfAStraightRouteIsTheRouteAndGoesOn) {
  const Scene scene;
  EXPECT_NEAR(scene.frame.goal, 200.0, Tolerance(1e-9));
  EXPECT_NEAR(scene.frame.path.length(), 200.0 + kExtension, Tolerance(1e-9));
  EXPECT_EQ(scene.frame.path.At(137.0).pose.y, 0.0);
}

TEST(MakeRouteFrame, OfArcsAsksNoMoreOfTheWheelsThanTheyCan) {
  // The route has a quarter turn of radius 12 m between straights. The steering angle in the turn
  // is atan(2.7/12).
  const double speed = 2.0;
  const Path path({0.0, 0.0, 0.0}, {{60.0, 0.0}, {6.0 * M_PI, 1.0 / 12.0}, {60.0, 0.0}});
  const SpeedLimits limits{speed, 2.0, 3.0};
  const RouteFrame frame = MakeRouteFrame(ReferenceCar(), PlanOn(path, speed), limits, kExtension);
  const double window = speed * ReferenceCar().wheelbase / 12.0 / ReferenceCar().steering_rate;
  double before = 0.0;
  constexpr double kStep = 0.2;  // [m]; the joints of the frame's segments are 0.1 m apart
  for (double s = kStep; s < frame.goal; s += kStep) {
    const double now = SteeringForCurvature(ReferenceCar(), frame.path.At(s).curvature);
    // Smoothing over the window w increases the curvature k of the arc by the factor 1 + (k
    // w)^2/24, and by terms of the order (k w)^4. The tolerance of 1/1000 covers these terms.
    const double rate = (now - before) / kStep * speed;
    EXPECT_LE(std::abs(rate), 1.001 * ReferenceCar().steering_rate) << s;
    before = now;
  }
  // The smoothed path deviates by at most window^2/24 times the largest curvature. The factor 1.1
  // is a margin.
  const double deviation = window * window / 24.0 / 12.0 * 1.1;
  for (double s = 0.0; s < frame.goal; s += 0.5) {
    EXPECT_LE(std::abs(path.Project(frame.path.At(s).pose).cross_track), deviation);
  }
  const Vec2 end = path.At(path.length()).pose.position();
  EXPECT_LE((frame.path.At(frame.goal).pose.position() - end).norm(), deviation);
}

TEST(MakeRouteFrame, IsSharperWhereTheRouteIsSlow) {
  const Path path({0.0, 0.0, 0.0}, {{60.0, 0.0}, {8.0 * M_PI, 1.0 / 8.0}, {60.0, 0.0}});
  Plan plan = PlanOn(path, 6.0);
  // The ramp is the distance over which the curvature rises from 10 % to 90 % of the bend's
  // curvature. This distance is 80 % of the window.
  const auto ramp = [&] {
    const RouteFrame frame = MakeRouteFrame(ReferenceCar(), plan, {6.0, 2.0, 3.0}, kExtension);
    const auto reaches = [&](double curvature) {
      double s = 0.0;
      while (frame.path.At(s).curvature < curvature) {
        s += 0.01;
      }
      return s;
    };
    return reaches(0.9 / 8.0) - reaches(0.1 / 8.0);
  };
  const double turning =
      SteeringForCurvature(ReferenceCar(), 1.0 / 8.0) / ReferenceCar().steering_rate;
  // The curvature k of the smoothed arc is larger by the fraction (k w)^2/24, which is 0.11 at 6
  // m/s. The smoothed path therefore reaches 90 % of the bend's curvature earlier.
  EXPECT_NEAR(ramp(), 0.8 * 6.0 * turning, Tolerance(0.1221 * 6.0 * turning));
  plan.caps = {{50.0, 95.0, 2.0}};
  EXPECT_NEAR(ramp(), 0.8 * 2.0 * turning, Tolerance(0.0123 * 2.0 * turning + 0.1));
}

/// A car at 8 m/s on a ring of radius 60 m, 30 m after the start of its lap.
struct RingLap {
  RingLap(double left_at_first, double left) {
    std::vector<TrackPoint> points = RingPoints(kRadius, 150, 3.0, left);
    for (std::size_t i = 0; i < 40; ++i) {  // The points are 2.5 m apart.
      points[i].width_left = left_at_first;
    }
    Plan plan =
        PlanOn(Path({kRadius, 0.0, 0.5 * kPi}, {{2.0 * kPi * kRadius, 1.0 / kRadius, 1}}), 8.0);
    plan.laps = {.track = std::make_shared<const Track>(points), .lines = {}};
    frame = MakeRouteFrame(ReferenceCar(), plan, {8.0, 2.0, 3.0}, 100.0, kDistance);
    request.speed = {8.0, 2.0, 3.0};
    request.wanted = 8.0;
    request.start.s = 30.0;
    request.start.s_rate = 8.0;
    request.obstacles = {BoxAt(frame.path, 68.0, 0.0, 2.0, 1.5)};
    settings.safe_distance = kDistance;
  }
  static constexpr double kRadius = 60.0;
  static constexpr double kDistance = 0.4;
  RouteFrame frame;
  AlongRequest request{.vehicle = ReferenceCar(), .speed = {}, .start = {}, .obstacles = {}};
  AlongSettings settings;
};

AlongOptions ForRing(AlongOptions options) {
  if (auto* lattice = std::get_if<LatticeOptions>(&options)) {
    lattice->spacing = 14.0;
  }
  return options;
}

TEST_P(EveryAlongMethod, KeepsWithinTheEdgesOfATrackUntilItStands) {
  const RingLap lap(5.0, 5.0);
  const AlongPlan plan =
      PlanAlongRoute(lap.frame, lap.request, lap.settings, ForRing(GetParam().defaults));
  ASSERT_EQ(plan.kind, ManeuverType::kProceed) << plan.found.reason;
  EXPECT_NEAR(plan.points.back().motion.speed, 0.0, Tolerance(1e-9));
  for (const TrajectoryPoint& point : plan.points) {
    for (const Vec2& corner : FootprintAt(lap.request.vehicle, point.motion.pose).Corners()) {
      // The edges are polylines with points 0.5 m apart. A chord is up to 0.5^2/(8 x 55) m = 0.0006
      // m inside its circle. The program checks the sides of the car at five points. Between two of
      // these points, a side may reach over an edge by 0.55^2/(2 x 55) m = 0.003 m.
      EXPECT_LE(corner.norm(), RingLap::kRadius + 3.0 - RingLap::kDistance + Tolerance(0.004));
      EXPECT_GE(corner.norm(), RingLap::kRadius - 5.0 + RingLap::kDistance - Tolerance(0.004));
    }
  }
}

TEST(PlanAlongRoute, BrakesBackToTheLineWhereItsOffsetLeadsOffTheTrack) {
  // The lane is wide only up to 100 m. The car can pass the box at 68 m on the left. After passing
  // the box, the car is too close to the end of the wide part to stop before it: stopping at 1
  // m/s^2 takes 32 m, and the front of the car is 4 m ahead of its rear axle.
  RingLap lap(5.0, 2.0);
  lap.request.speed.deceleration = 1.0;
  const AlongPlan plan = PlanAlongRoute(lap.frame, lap.request, lap.settings, FrenetOptions{});
  ASSERT_EQ(plan.kind, ManeuverType::kProceed) << plan.found.reason;
  const double aside = plan.found.motion.At(plan.found.motion.duration()).d;
  EXPECT_GT(aside, 1.0);
  EXPECT_NEAR(plan.points.back().frenet.d, 0.0, Tolerance(1e-9));
  EXPECT_GT(plan.points.back().frenet.s, 97.0);
  for (const TrajectoryPoint& point : plan.points) {
    EXPECT_LE(ReachBeyond(*lap.frame.edges, lap.request.vehicle, lap.frame.path.At(point.frenet.s),
                          point.frenet),
              2e-3);
  }
}

TEST_P(EveryAlongMethod, StopsBeforeWhatBlocksATrack) {
  RingLap lap(3.0, 3.0);
  lap.request.obstacles = {BoxAt(lap.frame.path, 68.0, 0.0, 2.0, 4.0)};
  lap.settings.gap = 2.0;
  AlongPlan plan =
      PlanAlongRoute(lap.frame, lap.request, lap.settings, ForRing(GetParam().defaults));
  EXPECT_NE(plan.kind, ManeuverType::kProceed);
  lap.request.obstacles.clear();
  plan = PlanAlongRoute(lap.frame, lap.request, lap.settings, ForRing(GetParam().defaults));
  EXPECT_EQ(plan.kind, ManeuverType::kProceed);
}

}  // namespace
}  // namespace trackbed
