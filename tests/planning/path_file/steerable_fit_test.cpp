#include "trackbed/planning/path_file/steerable_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "tests/geometry/random.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/planning/path_file/path_check.h"
#include "trackbed/planning/path_file/path_file_planner.h"
#include "trackbed/planning/registry/planners.h"

// Fits of paths near the full lock of a car.
namespace trackbed {
namespace {

// Lines that join an arc near the smallest radius, without headings or curvatures in the file.
TEST(FitWithinSteering, LetsCheckAndPlanAgreeNearFullLock) {
  Random random(98);
  const VehicleParams car = ReferenceCar();
  int bounded = 0;
  for (int i = 0; i < 12; ++i) {
    const double share = random.Uniform(0.97, 1.01);
    const double curvature = share * CurvatureForSteering(car, car.steering_limit);
    const Path shape({}, {{.length = 12.0},
                          {.length = random.Uniform(0.8, 2.5) / curvature, .curvature = curvature},
                          {.length = 12.0}});
    PathPoints given;
    for (const PathPoint& point : shape.Sample(random.Uniform(0.3, 0.8))) {
      given.points.push_back(point.pose.position());
    }
    PathFileOptions options;
    options.path = std::make_shared<const FittedPath>(FitPath(given, {}));
    const auto steerable = FitWithinSteering(*options.path, car);
    bounded += steerable ? 1 : 0;
    const PathCheck check =
        CheckPath(steerable ? steerable->path : *options.path, car, {.speed = 0.5});
    const bool is_steerable = std::none_of(
        check.faults.begin(), check.faults.end(),
        [](const PathFault& fault) { return fault.kind == PathFaultKind::kSteeringAngle; });
    PlanRequest request;
    request.vehicle = car;
    request.start = options.path->path.At(0.0).pose;
    request.speed = {.speed = 0.5, .acceleration = 1.0, .deceleration = 1.5};
    const Plan plan = *MakePlan(request, options);
    EXPECT_EQ(plan.ok(), is_steerable) << share << ": " << plan.reason;
    // The bound of the fit is 1e-3 below the limit, and exceeded by up to 1e-3.
    EXPECT_TRUE(share > 0.995 || is_steerable) << share;
  }
  EXPECT_GT(bounded, 3);
}

}  // namespace
}  // namespace trackbed
