#include "src/planning/replan/passing.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "tests/planning/frenet_scenes.h"
#include "tests/tolerance.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/world/world.h"

// Tests how a car passes a slower leader: the geometry of pulling out, the conditions under which
// the car follows instead, and whole maneuvers that are replanned twice a second.
namespace trackbed {
namespace {

constexpr SpeedLimits kLimits{8.0, 1.5, 2.0};

/// A car on a straight route of 400 m, at a station of 40 m. A leader that is 2 m long and 1.5 m
/// wide drives ahead of it.
struct Road {
  Path path{{0.0, 0.0, 0.0}, {{400.0, 0.0}}};
  RouteFrame frame;
  AlongRequest request{.vehicle = ReferenceCar(),
                       .speed = kLimits,
                       .wanted = kLimits.speed,
                       .start = {},
                       .obstacles = {}};
  AlongSettings settings;

  Road(double speed, double lead, double gap) {
    Plan plan;
    plan.reference = {path, SpeedProfile({{0.0, kLimits.speed}})};
    plan.schedule_speed = plan.reference.speed;
    plan.goal = path.At(path.length()).pose;
    frame = MakeRouteFrame(ReferenceCar(), plan, kLimits, 200.0);
    request.start.s = 40.0;
    request.start.s_rate = speed;
    request.obstacles = {BoxAt(path, 40.0 + FrontOverAxle(ReferenceCar()) + gap + 1.0, 0.0)};
    request.obstacles[0].velocity = {lead, 0.0};
  }

  [[nodiscard]] AlongPlan Go(const AlongOptions& options) const {
    return PlanAlongRoute(frame, request, settings, options);
  }

  void OpenOnTheLeft() { settings.road = {5.0, 1.5}; }

  /// Adds an oncoming car on the left side of the car.
  void AddOncoming(double ahead, double speed) {
    request.obstacles.push_back(BoxAt(path, 40.0 + ahead, 3.0));
    request.obstacles.back().velocity = {-speed, 0.0};
  }
};

class Passing : public testing::TestWithParam<AlongEntry> {};
INSTANTIATE_TEST_SUITE_P(Planning, Passing, testing::ValuesIn(AlongMethods()),
                         [](const auto& of) { return std::string(of.param.name); });

TEST(ShiftLength, UsesTheTightestLimitOfTheQuintic) {
  // A quintic d(s) of this length must reach exactly one of three limits: the steering rate L d'''
  // v, the curvature d'', or the lateral acceleration v^2 d''. The second derivative of the quintic
  // is largest at (3 - sqrt 3)/6 of the length, and the third derivative at the ends.
  const VehicleParams car = ReferenceCar();
  const FrenetLimits limits{.max_lateral_acceleration = 2.0, .max_steering_rate_fraction = 0.8};
  for (const double speed : {0.3, 1.0, 3.0, 8.0, 20.0, 40.0}) {
    for (const double aside : {0.2, -2.0, 3.5}) {
      const double length = ShiftLength(car, limits, speed, aside);
      const Polynomial d = QuinticBetween({0.0}, {aside}, length);
      const double bend = std::abs(d.At(length * (3.0 - std::sqrt(3.0)) / 6.0, 2));
      const double rate = std::abs(d.At(0.0, 3)) * speed * car.wheelbase;
      const double used = std::max({bend * car.min_turning_radius(), bend * speed * speed / 2.0,
                                    rate / (0.8 * car.steering_rate)});
      EXPECT_NEAR(used, 1.0, Tolerance(1e-9)) << speed << " m/s, " << aside << " m";
    }
  }
}

TEST(PullOutOptions, HaveLatticesOfAtLeastASecond) {
  // A short move aside at a low speed needs less than a second of the car's way. The car brakes
  // after the end of a motion, so a motion that ended before the next plan would slow it down.
  for (const double speed : {0.5, 2.0, 5.0, 8.0}) {
    for (const double aside : {0.05, 0.5, 3.0}) {
      const Road road(speed, 0.5 * speed, 10.0);
      const double needed = ShiftLength(ReferenceCar(), LatticeOptions{}.limits, speed, aside);
      const auto variants = PullOutOptions(LatticeOptions{}, road.request, {aside}, speed);
      ASSERT_GE(variants.size(), 2U);
      const auto& first = std::get<LatticeOptions>(variants.front());
      EXPECT_EQ(first.layers, 1);
      EXPECT_NEAR(first.spacing, std::max(needed, speed), Tolerance(1e-12 * speed))
          << speed << " m/s, " << aside << " m";
    }
  }
}

TEST_P(Passing, PullsOutFromBehindALeaderOfAnySpeedOnAWideRoad) {
  // The car follows the leader at the leader's speed and at the distance at which it settles behind
  // the leader. The road is open on both sides, so nothing keeps the car from passing.
  for (const double lead : {0.5, 1.0, 2.0, 3.0, 4.0, 5.0}) {
    Road road(lead, lead, 0.0);
    const double gap = road.settings.gap + road.settings.time_gap * lead;
    road.request.obstacles[0].box.center.x += gap;
    const AlongPlan plan = road.Go(GetParam().defaults);
    EXPECT_EQ(plan.kind, ManeuverType::kProceed) << lead << " m/s: " << plan.why;
    EXPECT_TRUE(plan.passes);
    EXPECT_EQ(plan.why, "");
    EXPECT_NEAR(plan.points.back().motion.speed, 0.0, Tolerance(1e-9));
  }
}

TEST_P(Passing, FollowsOnANarrowRoadAndSaysHowWideItWouldHaveToBe) {
  Road road(2.0, 2.0, 6.0);
  road.settings.road = {1.5, 1.6};
  const AlongPlan plan = road.Go(GetParam().defaults);
  ASSERT_EQ(plan.kind, ManeuverType::kFollow);
  EXPECT_FALSE(plan.passes);
  // The required width consists of half of the leader's width, the car's width, and the safe
  // distance between both.
  const double needed = 0.75 + ReferenceCar().width + road.settings.safe_distance;
  EXPECT_EQ(plan.why, fmt::format("no room to pass: it would need a road of {:.3g} m to the left "
                                  "of the route or {:.3g} m to the right, and plan.replan.road "
                                  "has 1.5 m and 1.6 m",
                                  needed, needed));
  // A road of this width is wide enough.
  road.settings.road.left = needed + 0.05;
  road.request.obstacles[0].box.center.x += 6.0;
  EXPECT_EQ(road.Go(GetParam().defaults).why.find("no room"), std::string::npos);
}

TEST_P(Passing, FollowsALeaderThatIsNoSlower) {
  Road road(3.0, 3.0, 10.0);
  road.request.wanted = 3.0;
  const AlongPlan plan = road.Go(GetParam().defaults);
  ASSERT_EQ(plan.kind, ManeuverType::kFollow);
  EXPECT_EQ(plan.why, "it drives at 3 m/s, no slower than the car's desired 3 m/s");
}

TEST_P(Passing, DoesNotPullOutWhereTheRouteEndsFirst) {
  // The leader drives at 5 m/s, and the car gains at most 3 m/s on it. To gain 15 m on the leader,
  // the car needs 5 s, in which it drives 40 m at 8 m/s. The car then needs 16 m to stop, but the
  // route ends in 45 m.
  Road road(5.0, 5.0, 10.5);
  road.request.start.s = road.frame.goal - 45.0;
  road.request.obstacles[0].box.center.x += road.request.start.s - 40.0;
  const AlongPlan plan = road.Go(GetParam().defaults);
  EXPECT_FALSE(plan.passes);
  if (plan.kind == ManeuverType::kFollow) {
    EXPECT_EQ(plan.why, "the route ends before the car could be past");
  }
}

TEST_P(Passing, WaitsForOncomingTraffic) {
  // At 8 m/s, the car needs at least 8 s to pass a leader that drives at 4 m/s. The car starts 9 m
  // behind the leader and more than 3 m/s below its desired speed. The leader is 2 m long, and the
  // car is 4.5 m long. An oncoming car at 8 m/s, 80 m ahead, meets the car within 6 s on its left.
  Road road(4.0, 4.0, 9.0);
  road.OpenOnTheLeft();
  EXPECT_EQ(road.Go(GetParam().defaults).kind, ManeuverType::kProceed);
  road.AddOncoming(80.0, 8.0);
  const AlongPlan plan = road.Go(GetParam().defaults);
  EXPECT_EQ(plan.kind, ManeuverType::kFollow);
  EXPECT_FALSE(plan.why.empty());
  // A car that drives away must not prevent passing.
  road.request.obstacles.back().velocity = {8.0, 0.0};
  EXPECT_EQ(road.Go(GetParam().defaults).kind, ManeuverType::kProceed);
}

/// Drives a car among its obstacles for at most `time` [s], with a new plan twice a second. If the
/// planner finds no motion, the car continues its last motion. If it had no motion yet, the car
/// brakes. Returns the time [s] at which the car has passed the leader and is back on its route;
/// infinite if this never happens.
double TimeToPass(Road road, const AlongOptions& options, double time, double& nearest) {
  constexpr double kPeriod = 0.5;
  constexpr double kStep = 0.05;
  AlongPlan driven;
  double began = 0.0;
  for (double now = 0.0; now < time; now += kPeriod) {
    if (AlongPlan plan = road.Go(options); plan.ok()) {
      driven = std::move(plan);
      began = now;
    }
    FrenetState& car = road.request.start;
    for (double t = kStep; t < kPeriod + 0.5 * kStep; t += kStep) {
      if (driven.ok()) {
        const double since = now + t - began;
        const auto at =
            std::find_if(driven.points.begin(), driven.points.end() - 1,
                         [&](const TrajectoryPoint& point) { return point.t >= since; });
        const FrenetMotion& motion = driven.found.motion;
        car = since < motion.duration() ? motion.At(since) : at->frenet;
      } else {
        car.s += kStep * (car.s_rate - 0.5 * kStep * kLimits.deceleration);
        car.s_rate -= kStep * kLimits.deceleration;
      }
      const auto motion = FromFrenet(road.frame.path, car);
      for (MovingBox& box : road.request.obstacles) {
        box.box = box.At(kStep);
        nearest = std::min(nearest, Separation(FootprintAt(ReferenceCar(), motion->pose), box.box));
      }
    }
    const double leader_front = road.request.obstacles[0].box.center.x + 1.0;
    if (car.s - ReferenceCar().rear_overhang > leader_front && std::abs(car.d) < 0.05) {
      return now + kPeriod;
    }
  }
  return std::numeric_limits<double>::infinity();
}

TEST_P(Passing, GetsPastFromManyStarts) {
  for (const double lead : {0.5, 1.0, 2.0, 3.0}) {
    for (const double gap : {8.0, 12.0, 25.0}) {
      for (const double speed : {1.0, 2.0, 4.0}) {
        SCOPED_TRACE(fmt::format("lead {} m/s, gap {} m, start {} m/s", lead, gap, speed));
        double nearest = 1e9;
        // While the car closes the gap and passes the leader, which is 6.5 m altogether, it drives
        // at 5 m/s or more. Pulling out takes at most 25 s, even at 0.5 m/s (ShiftLength).
        EXPECT_LT(TimeToPass(Road(speed, lead, gap), GetParam().defaults, 40.0, nearest), 40.0);
        // Between their samples, motions may come 1 cm closer than the safe distance.
        EXPECT_GE(nearest, AlongSettings{}.safe_distance - 0.01);
      }
    }
  }
}

TEST_P(Passing, GetsPastWhatStandsAtWalkingPace) {
  // At 0.5 m/s, a lateral move by 2 m takes the wheels 22 s (ShiftLength).
  for (const double speed : {0.5, 0.8, 1.2, 2.0, 3.0}) {
    SCOPED_TRACE(fmt::format("{} m/s", speed));
    Road road(speed, 0.0, 25.0);
    road.request.wanted = speed;
    road.settings.look_ahead =
        std::max(road.settings.look_ahead,
                 LongestShiftTime(ReferenceCar(), road.settings.road, GetParam().defaults, speed));
    double nearest = 1e9;
    // The time for 25 m up to the box, the lengths of car and box, and two lateral moves of up to
    // 48 m, the length of the default lattice.
    const double time = (25.0 + 10.0 + 2.0 * 48.0) / speed;
    EXPECT_LT(TimeToPass(road, GetParam().defaults, time, nearest), time);
    EXPECT_GE(nearest, AlongSettings{}.safe_distance - 0.01);
  }
}

TEST(LongestShiftTime, IsThatOfTheFarthestOffsetOnTheRoad) {
  const VehicleParams car = ReferenceCar();
  FrenetOptions options;
  options.end_offsets = {0.0, 1.0, -2.0, 3.5};
  // At low speeds, the steering rate limits the move: T = cbrt(60 L D/(rate v^2)).
  const auto time = [&](double shift, double speed) {
    return std::cbrt(60.0 * car.wheelbase * shift / (car.steering_rate * speed * speed));
  };
  const RoadWidths wide{10.0, 10.0};
  EXPECT_NEAR(LongestShiftTime(car, wide, options, 1.0), time(3.5, 1.0), Tolerance(1e-12));
  const RoadWidths narrow{2.0, 3.0};  // too narrow on the left for 3.5 m
  EXPECT_NEAR(LongestShiftTime(car, narrow, options, 1.0), time(2.0, 1.0), Tolerance(1e-12));
  EXPECT_EQ(LongestShiftTime(car, wide, options, 0.0), 0.0);
}

TEST(AddTimesToShift, AddsTimesOnlyToASlowCar) {
  const VehicleParams car = ReferenceCar();
  const RoadWidths road{10.0, 10.0};
  for (const double speed : {0.3, 0.5, 1.0, 2.0, 3.0, 10.0}) {
    AlongOptions options = FrenetOptions{};
    AddTimesToShift(options, car, road, speed);
    const auto& own = std::get<FrenetOptions>(options);
    const double needed = LongestShiftTime(car, road, options, speed);
    if (needed <= FrenetOptions{}.end_times.back()) {
      EXPECT_EQ(own.end_times, FrenetOptions{}.end_times) << speed;
      EXPECT_EQ(own.weights.k_dt, FrenetWeights{}.k_dt) << speed;
      continue;
    }
    EXPECT_GE(own.end_times.back(), 1.25 * needed) << speed;
    EXPECT_LT(own.end_times.back(), 1.25 * 1.25 * needed) << speed;
    EXPECT_NEAR(own.weights.k_dt * own.end_times.back(), FrenetWeights{}.k_dt * 8.0,
                Tolerance(1e-12));
  }
}

TEST_P(Passing, GetsPastOnShortRoutes) {
  // The route ends 90 m ahead. At the desired speed of 8 m/s, the car would need most of it for
  // speeding up (1.5 x 6 m/s / 1.5 m/s^2 x 5 m/s = 30 m), pulling in (25 m) and stopping
  // (1.5 x (8 m/s)^2 / (2 x 2 m/s^2) = 24 m). At 4 m/s, each takes less than 15 m.
  for (const double lead : {0.5, 1.0}) {
    for (const double gap : {6.0, 10.0}) {
      for (const double speed : {1.0, 2.0}) {
        SCOPED_TRACE(fmt::format("lead {} m/s, gap {} m, start {} m/s", lead, gap, speed));
        Road road(speed, lead, gap);
        road.request.obstacles[0].box.center.x += road.frame.goal - 90.0 - road.request.start.s;
        road.request.start.s = road.frame.goal - 90.0;
        double nearest = 1e9;
        EXPECT_LT(TimeToPass(road, GetParam().defaults, 40.0, nearest), 40.0);
        EXPECT_GE(nearest, AlongSettings{}.safe_distance - 0.01);
      }
    }
  }
}

// A car that has slowed down to its leader's speed. Each new plan must continue to pull out, not
// begin a longer maneuver.
TEST_P(Passing, PullsOutAtTheSpeedOfAVerySlowLeader) {
  for (const double lead : {0.4, 0.6}) {
    for (const double gap : {2.0, 6.0}) {
      Road road(lead, lead, gap);
      road.OpenOnTheLeft();
      double nearest = 1e9;
      // The car moves aside by 2.25 m over ShiftLength = 8 m, or over twice this length if each
      // plan begins anew, in 40 s. It passes in 10 s.
      EXPECT_LT(TimeToPass(road, GetParam().defaults, 60.0, nearest), 60.0)
          << lead << " m/s, gap " << gap << " m";
      EXPECT_GE(nearest, AlongSettings{}.safe_distance - 0.01);
    }
  }
}

TEST_P(Passing, KeepsClearOfOncomingTraffic) {
  int passed = 0;
  for (double ahead = 20.0; ahead <= 150.0; ahead += 10.0) {
    for (const double speed : {2.0, 5.0, 10.0}) {
      Road road(3.0, 3.0, 7.5);
      road.OpenOnTheLeft();
      road.AddOncoming(ahead, speed);
      double nearest = 1e9;
      passed += TimeToPass(road, GetParam().defaults, 20.0, nearest) < 20.0 ? 1 : 0;
      EXPECT_GE(nearest, AlongSettings{}.safe_distance - 0.01)
          << ahead << " m, " << speed << " m/s";
    }
  }
  // Oncoming cars at 10 m/s from up to 100 m ahead have passed the car after 10 s. This leaves 10 s
  // for passing.
  EXPECT_GE(passed, 10);
}

TEST_P(Passing, LeadsToTheGoalOnlyIfItEndsThere) {
  // A box stands across the route near its end. The car can stop before it, but not at the goal.
  for (double beyond = -6.0; beyond <= 6.0; beyond += 0.5) {
    Road road(3.0, 0.0, 0.0);
    road.settings.road = {1.5, 1.5};
    road.request.start.s = road.frame.goal - 12.0;
    const double front = road.frame.goal + FrontOverAxle(ReferenceCar()) + beyond;
    road.request.obstacles = {BoxAt(road.frame.path, front + 1.0, 0.0)};
    const AlongPlan plan = road.Go(GetParam().defaults);
    if (plan.to_goal) {
      EXPECT_NEAR(plan.points.back().frenet.s, road.frame.goal, Tolerance(0.05)) << beyond;
    }
    if (beyond < road.settings.safe_distance) {
      EXPECT_FALSE(plan.to_goal) << beyond;
    }
  }
}

}  // namespace
}  // namespace trackbed
