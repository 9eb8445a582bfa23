#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/planning/grid/hybrid_path_check.h"
#include "tests/planning/poses.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/planning/common/route.h"
#include "trackbed/planning/curves/continuous_curvature.h"
#include "trackbed/planning/grid/hybrid_astar.h"
#include "trackbed/planning/grid/hybrid_astar_planner.h"

// Paths of continuous curvature by hybrid A*.
namespace trackbed {
namespace clothoid_search_test {

/// Returns how the reference car drives at 3 m/s.
ClothoidDrive DriveOfReferenceCar() {
  ClothoidDrive drive;
  drive.speed = 3.0;
  drive.steering_rate = 0.6 * ReferenceCar().steering_rate;
  return drive;
}

HybridAStarOptions Options(CurveCurvature curvature) {
  HybridAStarOptions options;
  options.curvature = curvature;
  return options;
}

/// Returns a problem with a bay between parked cars, which the car leaves forwards.
HybridAStarProblem Bay(const Pose2& start, const Pose2& goal) {
  HybridAStarProblem problem{.start = start, .goal = goal, .obstacles = {}};
  for (const double x : {8.0, 11.0, 14.0, 17.0, 23.0, 26.0, 29.0}) {
    problem.obstacles.push_back({{x, -5.0, 0.5 * kPi}, 4.5, 1.8});
  }
  problem.obstacles.push_back({{18.0, 7.0, 0.0}, 50.0, 1.0});
  problem.obstacles.push_back({{18.0, -9.0, 0.0}, 50.0, 1.0});
  problem.clothoids = DriveOfReferenceCar();
  return problem;
}

/// Checks that the curvature is continuous where it must be, and that the steering can follow at
/// the lowest speed.
void ExpectContinuous(const HybridAStarProblem& problem, const HybridAStarOptions& options,
                      const HybridAStarResult& result) {
  ExpectGood(problem, options, result);
  const bool steps = options.curvature == CurveCurvature::kCuspSteps;
  const ClothoidDrive& drive = problem.clothoids;
  // Curvatures of at most 0.2 1/m are sums of a few dozen numbers.
  const double rounding = Tolerance(1e-12);
  const Segment* before = nullptr;
  for (const Segment& segment : result.segments) {
    if (before == nullptr) {
      EXPECT_TRUE((steps && drive.rests_at_start) ||
                  std::abs(segment.curvature - drive.start_curvature) <= rounding);
    } else if (!steps || before->direction == segment.direction) {
      EXPECT_NEAR(segment.curvature, before->CurvatureAt(before->length), rounding);
    }
    EXPECT_LE(std::abs(segment.CurvatureAt(segment.length)),
              1.0 / (1.1 * ReferenceCar().min_turning_radius()) + rounding);
    EXPECT_LE(std::abs(segment.sharpness) * ReferenceCar().wheelbase * options.min_speed,
              drive.steering_rate * (1.0 + Tolerance(1e-9)));
    before = &segment;
  }
  ASSERT_NE(before, nullptr);
  EXPECT_TRUE((steps && drive.rests_at_goal) ||
              std::abs(before->CurvatureAt(before->length)) <= rounding);
}

TEST(ClothoidSearch, HasContinuousCurvature) {
  const Pose2 lane{0.0, 0.0, 0.0};
  const Pose2 bay{20.0, -6.2, 0.5 * kPi};
  for (const CurveCurvature curvature : {CurveCurvature::kContinuous, CurveCurvature::kCuspSteps}) {
    const HybridAStarOptions options = Options(curvature);
    for (const auto& [from, to] : {std::pair(lane, bay), std::pair(bay, lane)}) {
      for (const bool rests : {true, false}) {
        HybridAStarProblem problem = Bay(from, to);
        problem.clothoids.rests_at_start = rests;
        problem.clothoids.rests_at_goal = rests;
        ExpectContinuous(problem, options, SearchHybridAStar(ReferenceCar(), problem, options));
      }
    }
  }
}

TEST(ClothoidSearch, IsNotLongerThanTheShortestCurveAtOneSpeed) {
  // At one speed on a plane, the cost without weights is the length, and the shortest curve of
  // continuous curvature is one of the paths.
  Random random(3);
  HybridAStarOptions options = Options(CurveCurvature::kContinuous);
  options.reverse = false;
  options.steering_cost = 0.0;
  options.min_speed = 1.0;
  for (int i = 0; i < 10; ++i) {
    HybridAStarProblem problem{
        .start = RandomPose(random, 15.0), .goal = RandomPose(random, 15.0), .obstacles = {}};
    problem.clothoids = {.speed = 1.0,
                         .min_speed = 1.0,
                         .steering_rate = 0.3,
                         .start_curvature = i % 2 == 0 ? 0.0 : random.Uniform(-0.1, 0.1)};
    const HybridAStarResult result = SearchHybridAStar(ReferenceCar(), problem, options);
    ExpectContinuous(problem, options, result);
    const ContinuousCurves curves({.radius = 1.1 * ReferenceCar().min_turning_radius(),
                                   .sharpness = 0.3 / ReferenceCar().wheelbase});
    const double shortest =
        curves.Dubins({problem.start, problem.clothoids.start_curvature}, {problem.goal, 0.0})
            .length;
    EXPECT_LE(result.cost, shortest * (1.0 + Tolerance(1e-9)));
    EXPECT_NEAR(result.cost, Path(problem.start, result.segments).length(), Tolerance(1e-9));
  }
}

TEST(ClothoidSearch, SlowsDownARollingCarInTime) {
  Random random(4);
  for (int i = 0; i < 6; ++i) {
    HybridAStarProblem problem = Bay({0.0, 0.0, 0.0}, {random.Uniform(34.0, 40.0), 1.0, 0.0});
    problem.obstacles.push_back({{random.Uniform(20.0, 24.0), -0.5, 0.2}, 3.0, 1.0});
    problem.rolls = true;
    ClothoidDrive& drive = problem.clothoids;
    drive.start_speed = random.Uniform(1.0, 4.0);
    drive.start_curvature = random.Uniform(-0.05, 0.05);
    const HybridAStarOptions options = Options(CurveCurvature::kCuspSteps);
    const HybridAStarResult result = SearchHybridAStar(ReferenceCar(), problem, options);
    ExpectContinuous(problem, options, result);
    double station = 0.0;
    for (const Segment& segment : result.segments) {
      const double square =
          drive.start_speed * drive.start_speed - 2.0 * drive.deceleration * station;
      if (square > 0.0) {
        EXPECT_EQ(segment.direction, 1);
        // The steering angle is atan(L kappa).
        EXPECT_LE(std::sqrt(square) * ReferenceCar().wheelbase * std::abs(segment.sharpness),
                  drive.steering_rate * (1.0 + Tolerance(1e-8)));
      }
      station += segment.length;
    }
  }
}

TEST(ClothoidSearch, PlansSpeedsThatTheSteeringFollows) {
  for (const double start_speed : {0.0, 2.0}) {
    PlanRequest request;
    request.vehicle = ReferenceCar();
    request.waypoints = {{0.0, 0.0}, {20.0, 9.0}, {50.0, 0.0}};
    request.headings = {0.0, 0.7, 0.0};
    request.obstacles = {{{10.0, 2.0, 0.3}, 3.0, 2.0}, {{35.0, 6.0, 0.0}, 2.0, 3.0}};
    request.speed = {.speed = 3.0, .acceleration = 1.0, .deceleration = 1.5};
    request.start_speed = start_speed;
    request.start_steering = start_speed > 0.0 ? 0.05 : 0.0;
    const PlannerEntry planner = HybridAStarPlanner();
    const HybridAStarOptions options = Options(CurveCurvature::kCuspSteps);
    const Plan plan = planner.plan(request, options);
    ASSERT_TRUE(plan.ok()) << plan.reason;
    EXPECT_TRUE(plan.stops.empty());
    for (const PathPoint& point : plan.reference.path.Sample(0.05)) {
      // The profile brakes to a cap in front of it, and the sharpness of a point belongs to the
      // segment that begins there.
      EXPECT_LE(plan.reference.speed.SpeedAt(point.s) * request.vehicle.wheelbase *
                    std::abs(point.sharpness),
                options.max_steering_rate_fraction * request.vehicle.steering_rate *
                    (1.0 + Tolerance(1e-6)))
          << "at " << point.s << " with " << start_speed << " m/s";
    }
    for (const Pose2& stop : PlannedStops(request)) {
      EXPECT_LE(std::abs(plan.reference.path.Project(stop).cross_track), Tolerance(1e-9));
    }
  }
}

}  // namespace clothoid_search_test
}  // namespace trackbed
