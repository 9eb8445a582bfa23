#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "src/planning/curves/route_time.h"
#include "tests/planning/routes.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/plan_comparison.h"
#include "trackbed/planning/common/route.h"
#include "trackbed/planning/common/waypoint_miss.h"
#include "trackbed/planning/curves/curve_planners.h"
#include "trackbed/planning/grid/hybrid_astar.h"
#include "trackbed/planning/grid/hybrid_astar_planner.h"

// Routes on which curves through all waypoints would have loops.
namespace trackbed {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

struct DetourPlannerCase {
  const char* name;
  PlannerEntry entry;
};

std::vector<DetourPlannerCase> DetourPlanners() {
  return {{"dubins", DubinsPlanner()},
          {"reeds_shepp", ReedsSheppPlanner()},
          {"hybrid_astar", HybridAStarPlanner()}};
}

PlanRequest DetourRequest(std::vector<Vec2> waypoints, double start_speed) {
  PlanRequest request;
  request.vehicle = ReferenceCar();
  const Vec2 leg = waypoints[1] - waypoints[0];
  request.start = {waypoints[0].x(), waypoints[0].y(), std::atan2(leg.y(), leg.x())};
  request.waypoints = std::move(waypoints);
  request.start_speed = start_speed;
  request.speed = {.speed = 3.0, .acceleration = 1.0, .deceleration = 1.5};
  return request;
}

double PolylineLength(const std::vector<Vec2>& points) {
  double sum = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    sum += (points[i] - points[i - 1]).norm();
  }
  return sum;
}

TEST(Detours, AreNotNeededForALaneChangeOfARollingCar) {
  // From 12 m/s, a car with a steering rate of 0.15 rad/s changes to a lane 3.5 m beside it within
  // 20 m: the curve is shorter than the lines and one turning radius.
  for (const DetourPlannerCase& planner : DetourPlanners()) {
    PlanRequest request = DetourRequest({{0, 0}, {20, 0}, {40, 3.5}, {80, 3.5}}, 12.0);
    request.speed = {.speed = 12.0, .acceleration = 1.0, .deceleration = 3.0};
    request.vehicle.steering_rate = 0.15;
    const Plan plan = planner.entry.plan(request, planner.entry.defaults);
    ASSERT_TRUE(plan.ok()) << planner.name << ": " << plan.reason;
    EXPECT_LT(plan.reference.path.length(),
              PolylineLength(request.waypoints) + request.vehicle.min_turning_radius())
        << planner.name;
  }
}

TEST(Detours, OfHybridAStarAreNoLongerThanThoseOfDubins) {
  // A hairpin whose second point is 5 m from the first, from 13.9 m/s. The legs of the search take
  // 275 m. At the start, the Dubins curves exceed the share of the steering rate by 0.2 %.
  PlanRequest request = DetourRequest({{0, 0}, {31.486, 0}, {29.9285, 4.8208}, {0, 0}}, 13.85);
  request.speed = {.speed = 13.85, .acceleration = 1.0, .deceleration = 1.5};
  request.vehicle.steering_rate = 0.15;
  const HybridAStarOptions options{.safe_distance = 0.3, .min_speed = 0.3};
  const Plan plan = HybridAStarPlanner().plan(request, options);
  ASSERT_TRUE(plan.ok()) << plan.reason;
  const DubinsOptions curves{.safe_distance = 0.3,
                             .min_speed = 0.3,
                             .max_steering_rate_fraction = options.max_steering_rate_fraction};
  const Plan shortest = DubinsPlanner().plan(request, curves);
  ASSERT_TRUE(shortest.ok()) << shortest.reason;
  EXPECT_LE(plan.reference.path.length(),
            shortest.reference.path.length() + request.vehicle.min_turning_radius());
}

TEST(Detours, LeaveOutAPointThatWasClickedTwice) {
  // A second click 0.1 to 0.4 m from the first, in all directions: before, between and behind other
  // waypoints. The path must be shorter than the lines through all waypoints and one turning
  // radius, and pass each waypoint within a quarter of the car's width.
  for (const DetourPlannerCase& planner : DetourPlanners()) {
    for (int eighth = 0; eighth < 8; eighth += 3) {
      const Vec2 apart = (0.1 + 0.04 * eighth) * Direction(0.1 + eighth * kPi / 4.0);
      for (const std::vector<Vec2>& points :
           {std::vector<Vec2>{{0, 0}, {30, 0}, Vec2(30, 0) + apart},
            std::vector<Vec2>{{0, 0}, {20, 0}, Vec2(20, 0) + apart, {50, 6}}}) {
        const double start_speed = eighth % 2 == 0 ? 0.0 : 3.0;
        const PlanRequest request = DetourRequest(points, start_speed);
        const Plan plan = planner.entry.plan(request, planner.entry.defaults);
        SCOPED_TRACE(testing::Message()
                     << planner.name << " from " << start_speed << " m/s, direction " << eighth);
        ASSERT_TRUE(plan.ok()) << plan.reason;
        EXPECT_LT(plan.reference.path.length(),
                  PolylineLength(points) + request.vehicle.min_turning_radius());
        const auto miss = LargestWaypointMiss(plan.reference.path, points);
        ASSERT_TRUE(miss);
        EXPECT_LE(miss->distance, 0.25 * request.vehicle.width);
        if (miss->distance > kSameMiss) {
          EXPECT_THAT(plan.notes, Contains(HasSubstr("left out")));
        }
      }
    }
  }
}

TEST(Detours, DriveAlongALineOfRoundedPoints) {
  // Points on a line, 1 m to 15 m apart and rounded to 0.1 m: the lines between them turn by up to
  // 0.1 rad, for which the wheels have no time. The car must neither stop nor turn back nor drive a
  // loop. A path with the deviation y = 0.1 m on a leg of 1 m is longer than the leg by at most
  // 2 y^2/1 m; the bound holds for eight such legs.
  Random random(1771);
  int left_out = 0;
  for (const DetourPlannerCase& planner : DetourPlanners()) {
    const int routes = planner.entry.searches ? 4 : 12;  // a search takes longer
    for (int i = 0; i < routes; ++i) {
      const double turn = random.Uniform(-kPi, kPi);
      std::vector<Vec2> points;
      double s = 0.0;
      for (int k = 0; k < 7; ++k) {
        const Vec2 at = s * Direction(turn);
        points.emplace_back(std::round(at.x() * 10.0) / 10.0, std::round(at.y() * 10.0) / 10.0);
        s += std::pow(15.0, random.Uniform(0.0, 1.0));
      }
      points.push_back(points.back() + 30.0 * Direction(turn));
      const PlanRequest request = DetourRequest(points, i % 2 == 0 ? 0.0 : 6.0);
      const Plan plan = planner.entry.plan(request, planner.entry.defaults);
      SCOPED_TRACE(testing::Message() << planner.name << ", route " << i);
      ASSERT_TRUE(plan.ok()) << plan.reason;
      EXPECT_LT(plan.reference.path.length(), PolylineLength(points) + 8.0 * 0.02);
      EXPECT_TRUE(MakeFeasible(plan, request).ok());
      for (const double stop : plan.stops) {
        EXPECT_LT(stop, 0.1);  // only where the car stands at first
      }
      for (const Segment& segment : plan.reference.path.segments()) {
        EXPECT_EQ(segment.direction, 1);
      }
      EXPECT_LE(LargestWaypointMiss(plan.reference.path, points)->distance,
                0.25 * request.vehicle.width);
      left_out += std::any_of(plan.notes.begin(), plan.notes.end(), [](const std::string& note) {
        return note.find("left out") != std::string::npos;
      });
    }
  }
  EXPECT_GE(left_out, 1);
}

TEST(Detours, PassWaypointsLeftOutWhereTheNoteSays) {
  // Two routes of the audit (1094, 4981). After the choice of the waypoints left out, the search
  // for a faster path moved the path up to 1.4 m away from them.
  const std::vector<std::pair<std::vector<Vec2>, double>> routes{
      {{{-90.88275, -99.25888},
        {-93.91772, -92.12116},
        {-148.27989, -117.92684},
        {-148.27978, -117.92530},
        {-152.77437, -119.85791}},
       0.0},
      {{{0, 0}, {31.486, 0}, {29.929, 4.821}, {0, 0}}, 13.855}};
  int left_out = 0;
  for (const DetourPlannerCase& planner : DetourPlanners()) {
    for (const auto& [points, start_speed] : routes) {
      PlanRequest request = DetourRequest(points, start_speed);
      request.speed.speed = start_speed > 0.0 ? start_speed : 10.7926;
      request.infeasible = InfeasiblePolicy::kSlowDown;
      const Plan plan = planner.entry.plan(request, planner.entry.defaults);
      SCOPED_TRACE(testing::Message() << planner.name << " from " << start_speed << " m/s");
      ASSERT_TRUE(plan.ok()) << plan.reason;
      const auto miss = LargestWaypointMiss(plan.reference.path, points);
      ASSERT_TRUE(miss);
      EXPECT_LE(miss->distance, 0.25 * request.vehicle.width);
      for (const std::string& note : plan.notes) {
        if (note.find("left out") != std::string::npos) {
          ++left_out;
          EXPECT_THAT(note, HasSubstr(fmt::format("at {:.3g} m; to drive through every waypoint,",
                                                  miss->distance)));
        }
      }
    }
  }
  EXPECT_GE(left_out, 2);
}

TEST(Detours, DriveThroughWaypointsWithHeadings) {
  // With headings, each waypoint is a pose that the path meets. No path without a loop does: the
  // second pose is 0.2 m beside the first.
  for (const DetourPlannerCase& planner : DetourPlanners()) {
    PlanRequest request = DetourRequest({{0, 0}, {30, 0}, {30, 0.2}}, 0.0);
    request.headings = {0.0, 0.0, 0.0};
    const Plan plan = planner.entry.plan(request, planner.entry.defaults);
    ASSERT_TRUE(plan.ok()) << plan.reason;
    const auto miss = LargestWaypointMiss(plan.reference.path, request.waypoints);
    ASSERT_TRUE(miss);
    // The clothoids end within 1e-9 m for each turning radius of length.
    EXPECT_LE(miss->distance, Tolerance(1e-7)) << planner.name;
    EXPECT_THAT(plan.notes, Not(Contains(HasSubstr("left out"))));
  }
}

TEST(Detours, ChooseHeadingsWithoutLoops) {
  // The oracle is the plan through the default headings, given explicitly. Free headings must never
  // be slower, and must save a loop on some of the routes. A tenth of a millisecond covers rounding
  // of times of some hundred seconds.
  const PlannerEntry dubins = DubinsPlanner();
  Random random(4811);
  int shorter = 0;
  for (int i = 0; i < 10; ++i) {
    PlanRequest request = DetourRequest(RandomRoute(random, 4, 8.0, 20.0, 2.0), 0.0);
    const Plan free = dubins.plan(request, dubins.defaults);
    for (const Pose2& stop : PlannedStops(request)) {
      request.headings.push_back(stop.yaw);
    }
    const Plan given = dubins.plan(request, dubins.defaults);
    ASSERT_TRUE(free.ok() && given.ok()) << free.reason << given.reason;
    EXPECT_LE(TotalTime(request, free), TotalTime(request, given) + Tolerance(1e-4)) << i;
    EXPECT_LE(LargestWaypointMiss(free.reference.path, request.waypoints)->distance,
              0.25 * request.vehicle.width);
    const double saved = given.reference.path.length() - free.reference.path.length();
    shorter += saved > request.vehicle.min_turning_radius() ? 1 : 0;
  }
  EXPECT_GE(shorter, 1);
}

TEST(Detours, NameTheHeadingsAsTheCause) {
  // The car cannot face across the road at a point 5 m ahead of it without a loop.
  PlanRequest request = DetourRequest({{0, 0}, {5, 0}, {40, 0}}, 0.0);
  request.headings = {0.0, 0.5 * kPi, 0.0};
  const PlannerEntry dubins = DubinsPlanner();
  const Plan turned = dubins.plan(request, dubins.defaults);
  ASSERT_TRUE(turned.ok()) << turned.reason;
  EXPECT_THAT(turned.notes, Contains(HasSubstr("because mission.headings demands it; without "
                                               "mission.headings, it is 40 m long")));
  request.headings = {0.0, 0.0, 0.0};
  EXPECT_THAT(dubins.plan(request, dubins.defaults).notes,
              Not(Contains(HasSubstr("mission.headings"))));
}

TEST(Detours, NameARollingStartAsTheCause) {
  // From 10 m/s, the car needs 33 m to brake at 1.5 m/s^2, so it cannot turn to the goal 6 m beside
  // a point 12 m ahead without a loop. From rest it can.
  PlanRequest request = DetourRequest({{0, 0}, {12, 6}}, 10.0);
  request.start.yaw = 0.0;
  const PlannerEntry dubins = DubinsPlanner();
  const Plan rolling = dubins.plan(request, dubins.defaults);
  ASSERT_TRUE(rolling.ok()) << rolling.reason;
  EXPECT_THAT(rolling.notes, Contains(HasSubstr("because the car starts at 10 m/s; with "
                                                "mission.start.speed: 0, it is")));
  request.start_speed = 0.0;
  const Plan at_rest = dubins.plan(request, dubins.defaults);
  ASSERT_TRUE(at_rest.ok()) << at_rest.reason;
  EXPECT_LT(at_rest.reference.path.length() + request.vehicle.min_turning_radius(),
            rolling.reference.path.length());
  EXPECT_THAT(at_rest.notes, Not(Contains(HasSubstr("because the car starts"))));
}

TEST(Detours, OfARollingStartAreNamedOnLongRoutes) {
  PlanRequest request = DetourRequest({{0, 0}, {12, 6}}, 10.0);
  request.start.yaw = 0.0;
  for (int i = 1; i <= 12; ++i) {
    request.waypoints.emplace_back(12.0 + 30.0 * i, 6.0);
  }
  const PlannerEntry dubins = DubinsPlanner();
  const Plan rolling = dubins.plan(request, dubins.defaults);
  ASSERT_TRUE(rolling.ok()) << rolling.reason;
  EXPECT_THAT(rolling.notes, Contains(HasSubstr("because the car starts at 10 m/s; with "
                                                "mission.start.speed: 0, it is")));
}

TEST(Detours, FarFromARollingStartNeedNoLongPlanFromRest) {
  // From 10 m/s, the car can stop after 33 m. The route turns back after 300 m.
  PlanRequest request = DetourRequest({{0, 0}, {30, 0}}, 10.0);
  for (int i = 2; i <= 10; ++i) {
    request.waypoints.emplace_back(30.0 * i, 0.0);
  }
  request.waypoints.emplace_back(270.0, 0.0);
  const PlannerEntry dubins = DubinsPlanner();
  Plan plan = dubins.plan(request, dubins.defaults);
  ASSERT_TRUE(IsDetour(plan, request)) << plan.reason;
  std::size_t longest = 0;
  NoteDetourOfRollingStart(request, plan, [&](const PlanRequest& own) {
    longest = std::max(longest, own.waypoints.size());
    return dubins.plan(own, dubins.defaults);
  });
  // Two legs reach beyond 33 m; two more legs are planned.
  EXPECT_EQ(longest, 5U);
}

}  // namespace
}  // namespace trackbed
