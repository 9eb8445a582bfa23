#include "trackbed/planning/common/feasibility.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <type_traits>
#include <utility>

#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/course/course.h"
#include "trackbed/planning/fillet/fillet.h"
#include "trackbed/planning/registry/planners.h"

namespace trackbed {
namespace {

/// Returns a car whose tyres have a friction coefficient of 0.9.
VehicleParams Car() {
  VehicleParams car = ReferenceCar();
  car.friction_lateral = 0.9;
  car.friction_longitudinal = 0.9;
  car.max_deceleration = 0.9 * 9.81;
  car.max_acceleration = 4.0;
  car.top_speed = 50.0;
  return car;
}

PlanRequest Request(double speed, const std::vector<Vec2>& waypoints) {
  const Vec2 leg = waypoints.size() > 1 ? Vec2(waypoints[1] - waypoints[0]) : Vec2(1.0, 0.0);
  return {.vehicle = Car(),
          .waypoints = waypoints,
          .start = {waypoints[0].x(), waypoints[0].y(), std::atan2(leg.y(), leg.x())},
          .start_speed = speed,
          .speed = {.speed = speed, .acceleration = 1.0, .deceleration = 1.5}};
}

/// Returns the plan of a course with the given pieces.
Plan Course(const PlanRequest& request, const std::vector<CoursePiece>& pieces) {
  return MakePlan(request, CourseOptions{.segments = pieces});
}

std::vector<std::string> Kinds(const Plan& plan, const PlanRequest& request) {
  std::vector<std::string> kinds;
  for (const Excess& excess : FindExcesses(plan, request)) {
    kinds.push_back(excess.what);
  }
  return kinds;
}

TEST(Feasibility, JudgesEachSideByTheReachOfItsWheels) {
  // The wheels turn to 0.3 rad to the left and 0.4 rad to the right. Without backlash, a bend of
  // 0.35 rad exceeds the limit on the left alone.
  PlanRequest request = Request(1.0, {{0.0, 0.0}, {1.0, 0.0}});
  request.vehicle.steering_response.curve = {{-0.5, -0.4}, {-0.2, -0.2}, {0.2, 0.2}, {0.5, 0.3}};
  const double bend = CurvatureForSteering(request.vehicle, 0.35);
  for (const double side : {-1.0, 1.0}) {
    Plan plan;
    plan.reference.path = Path(request.start, {{5.0, side * bend}});
    plan.reference.speed = SpeedProfile({{0.0, 1.0}, {5.0, 1.0}});
    plan.schedule_speed = plan.reference.speed;
    const std::vector<std::string> kinds = Kinds(plan, request);
    EXPECT_EQ(std::count(kinds.begin(), kinds.end(), "steering angle"), side > 0.0 ? 1 : 0);
  }
}

TEST(Feasibility, SlowsACurveDownToWhatTheTyresHold) {
  // The car brakes at 1.5 m/s^2 on the ramp before the arc, where the curvature is nearly that of
  // the arc. The friction circle leaves a lateral acceleration of v^2/r = sqrt((mu g)^2 - 1.5^2)
  // for the bend. With mu g = 0.9 x 9.81 m/s^2 and r = 20 m, the speed is 13.19 m/s. The ramp is so
  // long that the steering rate does not limit the speed.
  PlanRequest request = Request(18.0, {{0.0, 0.0}});
  const std::vector<CoursePiece> pieces{{.length = 200.0, .curvature = 0.0},
                                        {.length = 60.0, .curvature_to = 0.05},
                                        {.length = 30.0, .curvature = 0.05},
                                        {.length = 60.0, .curvature_to = 0.0},
                                        {.length = 200.0, .curvature = 0.0}};
  const Plan plan = Course(request, pieces);
  ASSERT_TRUE(plan.ok()) << plan.reason;
  ASSERT_EQ(plan.notes.size(), 1U);
  EXPECT_THAT(plan.notes[0], testing::HasSubstr("; combined acceleration "));
  const auto limit = [](double grip) { return std::sqrt(20.0 * std::sqrt(grip * grip - 2.25)); };
  EXPECT_NEAR(plan.reference.speed.SpeedAt(275.0), limit(0.9 * 9.81), Tolerance(1e-9));
  EXPECT_TRUE(FindExcesses(plan, request).empty());
  request.friction = 0.5;
  const Plan wet = Course(request, pieces);
  ASSERT_TRUE(wet.ok()) << wet.reason;
  EXPECT_NEAR(wet.reference.speed.SpeedAt(275.0), limit(0.45 * 9.81), Tolerance(1e-9));
}

TEST(Feasibility, DrivesABendAtTheLimitIfItNeverBrakesInIt) {
  // The path begins with the arc. The car enters the arc at the speed limit of the tyres, v^2/r =
  // mu g.
  PlanRequest request = Request(std::sqrt(0.9 * 9.81 * 20.0), {{0.0, 0.0}});
  request.start_steering = SteeringForCurvature(request.vehicle, 0.05);
  const Plan plan = Course(request, {{.length = 30.0, .curvature = 0.05},
                                     {.length = 60.0, .curvature_to = 0.0},
                                     {.length = 200.0, .curvature = 0.0}});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  EXPECT_TRUE(plan.notes.empty()) << plan.notes[0];
  EXPECT_EQ(plan.reference.speed.SpeedAt(29.0), request.speed.speed);
}

/// Returns the largest used fraction of the friction ellipse over a plan, computed from finite
/// differences of the speed.
double LargestShare(const Plan& plan, double grip_along, double grip_across) {
  constexpr double kSpacing = 0.05;  // [m]
  double largest = 0.0;
  const auto square = [&](double s) { return std::pow(plan.reference.speed.SpeedAt(s), 2.0); };
  for (double s = 0.0; s + kSpacing < plan.reference.path.length(); s += kSpacing) {
    const double along = 0.5 * (square(s + kSpacing) - square(s)) / kSpacing;
    const double across = square(s) * std::abs(plan.reference.path.At(s).curvature);
    largest = std::max(largest, std::hypot(along / grip_along, across / grip_across));
  }
  return largest;
}

TEST(Feasibility, KeepsBrakingInABendWithinTheFrictionEllipse) {
  // An arc of radius 50 m tightens to 20 m, so the car brakes within the bend. The longitudinal and
  // lateral friction coefficients differ.
  for (const double friction : {1.0, 0.5, 0.3}) {
    PlanRequest request = Request(18.0, {{0.0, 0.0}});
    request.vehicle.friction_longitudinal = 0.6;
    request.friction = friction;
    const Plan plan = Course(request, {{.length = 200.0, .curvature = 0.0},
                                       {.length = 60.0, .curvature_to = 0.02},
                                       {.length = 40.0, .curvature = 0.02},
                                       {.length = 60.0, .curvature_to = 0.05},
                                       {.length = 30.0, .curvature = 0.05},
                                       {.length = 60.0, .curvature_to = 0.0},
                                       {.length = 200.0, .curvature = 0.0}});
    ASSERT_TRUE(plan.ok()) << plan.reason;
    EXPECT_TRUE(FindExcesses(plan, request).empty());
    // The planner checks a piece with its largest curvature and speed, so no point of the piece
    // exceeds the ellipse.
    EXPECT_LE(LargestShare(plan, 0.6 * 9.81 * friction, 0.9 * 9.81 * friction),
              1.0 + Tolerance(1e-6))
        << friction;
    // The speed must not be needlessly low. If braking uses 0.7 of the grip, sqrt(1 - 0.49) = 0.71
    // remains for the bend.
    EXPECT_GE(LargestShare(plan, 0.6 * 9.81 * friction, 0.9 * 9.81 * friction), 0.71) << friction;
  }
}

TEST(Feasibility, RefusesOrAllowsAsTheScenarioSays) {
  PlanRequest request = Request(18.0, {{0.0, 0.0}});
  const std::vector<CoursePiece> pieces{{.length = 200.0, .curvature = 0.0},
                                        {.length = 60.0, .curvature_to = 0.05},
                                        {.length = 200.0, .curvature = 0.05}};
  request.infeasible = InfeasiblePolicy::kRefuse;
  const Plan refused = Course(request, pieces);
  EXPECT_EQ(refused.status, PlanStatus::kInfeasible);
  // The lateral acceleration 18^2/20 = 16.2 m/s^2 exceeds the limit 0.9 x 9.81 = 8.83 m/s^2.
  EXPECT_NE(refused.reason.find("lateral acceleration 16.2 m/s^2"), std::string::npos)
      << refused.reason;
  EXPECT_NE(refused.reason.find(" exceeds 8.83 m/s^2 at "), std::string::npos) << refused.reason;
  request.infeasible = InfeasiblePolicy::kAllow;
  const Plan allowed = Course(request, pieces);
  ASSERT_TRUE(allowed.ok());
  ASSERT_EQ(allowed.notes.size(), 1U);
  EXPECT_EQ(allowed.notes[0].find("infeasible, kept anyway: lateral acceleration"), 0U)
      << allowed.notes[0];
}

TEST(Feasibility, SlowsDownWhereTheWheelsTurnTooSlowly) {
  // Within 2 m, the wheels turn by atan(2.7 x 0.1) = 0.2637 rad. If the steering angle were linear
  // in the station, the speed limit would be 0.1506/(0.2637/2) = 1.14 m/s, with the steering rate
  // 0.1506 rad/s. The slope of atan varies by less than 3 % over this range.
  const PlanRequest request = Request(4.0, {{0.0, 0.0}});
  const Plan plan = Course(request, {{.length = 20.0, .curvature = 0.0},
                                     {.length = 2.0, .curvature_to = 0.1},
                                     {.length = 20.0, .curvature = 0.1}});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  EXPECT_NEAR(plan.reference.speed.SpeedAt(21.0),
              request.vehicle.steering_rate * 2.0 / std::atan(0.27), 0.03 * 1.14);
  EXPECT_TRUE(FindExcesses(plan, request).empty());
}

TEST(Feasibility, RefusesAPathThatBeginsCarLengthsFromASmallCar) {
  // The car has a wheelbase of 2.7 um, and the path begins 45 um beside the car. Both are far below
  // the tolerance of 1 mm for a full-size car.
  PlanRequest request = Request(0.0, {{0.0, 0.0}, {1e-3, 0.0}, {2e-3, 0.0}});
  request.vehicle.wheelbase *= 1e-6;
  request.speed.speed = 1e-5;
  request.start.y = 4.5e-5;
  EXPECT_THAT(Kinds(Course(request, {{.length = 1e-3, .curvature = 0.0}}), request),
              testing::IsEmpty());
  Plan plan = Course(request, {{.length = 1e-3, .curvature = 0.0}});
  request.start.y = 0.0;
  EXPECT_THAT(Kinds(plan, request), testing::ElementsAre("initial position error"));
}

TEST(Feasibility, RefusesAStartOnABendForACarThatRolls) {
  PlanRequest request = Request(3.0, {{0.0, 0.0}});
  const std::vector<CoursePiece> bend{{.length = 20.0, .curvature = 0.1}};
  EXPECT_EQ(Course(request, bend).status, PlanStatus::kInfeasible);
  request.start_steering = std::atan(0.27);  // The start steering angle matches the curvature of
                                             // the path.
  EXPECT_TRUE(Course(request, bend).ok());
  request.start_steering = 0.0;
  request.start_speed = 0.0;  // A car at rest turns its wheels before it starts to move.
  EXPECT_TRUE(Course(request, bend).ok());
}

/// Returns the number after the last occurrence of `words` in a text.
double NumberAfter(const std::string& text, const std::string& words) {
  const std::size_t at = text.rfind(words);
  return at == std::string::npos ? NAN : std::stod(text.substr(at + words.size()));
}

TEST(Feasibility, GivesTheStartSteeringThatFits) {
  for (const double curvature : {0.1, -0.03}) {
    PlanRequest request = Request(3.0, {{0.0, 0.0}});
    const std::vector<CoursePiece> bend{{.length = 20.0, .curvature = curvature}};
    request.start_steering = 0.2;
    const Plan refused = Course(request, bend);
    EXPECT_EQ(refused.status, PlanStatus::kInfeasible);
    const double fitting = NumberAfter(refused.reason, "set mission.start.steering: ");
    // The message has four significant digits.
    EXPECT_NEAR(fitting, std::atan(2.7 * curvature), 5e-5) << refused.reason;
    request.start_steering = fitting;
    EXPECT_TRUE(Course(request, bend).ok());
  }
  // If the car cannot steer the bend at all, the reported excess must be the steering angle.
  PlanRequest request = Request(3.0, {{0.0, 0.0}});
  request.vehicle.steering_limit = 0.2;
  Plan plan;
  plan.reference.path = Path(request.start, {{.length = 20.0, .curvature = 0.1}});
  plan.reference.speed = StopAtEnd(20.0, 3.0, request.speed);
  plan.schedule_speed = plan.reference.speed;
  EXPECT_THAT(Kinds(plan, request), testing::ElementsAre("steering angle"));
}

// At a constant speed, the tyres hold a lateral acceleration of v^2 kappa <= 0.9 x 9.81 m/s^2.
// While the car brakes or accelerates with up to 1.5 m/s^2, the friction circle leaves sqrt((0.9 x
// 9.81)^2 - 1.5^2) m/s^2.
TEST(Feasibility, GivesTheStartSpeedForABend) {
  for (const double curvature : {0.1, 0.05, -0.02}) {
    const double highest = std::sqrt(0.9 * 9.81 / std::abs(curvature));
    const double gentle = std::sqrt(std::sqrt(0.81 * 9.81 * 9.81 - 2.25) / std::abs(curvature));
    PlanRequest request = Request(1.3 * highest, {{0.0, 0.0}});
    request.start_steering = std::atan(2.7 * curvature);
    const std::vector<CoursePiece> pieces{{.length = 10.0, .curvature = curvature},
                                          {.length = 60.0, .curvature_to = 0.0},
                                          {.length = 300.0, .curvature = 0.0}};
    const Plan refused = Course(request, pieces);
    EXPECT_EQ(refused.status, PlanStatus::kInfeasible);
    EXPECT_THAT(refused.reason, testing::HasSubstr("start speed "));
    EXPECT_THAT(refused.reason, testing::HasSubstr("lateral acceleration 14.9 m/s^2 exceeds 8.83"));
    EXPECT_THAT(refused.reason, testing::Not(testing::HasSubstr("deceleration")));
    const double given = NumberAfter(refused.reason, "set mission.start.speed to at most ");
    // The bisection stops within 0.4 % of the start speed, and the message rounds down to three
    // digits.
    EXPECT_LE(given, highest) << refused.reason;
    EXPECT_GE(given, gentle - 0.004 * request.start_speed - 0.01 * highest) << refused.reason;
    request.start_speed = given;
    EXPECT_TRUE(Course(request, pieces).ok());
  }
}

TEST(Feasibility, GivesTheStartSpeedForAShortPath) {
  // The speed control brakes with up to 2 x 1.5 m/s^2. The start speed is then at most sqrt(2 x 3
  // m/s^2 x 10 m) = 7.75 m/s.
  PlanRequest request = Request(8.0, {{0.0, 0.0}});
  const Plan refused = Course(request, {{.length = 10.0, .curvature = 0.0}});
  EXPECT_NEAR(NumberAfter(refused.reason, "set mission.start.speed to at most "), std::sqrt(60.0),
              0.004 * 8.0 + 0.01)
      << refused.reason;
}

TEST(Feasibility, RefusesAPathThatBeginsElsewhere) {
  PlanRequest request = Request(3.0, {{0.0, 0.0}, {40.0, 0.0}, {40.0, 40.0}});
  request.start = {-20.0, 0.0, 0.5};
  const Plan plan = MakePlan(request, FilletOptions{});
  EXPECT_EQ(plan.status, PlanStatus::kInfeasible);
  EXPECT_THAT(plan.reason, testing::HasSubstr("initial position error 20 m"));
  EXPECT_THAT(plan.reason, testing::HasSubstr("begins at (0, 0), the car at (-20, 0)"));
  EXPECT_THAT(plan.reason, testing::HasSubstr("set mission.start.yaw: 0)"));
}

TEST(Feasibility, RefusesToBrakeHarderThanTheSpeedControlDoes) {
  // Stopping from 8 m/s within 10 m needs 3.2 m/s^2. The speed control is limited to 2 x 1.5 m/s^2.
  PlanRequest request = Request(8.0, {{0.0, 0.0}});
  const Plan plan = Course(request, {{.length = 10.0, .curvature = 0.0}});
  EXPECT_EQ(plan.status, PlanStatus::kInfeasible);
  EXPECT_NE(plan.reason.find("deceleration 3.2 m/s^2"), std::string::npos) << plan.reason;
  EXPECT_TRUE(Course(request, {{.length = 11.0, .curvature = 0.0}}).ok());
}

TEST(Feasibility, BrakesGentlyOnIce) {
  PlanRequest request = Request(5.0, {{0.0, 0.0}});
  request.friction = 0.1;  // The tyres hold 0.883 m/s^2.
  const Plan plan = Course(request, {{.length = 60.0, .curvature = 0.0}});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  const auto& knots = plan.reference.speed.knots();
  for (std::size_t i = 1; i < knots.size(); ++i) {
    const double change =
        (knots[i].speed * knots[i].speed - knots[i - 1].speed * knots[i - 1].speed) /
        (2.0 * (knots[i].s - knots[i - 1].s));
    EXPECT_GE(change, -0.9 * 9.81 * 0.1);
  }
}

FrictionPatch IceAcross(double from, double length) {
  return {.area = {{from + 0.5 * length, 0.0, 0.0}, length, 20.0}, .friction = 0.05};
}

TEST(Feasibility, BrakesBeforeIceAtTheEnd) {
  // On the last 30 m, the tyres hold 0.999 x 0.9 x 0.05 x 9.81 = 0.441 m/s^2. The grip under both
  // axles counts; the front axle is 2.7 m ahead of the rear axle.
  PlanRequest request = Request(10.0, {{0.0, 0.0}});
  request.friction_patches = {IceAcross(120.0, 40.0)};
  const Plan plan = Course(request, {{.length = 150.0, .curvature = 0.0}});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  EXPECT_TRUE(FindExcesses(plan, request).empty());
  const double ice = 0.999 * 0.05 * 0.9 * 9.81;
  EXPECT_NEAR(plan.reference.speed.AccelerationAt(140.0), -ice, Tolerance(1e-9));
  EXPECT_NEAR(plan.reference.speed.AccelerationAt(115.0), -1.5, Tolerance(1e-9));
}

TEST(Feasibility, NamesTheIceWhereTheCarIsTooFast) {
  // The car is too fast for the ice, even if it brakes at twice the deceleration of the speed
  // control.
  PlanRequest request = Request(10.0, {{0.0, 0.0}});
  request.friction_patches = {IceAcross(12.0, 60.0)};
  request.infeasible = InfeasiblePolicy::kRefuse;
  const Plan plan = Course(request, {{.length = 60.0, .curvature = 0.0}});
  EXPECT_EQ(plan.status, PlanStatus::kInfeasible);
  // The front axle reaches the ice at s = 12 - 2.7 = 9.3 m. The planner checks the path at least
  // every 0.1 m.
  const double station = std::stod(plan.reason.substr(plan.reason.rfind("s = ") + 4));
  EXPECT_GE(station, 9.3);
  EXPECT_LE(station, 60.0);
}

/// Returns the smaller of the friction factors under the two axles of a car on the x axis. If
/// patches overlap, the last patch in the list applies.
double FrictionAt(const PlanRequest& request, double s) {
  double smallest = 1.0;
  for (const double axle : {s, s + request.vehicle.wheelbase}) {
    double friction = 1.0;
    for (const FrictionPatch& patch : request.friction_patches) {
      const bool is_on = std::abs(axle - patch.area.center.x) <= 0.5 * patch.area.length;
      friction = is_on ? patch.friction : friction;
    }
    smallest = std::min(smallest, friction);
  }
  return smallest;
}

TEST(Feasibility, BrakesWithinTheGripOfRandomRoadsWithIce) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    PlanRequest request = Request(2.0 + 8.0 * unit(random), {{0.0, 0.0}});
    request.start_speed = 0.0;  // A car that starts from rest can drive slowly enough for any ice.
    for (int k = 0; k < 3; ++k) {
      FrictionPatch patch = IceAcross(200.0 * unit(random), 1.0 + 40.0 * unit(random));
      patch.friction = 0.04 + 0.4 * unit(random);
      request.friction_patches.push_back(patch);
    }
    const double grade = 0.03 * (unit(random) - 0.5);
    request.ground.grade = {grade, 0.0};
    const Plan plan = Course(request, {{.length = 200.0, .curvature = 0.0}});
    ASSERT_TRUE(plan.ok()) << i << ": " << plan.reason;
    for (double s = 0.05; s < 200.0; s += 0.1) {
      const double load = 1.0 / std::hypot(1.0, grade);
      const double grip = 0.9 * 9.81 * FrictionAt(request, s) * load;
      const double change = plan.reference.speed.AccelerationAt(s);
      // Gravity reduces the available grip when the car brakes downhill or accelerates uphill.
      const double pull = 9.81 * load * std::max(0.0, change < 0.0 ? -grade : grade);
      ASSERT_LE(std::abs(change), grip - pull + Tolerance(1e-9)) << i << " at " << s;
    }
  }
}

// Only MakeFeasible can make a FeasiblePlan, and a FeasiblePlan is constant.
static_assert(!std::is_constructible_v<FeasiblePlan, Plan>);
static_assert(!std::is_convertible_v<Plan, FeasiblePlan>);
static_assert(std::is_same_v<decltype(*std::declval<FeasiblePlan&>()), const Plan&>);

TEST(Feasibility, TakesTheSlopeOffWhatTheRoadHolds) {
  // The grip is mu g = 0.9 x 0.15 x 9.81 = 1.32 m/s^2, less than the mission's 1.5 m/s^2. Downhill,
  // the slope reduces the load and g sin(theta) is subtracted: 1.32 x 0.9988 - 9.81 x 0.0499 =
  // 0.833 m/s^2.
  PlanRequest request = Request(3.0, {{0.0, 0.0}});
  request.friction = 0.15;
  const std::vector<CoursePiece> straight{{.length = 60.0, .curvature = 0.0}};
  const auto hardest = [&](double grade) {
    request.ground.grade = {grade, 0.0};
    const Plan plan = Course(request, straight);
    EXPECT_TRUE(plan.ok()) << plan.reason;
    return -plan.reference.speed.AccelerationAt(plan.reference.path.length() - 1e-6);
  };
  EXPECT_NEAR(hardest(0.0), 0.999 * 1.3244, Tolerance(1e-3));
  EXPECT_NEAR(hardest(-0.05), 0.999 * 0.8333, Tolerance(1e-3));
  // Uphill, gravity helps to brake. The planner does not use this help, but reduces the grip by the
  // smaller load.
  EXPECT_NEAR(hardest(0.05), 0.999 * 1.3227, Tolerance(1e-3));
}

TEST(Feasibility, RefusesASlopeThatTheRoadDoesNotHold) {
  PlanRequest request = Request(3.0, {{0.0, 0.0}});
  request.friction = 0.1;               // The tyres hold 0.88 m/s^2.
  request.ground.grade = {-0.15, 0.0};  // The pull of gravity is 1.46 m/s^2.
  const Plan plan = Course(request, {{.length = 60.0, .curvature = 0.0}});
  EXPECT_EQ(plan.status, PlanStatus::kInfeasible);
  EXPECT_NE(plan.reason.find("pull of gravity 1.46 m/s^2"), std::string::npos) << plan.reason;
  request.ground.grade = {0.0, 0.15};  // The road slopes across the driving direction.
  EXPECT_EQ(Course(request, {{.length = 60.0, .curvature = 0.0}}).status, PlanStatus::kInfeasible);
}

TEST(Feasibility, NamesTheFrictionThatASlopeNeeds) {
  const std::string remedy = "or that of the friction patch, to at least ";
  for (const Vec2& grade : {Vec2(-0.15, 0.0), Vec2(0.15, 0.0), Vec2(0.0, 0.15), Vec2(0.1, 0.1)}) {
    PlanRequest request = Request(3.0, {{0.0, 0.0}});
    request.friction = 0.1;
    request.ground.grade = {grade.x(), grade.y()};
    const std::vector<CoursePiece> straight{{.length = 60.0, .curvature = 0.0}};
    const std::string reason = Course(request, straight).reason;
    const std::size_t at = reason.find(remedy);
    ASSERT_NE(at, std::string::npos) << reason;
    request.friction = std::stod(reason.substr(at + remedy.size()));
    EXPECT_EQ(Course(request, straight).status, PlanStatus::kOk) << reason;
  }
  // On the downhill road of 60 m, only the front axle reaches the ice.
  PlanRequest request = Request(3.0, {{0.0, 0.0}});
  request.ground.grade = {-0.09, 0.0};
  request.friction_patches = {IceAcross(61.0, 9.0)};
  const std::vector<CoursePiece> straight{{.length = 60.0, .curvature = 0.0}};
  const std::string reason = Course(request, straight).reason;
  EXPECT_NE(reason.find("friction factor of 0.05 there"), std::string::npos) << reason;
  const std::size_t at = reason.find(remedy);
  ASSERT_NE(at, std::string::npos) << reason;
  request.friction_patches[0].friction = std::stod(reason.substr(at + remedy.size()));
  EXPECT_EQ(Course(request, straight).status, PlanStatus::kOk) << reason;
}

TEST(Feasibility, SlowsDownMoreWhereTheRoadFallsToTheOutside) {
  PlanRequest request = Request(18.0, {{0.0, 0.0}});
  // At the end of the arc, the car does not brake yet.
  const std::vector<CoursePiece> bend{{.length = 200.0, .curvature = 0.0},
                                      {.length = 60.0, .curvature_to = 0.05},
                                      {.length = 90.0, .curvature = 0.05}};
  const auto slowest = [&](double grade) {
    request.ground.grade = {grade, 0.0};
    const Plan plan = Course(request, bend);
    EXPECT_TRUE(plan.ok()) << plan.reason;
    return plan.reference.speed.SpeedAt(260.5);
  };
  // In the arc of the left bend, the car heads along y, so a road that falls along x falls to the
  // outside of the bend. Before the arc, the car brakes with 1.5 m/s^2, and the fall along its
  // heading of 1.5 rad pulls with 9.81 x 0.0995 x cos(1.5) = 0.07 m/s^2. The speed is therefore v^2
  // = 20 m (sqrt((8.83 x 0.995)^2 - 1.57^2) - 0.974) m/s^2. On the flat road, v^2 = 20 m x
  // sqrt(8.83^2 - 1.5^2) m/s^2.
  EXPECT_NEAR(slowest(-0.1), 12.386, 0.01);
  EXPECT_NEAR(slowest(0.0), 13.191, 0.01);
  EXPECT_NEAR(slowest(0.1), slowest(0.0), 0.05);  // The planner does not use a bank that helps.
}

// In random missions for every waypoint planner, a successful plan must start at the pose, the
// speed and the steering angle of the car.
TEST(Feasibility, EveryPlanThatIsOkBeginsAsTheCarDoes) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int planned = 0;
  for (const PlannerEntry& planner : Planners()) {
    if (planner.min_waypoints == 0) {
      continue;
    }
    for (int i = 0; i < 25; ++i) {
      PlanRequest request = Request(1.0 + 3.0 * std::abs(unit(random)),
                                    {{0.0, 0.0},
                                     {20.0 + 15.0 * unit(random), 20.0 * unit(random)},
                                     {45.0 + 10.0 * unit(random), 30.0 * unit(random)}});
      request.start.yaw += i % 2 == 0 ? 0.0 : kPi * unit(random);
      request.start_speed = i % 3 == 0 ? 0.0 : request.speed.speed;
      request.start_steering = i % 5 == 0 ? 0.2 * unit(random) : 0.0;
      if (planner.has_headings) {
        request.headings = {request.start.yaw, kPi * unit(random), kPi * unit(random)};
      }
      const Plan plan = MakePlan(request, planner.defaults);
      if (!plan.ok()) {
        EXPECT_FALSE(plan.reason.empty());
        continue;
      }
      ++planned;
      SCOPED_TRACE(std::string(planner.name) + " " + std::to_string(i));
      const PathPoint first = plan.reference.path.At(0.0);
      EXPECT_LE((first.pose.position() - request.start.position()).norm(), 1e-3);
      EXPECT_LE(std::abs(AngleDifference(first.pose.yaw, request.start.yaw)), 1e-3);
      EXPECT_NEAR(plan.reference.speed.SpeedAt(0.0), request.start_speed, Tolerance(1e-9));
      if (request.start_speed > 0.0) {
        EXPECT_NEAR(std::atan(2.7 * first.curvature), request.start_steering, 0.01);
      }
      EXPECT_TRUE(Kinds(plan, request).empty()) << Kinds(plan, request).front();
    }
  }
  EXPECT_GT(planned, 60);  // The planners do not reject all missions.
}

}  // namespace
}  // namespace trackbed
