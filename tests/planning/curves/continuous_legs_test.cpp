#include "src/planning/curves/continuous_legs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "src/planning/curves/sharp_turns.h"
#include "tests/planning/poses.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/planning/common/route.h"

namespace trackbed {
namespace {

constexpr double kLegRadius = 5.6;  // [m]

ContinuousRoute TimeRoute() {
  return {.objective = CurveObjective::kTime,
          .max_lateral_acceleration = 3.0,
          .max_steering_rate_fraction = 0.9,
          .radius = kLegRadius,
          .min_speed = 0.3};
}

PlanRequest RequestThrough(std::vector<Vec2> waypoints) {
  PlanRequest request;
  request.vehicle = ReferenceCar();
  const Vec2 leg = waypoints[1] - waypoints[0];
  request.start = {waypoints[0].x(), waypoints[0].y(), std::atan2(leg.y(), leg.x())};
  request.waypoints = std::move(waypoints);
  request.speed = {.speed = 5.0, .acceleration = 1.0, .deceleration = 1.5};
  return request;
}

LegEnds RandomEnds(Random& random) {
  const auto curvature = [&] { return 0.5 / kLegRadius * (random.Below(5) - 2); };
  return {.from = {RandomPose(random, 25.0), curvature()},
          .to = {RandomPose(random, 25.0), curvature()},
          .is_first = random.Below(4) == 0,
          .is_last = random.Below(4) == 0};
}

/// Returns the cost of the cheapest leg of a car that starts at rest, from all curves without any
/// bound.
double CheapestOfAll(const ContinuousRoute& route, const PlanRequest& request,
                     const LegFinder& finder, const LegEnds& ends) {
  const LegLimits limits = LimitsOfMotion(route, request);
  const auto sharpness = [&](double speed) {
    return limits.steering_rate / (limits.wheelbase * speed);
  };
  const double bend = std::max(std::abs(ends.from.curvature), std::abs(ends.to.curvature));
  double least = kNoCurve;
  const auto take = [&](const ShortestCurve& word, double speed) {
    if (std::isfinite(word.length)) {
      least = std::min(least, LegTime(limits, LegPieces(limits, ToSegments(word), speed),
                                      ends.is_first ? 0.0 : speed, ends.is_last ? 0.0 : speed));
    }
  };
  const std::vector<double> speeds = finder.Speeds();
  for (const double first : speeds) {
    // A first leg may keep the curvature at the start.
    const double own =
        std::max(finder.MaxCurvature(first), ends.is_first ? std::abs(ends.from.curvature) : 0.0);
    if (bend <= own * (1.0 + 1e-9)) {
      for (const ShortestCurve& word :
           ContinuousCurves({1.0 / own, sharpness(first)}).DubinsWords(ends.from, ends.to)) {
        take(word, first);
      }
    }
    for (const double last : speeds) {
      const double radius = 1.0 / finder.MaxCurvature(std::max(first, last));
      if (first != last && bend * radius <= 1.0) {
        take(TwoTurns(radius, sharpness(first), sharpness(last), ends.from, ends.to),
             std::min(first, last));
      }
    }
  }
  return least;
}

TEST(ContinuousLegs, CheapestLegIsThatOfAllCurves) {
  const ContinuousRoute route = TimeRoute();
  const PlanRequest request = RequestThrough({{0, 0}, {10, 0}});
  LegFinder finder(route, request);
  Random random(47);
  for (int i = 0; i < 60; ++i) {
    const LegEnds ends = RandomEnds(random);
    const double least = CheapestOfAll(route, request, finder, ends);
    const ContinuousLeg leg = finder.Cheapest(ends, finder.Speeds(), kNoCurve);
    EXPECT_NEAR(leg.cost, least, Tolerance(1e-12) * least) << i;
    const Path path(ends.from.pose, leg.segments);
    EXPECT_LE(Apart(path.At(path.length()).pose, ends.to.pose), Tolerance(1e-9));
  }
}

TEST(ContinuousLegs, BoundOnlyLeavesOutLegsThatCostMore) {
  const ContinuousRoute route = TimeRoute();
  const PlanRequest request = RequestThrough({{0, 0}, {10, 0}});
  LegFinder finder(route, request);
  Random random(48);
  for (int i = 0; i < 60; ++i) {
    const LegEnds ends = RandomEnds(random);
    const double cost = finder.Cheapest(ends, finder.Speeds(), kNoCurve).cost;
    EXPECT_EQ(finder.Cheapest(ends, finder.Speeds(), cost * (1.0 + 1e-9)).cost, cost) << i;
    EXPECT_EQ(finder.Cheapest(ends, finder.Speeds(), cost * (1.0 - 1e-9)).cost, kNoCurve) << i;
  }
}

TEST(ContinuousLegs, CostsFromOtherRoutesChangeNoPlan) {
  // Routes that differ in a waypoint, in the start speed and in the turns at rest share the costs
  // of their legs. Each plan must equal the plan that shares no costs.
  LegCosts shared;
  for (const double start_speed : {0.0, 4.0}) {
    for (const double y : {8.0, 11.0}) {
      for (const bool at_rest : {false, true}) {
        ContinuousRoute route = TimeRoute();
        route.turns_at_start = at_rest;
        route.turns_at_goal = at_rest;
        PlanRequest request = RequestThrough({{0, 0}, {14, 9}, {30, y}, {38, -9}, {60, 0}});
        request.start_speed = start_speed;
        LegCosts own;
        const Plan alone = PlanContinuousRoute(route, request, own);
        const Plan plan = PlanContinuousRoute(route, request, shared);
        ASSERT_TRUE(plan.ok() && alone.ok()) << plan.reason << alone.reason;
        const std::vector<Segment>& segments = plan.reference.path.segments();
        ASSERT_EQ(segments.size(), alone.reference.path.segments().size());
        for (std::size_t i = 0; i < segments.size(); ++i) {
          const Segment& expected = alone.reference.path.segments()[i];
          EXPECT_EQ(segments[i].length, expected.length);
          EXPECT_EQ(segments[i].curvature, expected.curvature);
          EXPECT_EQ(segments[i].sharpness, expected.sharpness);
        }
      }
    }
  }
}

}  // namespace
}  // namespace trackbed
