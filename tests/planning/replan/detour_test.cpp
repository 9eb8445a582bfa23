#include "trackbed/planning/replan/detour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "tests/planning/frenet_scenes.h"
#include "tests/tolerance.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/curvature_steps.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/fillet/fillet.h"
#include "trackbed/planning/grid/hybrid_astar.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/planning/sampling/rrt_planner.h"
#include "trackbed/world/world.h"

namespace trackbed {
namespace {

constexpr SpeedLimits kSpeed{3.0, 1.0, 2.0};

/// Returns a request for a route of 120 m along x at 3 m/s. The car is at 20 m. A box of 4 m x 9 m
/// blocks the path at 50 m.
DetourRequest Blocked() {
  DetourRequest request{.vehicle = ReferenceCar(), .speed = kSpeed};
  const Path path({0.0, 0.0, 0.0}, {{120.0, 0.0}});
  request.route.reference = {path, StopAtEnd(120.0, 3.0, kSpeed)};
  request.route.schedule_speed = request.route.reference.speed;
  request.route.goal = {120.0, 0.0, 0.0};
  request.driven = request.route;
  request.station = 20.0;
  request.route_station = 20.0;
  request.station_speed = 3.0;
  request.obstacles = {{{50.0, 1.0, 0.0}, 4.0, 9.0}};
  request.seed = 5;
  return request;
}

PlannerOptions Forwards() {
  HybridAStarOptions options;
  options.reverse = false;
  return options;
}

TEST(BlockedStretches, AreWhereTheFootprintIsTooNear) {
  // The front of the car is 3.625 m ahead of the rear axle, and the rear is 0.825 m behind it.
  const Path path({0.0, 0.0, 0.0}, {{120.0, 0.0}});
  const std::vector<OrientedBox> boxes{{{50.0, 0.0, 0.0}, 4.0, 1.0}, {{80.0, 1.9, 0.0}, 2.0, 1.0}};
  const auto stretches = BlockedStretches(ReferenceCar(), path, 10.0, boxes, 0.6);
  ASSERT_EQ(stretches.size(), 2U);
  // BlockedStretches samples the path every 0.1 m.
  EXPECT_NEAR(stretches[0].from, 48.0 - 0.6 - 3.625, Tolerance(0.1));
  EXPECT_NEAR(stretches[0].to, 52.0 + 0.6 + 0.825, Tolerance(0.1));
  // The second box is 1.4 - 0.8625 = 0.5375 m beside the side of the car. The corners of this box
  // are less than 0.6 m from the car over an additional length of sqrt(0.6^2 - 0.5375^2) m = 0.267
  // m at both ends.
  EXPECT_NEAR(stretches[1].from, 79.0 - 0.267 - 3.625, Tolerance(0.1));
  EXPECT_NEAR(stretches[1].to, 81.0 + 0.267 + 0.825, Tolerance(0.1));
  EXPECT_EQ(BlockedStretches(ReferenceCar(), path, 60.0, boxes, 0.6).size(), 1U);
  EXPECT_TRUE(BlockedStretches(ReferenceCar(), path, 60.0, boxes, 0.5).empty());
}

class EveryDetour : public testing::TestWithParam<PlannerOptions> {};
INSTANTIATE_TEST_SUITE_P(Planning, EveryDetour, testing::ValuesIn([] {
                           std::vector<PlannerOptions> planners{Forwards()};
                           for (const PlannerEntry& entry : Planners()) {
                             if (entry.keeps_clear && !entry.has_headings) {
                               planners.push_back(entry.defaults);
                             }
                           }
                           return planners;
                         }()),
                         [](const auto& of) { return std::string(PlannerFor(of.param).name); });

TEST_P(EveryDetour, LeadsRoundAndBack) {
  const DetourRequest request = Blocked();
  const Detour detour = PlanDetour(request, GetParam(), {});
  ASSERT_TRUE(detour.route) << detour.why;
  const Plan& plan = *detour.route;
  const Path& path = plan.reference.path;
  // The detour begins at the car's pose on the driven path and ends at the goal.
  EXPECT_EQ(path.At(0.0).pose, request.driven.reference.path.At(20.0).pose);
  EXPECT_EQ(path.At(0.0).curvature, 0.0);
  EXPECT_EQ(plan.reference.speed.SpeedAt(0.0), 3.0);
  EXPECT_EQ(plan.goal, request.route.goal);
  // At the joints, the headings match to 1e-6 rad, which moves the end by 1e-4 m over 100 m.
  EXPECT_NEAR(path.At(path.length()).pose.x, 120.0, Tolerance(1e-4));
  EXPECT_NEAR(path.At(path.length()).pose.y, 0.0, Tolerance(2e-4));
  EXPECT_EQ(plan.reference.speed.SpeedAt(path.length()), 0.0);
  // The path keeps the planner's safe distance of 0.3 m, less 2 cm between the samples of the
  // planner.
  for (double s = 0.0; s < path.length(); s += 0.02) {
    const PathPoint at = path.At(s);
    EXPECT_GE(Separation(FootprintAt(ReferenceCar(), at.pose), request.obstacles[0]), 0.28) << s;
    EXPECT_LE(std::abs(at.curvature), 1.0 / 5.1 + 1e-9);
    EXPECT_GT(at.direction, 0);
  }
  // Braking before slow corners stays within the limit.
  for (double s = 0.0; s < path.length(); s += 0.1) {
    EXPECT_GE(plan.reference.speed.AccelerationAt(s), -kSpeed.deceleration - 1e-9);
  }
  for (const SpeedCap& cap : plan.caps) {
    EXPECT_LE(plan.reference.speed.SpeedAt(0.5 * (cap.from + cap.to)), cap.speed + 1e-9);
  }
  // At every step of the curvature, including the joints, the speed is so low that the offset is
  // below 0.1 m.
  double joint = 0.0;
  for (std::size_t i = 1; i < path.segments().size(); ++i) {
    const Segment& before = path.segments()[i - 1];
    joint += before.length;
    const double speed =
        StepSpeed(ReferenceCar(), before.CurvatureAt(before.length), path.segments()[i].curvature);
    EXPECT_LE(plan.reference.speed.SpeedAt(joint), std::max(1.001 * speed, 0.3)) << joint;
  }
  EXPECT_FALSE(detour.best.collides);
  EXPECT_TRUE(detour.current.collides);
  EXPECT_LT(detour.best.total, detour.current.total);
  EXPECT_NEAR(detour.current.length, 100.0, Tolerance(1e-9));
}

TEST_P(EveryDetour, IsTheSameEveryTime) {
  const Detour first = PlanDetour(Blocked(), GetParam(), {});
  const Detour second = PlanDetour(Blocked(), GetParam(), {});
  ASSERT_TRUE(first.route && second.route);
  EXPECT_EQ((*first.route)->reference.path.segments(), (*second.route)->reference.path.segments());
  EXPECT_EQ(first.tried, second.tried);
}

TEST_P(EveryDetour, IsNotTakenWhereStayingScoresBetter) {
  const Detour detour =
      PlanDetour(Blocked(), GetParam(), {.comparator = {.collision_penalty = 0.0}});
  EXPECT_FALSE(detour.route);
  // The planner finds a detour, but it costs more than the current path.
  EXPECT_GT(detour.best.total, detour.current.total);
  EXPECT_TRUE(std::isfinite(detour.best.total));
  EXPECT_NE(detour.why.find("scores"), std::string::npos) << detour.why;
}

TEST_P(EveryDetour, SaysWhyThereIsNone) {
  DetourRequest request = Blocked();
  // Walls surround the goal.
  for (const auto& [x, y, length, width] :
       {std::array{100.0, 0.0, 1.0, 61.0}, std::array{150.0, 0.0, 1.0, 61.0},
        std::array{125.0, 30.0, 51.0, 1.0}, std::array{125.0, -30.0, 51.0, 1.0}}) {
    request.obstacles.push_back({{x, y, 0.0}, length, width});
  }
  const Detour detour = PlanDetour(request, GetParam(), {.attempts = 1});
  EXPECT_FALSE(detour.route);
  EXPECT_FALSE(detour.why.empty());
  EXPECT_TRUE(std::isinf(detour.best.total));
}

TEST(PlanDetour, GoesTheWayTheWindBlows) {
  // A box blocks the middle of the path. Both ways around the box are equally long, but the wind is
  // stronger on the left.
  DetourRequest request = Blocked();
  request.obstacles = {{{50.0, 0.0, 0.0}, 4.0, 8.0}};
  const auto side_of = [&](double strength) {
    request.wind.gusts = {{.velocity = {strength, 0.0},
                           .from = 0.0,
                           .shape = GustShape::kStep,
                           .area = OrientedBox{{50.0, 20.0, 0.0}, 60.0, 37.0}}};
    const Detour detour =
        PlanDetour(request, PlannerOptions{RrtPlannerOptions{}}, {.attempts = 12});
    EXPECT_TRUE(detour.route) << detour.why;
    double side = 0.0;
    const Path& path = (*detour.route)->reference.path;
    for (double s = 0.0; s < path.length(); s += 0.5) {
      const double y = path.At(s).pose.y;
      side = std::abs(y) > std::abs(side) ? y : side;
    }
    return side;
  };
  EXPECT_GT(side_of(2.0), 0.0);
  EXPECT_LT(side_of(-2.0), 0.0);
}

TEST(PlanDetour, NeedsAStraightStretchToLeaveOn) {
  DetourRequest request = Blocked();
  const Path bent({0.0, 0.0, 0.0}, {{120.0, 0.01}});
  request.route.reference.path = bent;
  request.driven = request.route;
  const Detour detour = PlanDetour(request, Forwards(), {});
  EXPECT_FALSE(detour.route);
  EXPECT_EQ(detour.tried, 0);
}

TEST(PlanDetour, RefusesPlannersThatCannot) {
  EXPECT_THROW(PlanDetour(Blocked(), HybridAStarOptions{}, {}), InternalError);
  EXPECT_THROW(PlanDetour(Blocked(), FilletOptions{}, {}), InternalError);
  EXPECT_THROW(PlanDetour(Blocked(), Forwards(), {.attempts = 0}), InternalError);
}

TEST(PlanDetour, NeedsAWayBetweenItsEnds) {
  // The car is past the box and 0.5 m before the goal. A detour would leave the path at the goal
  // and return to it at the goal.
  DetourRequest request = Blocked();
  request.obstacles = {{{108.0, 1.0, 0.0}, 4.0, 9.0}};
  request.station = 119.5;
  request.station_speed = 0.0;
  const Detour detour = PlanDetour(request, Forwards(), {});
  EXPECT_FALSE(detour.route);
  EXPECT_EQ(detour.why, "it would leave the path where it returns to it");
}

TEST(PlanDetour, LeadsOnFromBehindTheStartOfThePlan) {
  // An impact has thrown the car back behind the start of its plan. The plan is extended straight
  // before its start.
  DetourRequest request = Blocked();
  const Path rest({20.0, 0.0, 0.0}, {{100.0, 0.0}});
  request.driven.reference = {rest, StopAtEnd(100.0, 0.0, kSpeed)};
  request.station = -1.5;
  request.station_speed = 0.0;
  const Detour detour = PlanDetour(request, Forwards(), {});
  ASSERT_TRUE(detour.route) << detour.why;
  const Path& path = (*detour.route)->reference.path;
  EXPECT_NEAR(path.At(0.0).pose.x, 18.5, Tolerance(1e-9));
  // The joined path ends at the goal. At the goal, the planner's curves have an error of up to 1e-6
  // m.
  const Pose2 end = path.At(path.length()).pose;
  EXPECT_NEAR(end.x, 120.0, Tolerance(1e-5));
  EXPECT_NEAR(end.y, 0.0, Tolerance(1e-5));
}

/// Walls of growing width block the path. The trees find a way around only some of the walls.
TEST(DetourOfRandomTrees, DrawsABoundedNumberOfSamples) {
  for (const char* name : {"rrt", "rrt_star"}) {
    const auto& entries = Planners();
    const auto entry = std::find_if(entries.begin(), entries.end(), [&](const PlannerEntry& each) {
      return each.name == std::string(name);
    });
    ASSERT_NE(entry, entries.end());
    for (const double width : {6.0, 12.0, 30.0, 60.0}) {
      DetourRequest request = Blocked();
      request.obstacles = {{{44.0, 1.0, 0.0}, 2.0, width}};
      const Detour detour = PlanDetour(request, entry->defaults, {});
      EXPECT_LE(detour.samples, kMaxDetourSamples) << name << ", " << width << " m";
      if (!detour.route && detour.samples == kMaxDetourSamples) {
        EXPECT_NE(detour.why.find("; the search ended after 200000 random samples"),
                  std::string::npos)
            << detour.why;
      }
    }
  }
}

}  // namespace
}  // namespace trackbed
