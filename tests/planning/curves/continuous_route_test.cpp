#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "src/planning/curves/route_time.h"
#include "tests/planning/poses.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/common/collision_checker.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/lead_in.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/route.h"
#include "trackbed/planning/curves/curve_planners.h"

// Routes of continuous curvature, as the planners `dubins` and `reeds_shepp` plan them.
namespace trackbed {
namespace {

constexpr double kFraction = 0.9;

template <typename Options>
Options Continuous(CurveCurvature curvature, CurveObjective objective = CurveObjective::kLength) {
  Options options;
  options.curvature = curvature;
  options.max_steering_rate_fraction = kFraction;
  options.objective = objective;
  return options;
}

struct Planned {
  const char* name;
  PlannerEntry entry;
  PlannerOptions options;
  bool backwards;
  bool steps_at_cusps;
};

std::vector<Planned> Planners(CurveObjective objective = CurveObjective::kLength) {
  return {{"dubins", DubinsPlanner(),
           Continuous<DubinsOptions>(CurveCurvature::kContinuous, objective), false, false},
          {"reeds_shepp", ReedsSheppPlanner(),
           Continuous<ReedsSheppOptions>(CurveCurvature::kContinuous, objective), true, false},
          {"reeds_shepp at cusps", ReedsSheppPlanner(),
           Continuous<ReedsSheppOptions>(CurveCurvature::kCuspSteps, objective), true, true}};
}

PlanRequest ContinuousRequest(std::vector<Vec2> waypoints, std::vector<double> headings) {
  PlanRequest request;
  request.vehicle = ReferenceCar();
  request.start = {waypoints[0].x(), waypoints[0].y(), headings[0]};
  request.waypoints = std::move(waypoints);
  request.headings = std::move(headings);
  request.speed = {.speed = 3.0, .acceleration = 1.0, .deceleration = 1.5};
  return request;
}

PlanRequest RandomRoute(Random& random) {
  std::vector<Vec2> waypoints;
  std::vector<double> headings;
  for (int left = 2 + random.Below(2); left > 0; --left) {
    const Pose2 pose = RandomPose(random, 25.0);
    waypoints.push_back(pose.position());
    headings.push_back(pose.yaw);
  }
  return ContinuousRequest(std::move(waypoints), std::move(headings));
}

/// Checks that the steering can follow the plan, at the speeds of its profile.
void ExpectFollowable(const Planned& planner, const PlanRequest& request, const Plan& plan) {
  ASSERT_TRUE(plan.ok()) << planner.name << ": " << plan.reason;
  EXPECT_TRUE(plan.stops.empty());
  const VehicleParams& car = request.vehicle;
  const double most = 1.0 / car.min_turning_radius();
  double station = 0.0;
  const Segment* before = nullptr;
  for (const Segment& segment : plan.reference.path.segments()) {
    const bool is_cusp = before != nullptr && before->direction != segment.direction;
    ASSERT_TRUE(planner.backwards || segment.direction > 0);
    if (before != nullptr && !(is_cusp && planner.steps_at_cusps)) {
      ASSERT_NEAR(segment.curvature, before->CurvatureAt(before->length), Tolerance(1e-12));
    }
    ASSERT_LE(std::abs(segment.CurvatureAt(segment.length)), most);
    const double rate = kFraction * car.steering_rate * (1.0 + Tolerance(1e-9));
    for (int i = 0; i <= 4; ++i) {
      const double along = segment.length * i / 4.0;
      // The steering angle is atan(L kappa), its derivative by kappa L/(1 + (L kappa)^2).
      const double bend = car.wheelbase * segment.CurvatureAt(along);
      ASSERT_LE(plan.reference.speed.SpeedAt(station + along) * car.wheelbase *
                    std::abs(segment.sharpness),
                rate * (1.0 + bend * bend))
          << planner.name;
    }
    station += segment.length;
    before = &segment;
  }
  const std::vector<Pose2> stops = PlannedStops(request);
  const Path& path = plan.reference.path;
  // Rounding of sums of a few dozen segments.
  EXPECT_LE(Apart(path.At(path.length()).pose, stops.back()), Tolerance(1e-9));
  for (const Pose2& stop : stops) {
    EXPECT_LE(std::abs(path.Project(stop).cross_track), Tolerance(1e-9));
  }
}

TEST(ContinuousRoute, IsFollowedAtTheSpeedOfTheMission) {
  Random random(1);
  for (int i = 0; i < 12; ++i) {
    const PlanRequest request = RandomRoute(random);
    for (const Planned& planner : Planners()) {
      const Plan plan = planner.entry.plan(request, planner.options);
      ExpectFollowable(planner, request, plan);
      EXPECT_TRUE(plan.caps.empty());
      const Path& path = plan.reference.path;
      if (SplitIntoLegs(path).size() == 1) {
        const double time = StopAtEnd(path.length(), 0.0, request.speed).TimeAt(path.length());
        EXPECT_NEAR(plan.reference.speed.TimeAt(path.length()), time, Tolerance(1e-9));
      }
    }
  }
}

TEST(ContinuousRoute, KeepsTheLateralAcceleration) {
  Random random(5);
  for (int i = 0; i < 6; ++i) {
    PlanRequest request = RandomRoute(random);
    request.speed.speed = 12.0;
    for (const Planned& planner : Planners(CurveObjective::kTime)) {
      const Plan plan = planner.entry.plan(request, planner.options);
      ExpectFollowable(planner, request, plan);
      for (const PathPoint& point : plan.reference.path.Sample(0.1)) {
        const double speed = plan.reference.speed.SpeedAt(point.s);
        // The default of max_lateral_acceleration; half of the grip is more.
        ASSERT_LE(speed * speed * std::abs(point.curvature), 3.0 * (1.0 + Tolerance(1e-9)))
            << planner.name << " at " << point.s;
      }
    }
  }
}

TEST(ContinuousRoute, IsNotLongerWhereTheCurvatureMayStep) {
  Random random(4);
  for (int i = 0; i < 20; ++i) {
    const Pose2 from = RandomPose(random, 15.0);
    const Pose2 to = RandomPose(random, 15.0);
    const PlanRequest request =
        ContinuousRequest({from.position(), to.position()}, {from.yaw, to.yaw});
    double before = HUGE_VAL;
    // From forwards only to the largest freedom; a change of direction costs 5 m.
    for (const Planned& planner : Planners()) {
      const Plan plan = planner.entry.plan(request, planner.options);
      ASSERT_TRUE(plan.ok()) << plan.reason;
      const Path& path = plan.reference.path;
      const double cost = path.length() + 5.0 * static_cast<double>(SplitIntoLegs(path).size() - 1);
      EXPECT_LE(cost, before + Tolerance(1e-9)) << planner.name;
      before = cost;
    }
  }
}

TEST(ContinuousRoute, IsNoSlowerForTheObjectiveTime) {
  Random random(2);
  for (int i = 0; i < 4; ++i) {
    const PlanRequest request = RandomRoute(random);
    const std::vector<Planned> fastest = Planners(CurveObjective::kTime);
    const std::vector<Planned> shortest = Planners();
    for (std::size_t k = 0; k < fastest.size(); ++k) {
      const Plan fast = fastest[k].entry.plan(request, fastest[k].options);
      ExpectFollowable(fastest[k], request, fast);
      if (!fastest[k].backwards) {
        // The time in which the wheels turn at cusps is not part of the profile.
        const Plan plain = shortest[k].entry.plan(request, shortest[k].options);
        EXPECT_LE(TotalTime(request, fast), TotalTime(request, plain) + Tolerance(1e-9));
      }
    }
  }
}

TEST(ContinuousRoute, TurnsTheWheelsAtRestInsteadOfALoop) {
  // With straight wheels at the start and at the goal, the car would drive a loop of 45 m or more.
  // The plan with steps turns the wheels at rest and drives at most 21 m. Turning the wheels before
  // the start takes time, too. On the way to the last goal, the plan with steps also turns the
  // wheels at rest at the end of an arc of 0.12 m.
  const Planned planner = Planners(CurveObjective::kTime).front();
  const Planned steps{"steps", DubinsPlanner(), Continuous<DubinsOptions>(CurveCurvature::kSteps),
                      false, false};
  for (const Pose2& goal : {Pose2{8.99, 6.86, 0.32}, Pose2{10.36, -12.4, -0.29},
                            Pose2{15.55, -2.97, -1.77}, Pose2{6.172, -8.065, -2.028}}) {
    const PlanRequest request = ContinuousRequest({{0, 0}, goal.position()}, {0.0, goal.yaw});
    const Plan plan = planner.entry.plan(request, planner.options);
    ExpectFollowable(planner, request, plan);
    EXPECT_LT(plan.reference.path.length(), 30.0);
    EXPECT_LE(TotalTime(request, plan),
              TotalTime(request, steps.entry.plan(request, steps.options)));
  }
}

TEST(ContinuousRoute, BeginsWithTheSteeringOfARollingCar) {
  Random random(3);
  for (int i = 0; i < 12; ++i) {
    PlanRequest request = RandomRoute(random);
    request.start_speed = 3.0;
    // The curvature is at most that of the planner's arcs, 1/(1.1 r).
    request.start_steering = random.Uniform(-0.9, 0.9) * request.vehicle.steering_limit;
    for (const Planned& planner : Planners()) {
      const Plan plan = planner.entry.plan(request, planner.options);
      ExpectFollowable(planner, request, plan);
      const Segment& first = plan.reference.path.segments().front();
      EXPECT_EQ(first.direction, 1);
      EXPECT_NEAR(first.curvature, CurvatureForSteering(request.vehicle, request.start_steering),
                  Tolerance(1e-12));
    }
  }
}

TEST(ContinuousRoute, StraightensTheWheelsOfACarThatIsTooFastForItsTurn) {
  // At 8 m/s, the turns of a mission at 8 m/s are wider than the distance to the goal; the bend of
  // the wheels' steering has a lateral acceleration of 8^2 tan(0.3)/2.7 = 7.3 m/s^2.
  PlanRequest request = ContinuousRequest({{0.0, 0.0}, {45.0, 12.0}}, {0.0, 1.2});
  request.speed.speed = 8.0;
  request.start_speed = 8.0;
  request.start_steering = 0.3;
  for (const Planned& planner : Planners(CurveObjective::kTime)) {
    const Plan plan = planner.entry.plan(request, planner.options);
    ASSERT_TRUE(plan.ok()) << planner.name << ": " << plan.reason;
    const LeadIn lead = ComputeLeadIn(request, 0.0, 0.0);
    const std::vector<Segment>& segments = plan.reference.path.segments();
    // All but the last segment of the lead-in straighten the wheels.
    ASSERT_GT(segments.size(), lead.segments.size());
    double station = 0.0;
    for (std::size_t i = 0; i + 1 < lead.segments.size(); ++i) {
      EXPECT_EQ(segments[i].curvature, lead.segments[i].curvature) << planner.name;
      EXPECT_EQ(segments[i].sharpness, lead.segments[i].sharpness) << planner.name;
      station += segments[i].length;
    }
    for (double s = station + 0.1; s < plan.reference.path.length(); s += 0.1) {
      const double speed = plan.reference.speed.SpeedAt(s);
      EXPECT_LE(speed * speed * std::abs(plan.reference.path.At(s).curvature),
                3.0 * (1.0 + Tolerance(1e-9)))
          << planner.name << " at " << s;
    }
    EXPECT_TRUE(FindExcesses(plan, request).empty()) << planner.name;
  }
}

TEST(ContinuousRoute, KeepsClearOfObstacles) {
  PlanRequest request = ContinuousRequest({{0.0, 0.0}, {40.0, 0.0}}, {0.0, 0.0});
  request.obstacles = {{{20.0, 0.0, 0.3}, 3.0, 2.0}};
  for (const Planned& planner : Planners()) {
    const Plan plan = planner.entry.plan(request, planner.options);
    ExpectFollowable(planner, request, plan);
    const CollisionChecker clear(request.vehicle, request.obstacles, 0.3);
    EXPECT_FALSE(clear.FirstBlocked(plan.reference.path)) << planner.name;
  }
}

TEST(ContinuousRoute, NamesTheWaypointThatNoCurveReaches) {
  PlanRequest request = ContinuousRequest({{0.0, 0.0}, {40.0, 0.0}}, {0.0, 0.0});
  request.obstacles = {{{20.0, 0.0, 0.0}, 1.0, 400.0}};
  for (const Planned& planner : Planners()) {
    const Plan plan = planner.entry.plan(request, planner.options);
    EXPECT_EQ(plan.status, PlanStatus::kNoPath);
    EXPECT_NE(plan.reason.find("curves to waypoint 1 collide"), std::string::npos) << plan.reason;
  }
}

}  // namespace
}  // namespace trackbed
