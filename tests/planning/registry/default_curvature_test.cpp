#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/curves/curve_planners.h"
#include "trackbed/planning/grid/hybrid_astar.h"
#include "trackbed/planning/registry/planners.h"

// The default `curvature: auto`: a path of continuous curvature where the car can drive one, and
// otherwise the path with steps.
namespace trackbed {
namespace default_curvature_test {

template <typename Options>
PlannerOptions With(CurveCurvature curvature) {
  Options options;
  options.curvature = curvature;
  return options;
}

struct CurvePlanner {
  const char* name;
  PlannerOptions (*with)(CurveCurvature);
};

const std::vector<CurvePlanner> kCurvePlanners{{"dubins", With<DubinsOptions>},
                                               {"reeds_shepp", With<ReedsSheppOptions>},
                                               {"hybrid_astar", With<HybridAStarOptions>}};

/// Returns a random route: nearly straight, with hairpins, with close waypoints, or any. The car is
/// at rest or rolls at the start, possibly with turned wheels. Half of the routes have obstacles.
PlanRequest RouteThatPeopleDraw(Random& random) {
  PlanRequest request;
  request.vehicle = ReferenceCar();
  const int shape = random.Below(4);
  double yaw = random.Uniform(-kPi, kPi);
  Vec2 at{random.Uniform(-50.0, 50.0), random.Uniform(-50.0, 50.0)};
  const bool has_headings = random.Below(3) > 0;
  request.start = {at.x(), at.y(), yaw};
  for (int left = 2 + random.Below(3); left > 0; --left) {
    request.waypoints.push_back(at);
    if (has_headings) {
      request.headings.push_back(yaw);
    }
    const double turn = shape == 0   ? random.Uniform(-0.03, 0.03)
                        : shape == 1 ? random.Uniform(2.4, 3.6)
                                     : random.Uniform(-1.6, 1.6);
    const double leg = shape == 2 ? random.Uniform(1.0, 12.0) : random.Uniform(5.0, 50.0);
    at += leg * Direction(yaw + random.Uniform(0.3, 1.0) * turn);
    yaw += turn;
  }
  const double speed = random.Uniform(0.5, 8.0);
  request.speed = {.speed = speed, .acceleration = 1.0, .deceleration = 1.5};
  if (random.Below(2) == 0) {
    request.start_speed = speed * random.Uniform(0.0, 1.3);
    request.start_steering = random.Below(2) == 0 ? 0.0 : random.Uniform(-0.3, 0.3);
  }
  const int boxes = random.Below(2) == 0 ? 0 : 1 + random.Below(6);
  for (int i = 0; i < boxes; ++i) {
    const Vec2 place =
        ToWorld(request.start, {random.Uniform(8.0, 60.0), random.Uniform(-20.0, 20.0)});
    request.obstacles.push_back({{place.x(), place.y(), random.Uniform(0.0, kPi)},
                                 random.Uniform(0.5, 6.0),
                                 random.Uniform(0.5, 3.0)});
  }
  return request;
}

/// Returns the driving time of a plan, with the time in which the wheels turn at rest, also before
/// the start [s].
double DrivingTime(const Plan& plan, const PlanRequest& request) {
  const VehicleParams& car = request.vehicle;
  const std::vector<Segment>& segments = plan.reference.path.segments();
  double time = plan.Duration();
  if (request.start_speed == 0.0) {
    time +=
        std::abs(SteeringForCurvature(car, segments.front().curvature) - request.start_steering) /
        car.steering_rate;
  }
  double station = 0.0;
  for (std::size_t i = 1; i < segments.size(); ++i) {
    const Segment& before = segments[i - 1];
    station += before.length;
    const bool stops = before.direction != segments[i].direction ||
                       std::any_of(plan.stops.begin(), plan.stops.end(),
                                   [&](double stop) { return std::abs(stop - station) < 1e-6; });
    if (stops) {
      time += std::abs(SteeringForCurvature(car, segments[i].curvature) -
                       SteeringForCurvature(car, before.CurvatureAt(before.length))) /
              car.steering_rate;
    }
  }
  return time;
}

/// Returns the largest step of curvature at which the car does not stand [1/m].
double LargestStep(const Plan& plan) {
  const std::vector<Segment>& segments = plan.reference.path.segments();
  double largest = 0.0;
  for (std::size_t i = 1; i < segments.size(); ++i) {
    if (segments[i].direction == segments[i - 1].direction) {
      largest = std::max(largest, std::abs(segments[i].curvature -
                                           segments[i - 1].CurvatureAt(segments[i - 1].length)));
    }
  }
  return largest;
}

/// Returns the number of routes of each planner, which the environment variable
/// TRACKBED_DEFAULT_CURVATURE sets.
int Routes() {
  const char* count = std::getenv("TRACKBED_DEFAULT_CURVATURE");
  return count == nullptr ? 12 : std::atoi(count);
}

bool SaysWhyItSteps(const Plan& plan) {
  return std::any_of(plan.notes.begin(), plan.notes.end(), [](const std::string& note) {
    return note.starts_with("the curvature steps, because");
  });
}

TEST(DefaultCurvature, PlansWhatStepsPlanInNoMoreTime) {
  for (const CurvePlanner& planner : kCurvePlanners) {
    Random random(7);
    int continuous = 0;
    for (int i = 0; i < Routes(); ++i) {
      const std::string route = fmt::format("{}, route {}", planner.name, i);
      const PlanRequest request = RouteThatPeopleDraw(random);
      const FeasiblePlan steps = MakePlan(request, planner.with(CurveCurvature::kSteps));
      const FeasiblePlan plan = MakePlan(request, planner.with(CurveCurvature::kAuto));
      ASSERT_TRUE(plan.ok() || !steps.ok()) << route << ": " << plan->reason;
      if (!plan.ok()) {
        EXPECT_EQ(plan->reason, steps->reason) << route;
        continue;
      }
      if (SaysWhyItSteps(plan)) {
        EXPECT_EQ(DrivingTime(plan, request), DrivingTime(steps, request)) << route;
        continue;
      }
      ++continuous;
      // Rounding of curvatures of at most 0.2 1/m.
      EXPECT_LE(LargestStep(plan), Tolerance(1e-9)) << route;
      if (steps.ok()) {
        // Near obstacles, `hybrid_astar` prefers a continuous curvature to a little time. The times
        // are sums of a few hundred numbers.
        const double most = std::string(planner.name) == "hybrid_astar" ? 1.2 : 1.0;
        EXPECT_LE(DrivingTime(plan, request),
                  most * DrivingTime(steps, request) * (1.0 + Tolerance(1e-9)))
            << route;
      }
    }
    EXPECT_GT(continuous, Routes() / 2) << planner.name;
  }
}

TEST(DefaultCurvature, TurnsTheWheelsAtRestOrAtACrawlInsteadOfALoop) {
  // Two opposite bends within 2.6 m: a car with straight wheels at both ends would drive a loop of
  // more than 10 m. The path with steps turns the wheels at rest, the default plan in less time.
  PlanRequest request;
  request.vehicle = ReferenceCar();
  request.start = {0.0, 0.0, 0.0};
  request.waypoints = {{0.0, 0.0}, {2.544, 0.381}};
  request.headings = {0.0, 0.305};
  request.speed = {.speed = 3.0, .acceleration = 1.0, .deceleration = 1.5};
  const FeasiblePlan plan = MakePlan(request, DubinsOptions{});
  ASSERT_TRUE(plan.ok()) << plan->reason;
  EXPECT_FALSE(SaysWhyItSteps(plan));
  EXPECT_LE(LargestStep(plan), Tolerance(1e-9));
  EXPECT_LT(plan->reference.path.length(), 3.0);
  const FeasiblePlan steps = MakePlan(request, DubinsOptions{.curvature = CurveCurvature::kSteps});
  ASSERT_TRUE(steps.ok()) << steps->reason;
  EXPECT_LE(DrivingTime(plan, request), DrivingTime(steps, request));
}

}  // namespace default_curvature_test
}  // namespace trackbed
