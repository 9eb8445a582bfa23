#include "trackbed/planning/path_file/path_file_planner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/planning/registry/planners.h"

namespace trackbed {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

PathFileOptions Options(std::vector<Vec2> points, const PathFitOptions& fit = {}) {
  PathPoints given;
  given.points = std::move(points);
  PathFileOptions options;
  options.fit = fit;
  options.path = std::make_shared<const FittedPath>(FitPath(std::move(given), fit));
  return options;
}

PathFileOptions Bend(const PathFitOptions& fit = {}) {
  std::vector<Vec2> points;
  for (double x = 0.0; x <= 80.0; x += 1.0) {
    points.emplace_back(x, 10.0 * (1.0 - std::cos(0.03 * x)));
  }
  return Options(points, fit);
}

PlanRequest RequestAlong(const PathFileOptions& options) {
  PlanRequest request;
  request.vehicle = ReferenceCar();
  const PathPoint start = options.path->path.At(0.0);
  request.start = start.pose;
  request.start_speed = 3.0;
  request.start_steering = SteeringForCurvature(request.vehicle, start.curvature);
  request.speed = {.speed = 3.0, .acceleration = 1.0, .deceleration = 1.5};
  return request;
}

TEST(PathFilePlanner, FollowsThePathAsItIs) {
  const PathFileOptions options = Bend();
  const Plan plan = MakePlan(RequestAlong(options), options);
  ASSERT_TRUE(plan.ok()) << plan.reason;
  EXPECT_EQ(plan.reference.path.segments(), options.path->path.segments());
  EXPECT_THAT(plan.notes, Contains(HasSubstr("spline within 0.0")));
  const nlohmann::json json = DiagnosticsJson(plan);
  EXPECT_EQ(json.at("points"), 81);
  EXPECT_LE(json.at("deviation_m").get<double>(), 0.05);
  // A kinematic car that is steered by the schedule must stay on the path. The simulation uses the
  // method RK4, and the knots of the schedule are 0.1 m apart.
  EXPECT_LE(json.at("open_loop").at("deviation_max_m").get<double>(), 1e-3);
}

TEST(PathFilePlanner, KeepsTheSpeedsOfTheFile) {
  PathPoints given;
  for (int i = 0; i <= 40; ++i) {
    given.points.emplace_back(2.0 * i, 0.0);
    given.speed.push_back(i < 20 ? 2.0 : 1.0);
  }
  PathFileOptions options;
  options.path = std::make_shared<const FittedPath>(FitPath(given, {}));
  PlanRequest request = RequestAlong(options);
  request.start_speed = 2.0;
  EXPECT_EQ(MakePlan(request, options)->reference.speed.SpeedAt(30.0), 3.0);
  options.speeds = PathSpeeds::kFile;
  const Plan plan = MakePlan(request, options);
  ASSERT_TRUE(plan.ok()) << plan.reason;
  EXPECT_NEAR(plan.reference.speed.SpeedAt(30.0), 2.0, Tolerance(1e-9));
  EXPECT_NEAR(plan.reference.speed.SpeedAt(60.0), 1.0, Tolerance(1e-9));
  for (double s = 0.0; s < 80.0; s += 0.5) {
    EXPECT_LE(plan.reference.speed.SpeedAt(s), s < 38.0 ? 2.0 : s < 40.0 ? 1.5 : 1.0 + 1e-9) << s;
  }
}

// The file has eleven of twelve points on a circle. The speeds also apply between the last point
// and the first point.
TEST(PathFilePlanner, KeepsTheSpeedsOfTheFileAllAround) {
  PathPoints given;
  for (int i = 0; i < 11; ++i) {
    const double angle = 2.0 * std::numbers::pi / 12.0 * i;
    given.points.emplace_back(30.0 * std::sin(angle), 30.0 * (1.0 - std::cos(angle)));
    given.speed.push_back(2.0);
  }
  PathFileOptions options;
  options.fit.closed = true;
  options.speeds = PathSpeeds::kFile;
  options.path = std::make_shared<const FittedPath>(FitPath(given, options.fit));
  PlanRequest request = RequestAlong(options);
  request.start_speed = 2.0;
  const Plan plan = MakePlan(request, options);
  ASSERT_TRUE(plan.ok()) << plan.reason;
  for (const SpeedProfile::Knot& knot : plan.reference.speed.knots()) {
    EXPECT_LE(knot.speed, 2.0 + Tolerance(1e-9)) << knot.s;
  }
}

// The file has points 0.1 to 3 m apart with random speeds, and the car has any start speed. Braking
// at the mission's deceleration is always sufficient, because the path is long enough to stop.
TEST(PathFilePlanner, SlowsDownToTheSpeedsOfTheFileFromAnyStart) {
  Random random(5);
  for (int i = 0; i < 300; ++i) {
    PathPoints given;
    for (double x = 0.0; x < 60.0; x += random.Uniform(0.1, 3.0)) {
      given.points.emplace_back(x, 0.0);
      given.speed.push_back(random.Uniform(0.2, 8.0));
    }
    PathFileOptions options;
    options.speeds = PathSpeeds::kFile;
    options.path = std::make_shared<const FittedPath>(FitPath(given, options.fit));
    PlanRequest request = RequestAlong(options);
    request.start_speed = i % 2 == 0 ? given.speed.front() : random.Uniform(0.0, 10.0);
    request.speed.speed = random.Uniform(1.0, 8.0);
    const Plan plan = MakePlan(request, options);
    ASSERT_TRUE(plan.ok()) << i << ": " << plan.reason;
    EXPECT_EQ(plan.reference.speed.SpeedAt(0.0), request.start_speed);
    for (std::size_t k = 0; k + 1 < given.points.size(); ++k) {
      const double s = 0.5 * (options.path->stations[k] + options.path->stations[k + 1]);
      const double cap = std::min(request.speed.speed, 0.5 * (given.speed[k] + given.speed[k + 1]));
      const double braked = request.start_speed * request.start_speed - 2.0 * 1.5 * s;
      EXPECT_LE(plan.reference.speed.SpeedAt(s),
                std::sqrt(std::max(cap * cap, braked)) + Tolerance(1e-6))
          << i << ", " << s;
    }
  }
}

TEST(PathFilePlanner, StopsWhereTheSpeedInTheFileIsZero) {
  PathPoints given;
  for (int i = 0; i <= 40; ++i) {
    given.points.emplace_back(1.0 * i, 0.0);
    given.speed.push_back(i == 0 || i == 15 || i == 40 ? 0.0 : 3.0);
  }
  PathFileOptions options;
  options.speeds = PathSpeeds::kFile;
  options.path = std::make_shared<const FittedPath>(FitPath(given, {}));
  PlanRequest request = RequestAlong(options);
  request.start_speed = 0.0;
  const Plan plan = MakePlan(request, options);
  ASSERT_TRUE(plan.ok()) << plan.reason;
  ASSERT_EQ(plan.stops.size(), 1U);
  EXPECT_EQ(plan.stops[0], options.path->stations[15]);
  EXPECT_EQ(plan.reference.speed.SpeedAt(plan.stops[0]), 0.0);
  EXPECT_GT(plan.reference.speed.SpeedAt(10.0), 1.0);
  EXPECT_THAT(plan.notes, Contains(HasSubstr("stops where the file's speed is 0: s = 1")));
  options.speeds = PathSpeeds::kMission;
  EXPECT_TRUE(MakePlan(request, options)->stops.empty());
}

TEST(PathFilePlanner, RefusesHeadingJumpsUnlessAllowed) {
  const PathFileOptions options =
      Options({{0.0, 0.0}, {20.0, 0.0}, {40.0, 10.0}}, {.fit = PathFit::kPolyline});
  PlanRequest request = RequestAlong(options);
  const Plan refused = MakePlan(request, options);
  EXPECT_EQ(refused.status, PlanStatus::kTurnTooTight);
  EXPECT_THAT(refused.reason, HasSubstr("by up to 0.464 rad at s = 20 m, (20, 0)"));
  request.infeasible = InfeasiblePolicy::kAllow;
  EXPECT_TRUE(MakePlan(request, options).ok());
}

TEST(PathFilePlanner, SaysWhyThereIsNoPath) {
  EXPECT_EQ(MakePlan(RequestAlong(Bend()), PathFileOptions{})->status, PlanStatus::kNoPath);
  const PathFileOptions back = Options({{0.0, 0.0}, {5.0, 0.0}, {1.0, 0.0}});
  const Plan plan = MakePlan(RequestAlong(back), back);
  EXPECT_EQ(plan.status, PlanStatus::kUTurn);
  EXPECT_THAT(plan.reason, HasSubstr("(5, 0)"));
  // A step back of 4 m on a path of 9 m is too large to be noise.
  EXPECT_THAT(plan.reason, testing::Not(HasSubstr("noise")));
}

TEST(PathFilePlanner, NamesTheDeviationThatTakesJitter) {
  std::vector<Vec2> points;
  for (int i = 0; i <= 40; ++i) {
    points.emplace_back(0.5 * i, 0.0);
    if (i == 20) {
      points.emplace_back(9.99, 0.001);
      points.emplace_back(10.005, -0.001);
    }
  }
  const PathFileOptions tight = Options(points, {.max_deviation = 1e-3});
  const Plan refused = MakePlan(RequestAlong(Bend()), tight);
  EXPECT_EQ(refused.status, PlanStatus::kUTurn);
  EXPECT_THAT(
      refused.reason,
      HasSubstr("if this is noise of the positions, use fit: spline with max_deviation: 0.05"));
  EXPECT_LT(*tight.path->noise_deviation, 0.05);
  const PathFileOptions wide = Options(points, {.max_deviation = 0.05});
  const Plan plan = MakePlan(RequestAlong(wide), wide);
  ASSERT_TRUE(plan.ok()) << plan.reason;
  EXPECT_THAT(plan.notes, Contains(HasSubstr("points merged whose steps turn back")));
}

/// Samples of a three-point turn with speeds of 0 at the cusps.
PathPoints ThreePointTurn() {
  const Path path({0.0, 0.0, 0.0}, {{.length = 4.0, .curvature = 0.12},
                                    {.length = 3.0, .curvature = -0.12, .direction = -1},
                                    {.length = 5.0, .curvature = 0.1}});
  PathPoints given;
  for (const Stations& leg : SplitIntoLegs(path)) {
    const int direction = path.At(0.5 * (leg.from + leg.to)).direction;
    for (int i = leg.from == 0.0 ? 0 : 1; i <= 12; ++i) {
      given.points.push_back(path.At(std::lerp(leg.from, leg.to, i / 12.0)).pose.position());
      given.direction.push_back(direction);
      given.speed.push_back(i == 12 ? 0.0 : 1.0);
    }
  }
  return given;
}

// A kinematic car steered by the schedule stays on the path (RK4 over knots 0.1 m apart).
TEST(PathFilePlanner, NamesTheDeviationThatTakesNoise) {
  Random random(47);
  for (const double noise : {0.02, 0.04}) {
    std::vector<Vec2> points;
    for (int i = 0; i <= 300; ++i) {
      points.emplace_back(0.2 * i + noise * random.Uniform(-1.0, 1.0),
                          noise * random.Uniform(-1.0, 1.0));
    }
    const PathFitOptions close{.max_deviation = 0.3 * noise};
    const PathFileOptions options = Options(points, close);
    const Plan plan = MakePlan(RequestAlong(options), options);
    EXPECT_EQ(plan.status, PlanStatus::kInfeasible);
    const std::string remedy = "set plan.max_deviation to at least ";
    const std::size_t at = plan.reason.find(remedy);
    ASSERT_NE(at, std::string::npos) << plan.reason;
    const PathFileOptions smoother =
        Options(points, {.max_deviation = std::stod(plan.reason.substr(at + remedy.size()))});
    const Plan smooth = MakePlan(RequestAlong(smoother), smoother);
    EXPECT_EQ(smooth.reason.find("steering angle"), std::string::npos) << smooth.reason;
  }
}

TEST(PathFilePlanner, DrivesReversePieces) {
  PathFileOptions options;
  options.path = std::make_shared<const FittedPath>(FitPath(ThreePointTurn(), {}));
  PlanRequest request = RequestAlong(options);
  request.start_speed = 0.0;
  for (const PathSpeeds speeds : {PathSpeeds::kMission, PathSpeeds::kFile}) {
    options.speeds = speeds;
    const Plan plan = MakePlan(request, options);
    ASSERT_TRUE(plan.ok()) << plan.reason;
    const nlohmann::json json = DiagnosticsJson(plan);
    EXPECT_LE(json.at("open_loop").at("deviation_max_m").get<double>(), 1e-3);
    EXPECT_EQ(json.at("changes_of_direction"), 2);
    EXPECT_TRUE(plan.stops.empty());
    for (const double cusp : {4.0, 7.0}) {
      // The stations of the cusps have errors of up to 1e-8 m. At this distance d from a stop, the
      // speed is v = sqrt(2 a d).
      EXPECT_NEAR(plan.reference.speed.SpeedAt(cusp), 0.0, Tolerance(1e-3));
    }
    EXPECT_THAT(plan.notes, Contains(HasSubstr("begins forwards, changes its direction at s = 4, "
                                               "7 m")));
  }
}

TEST(PathFilePlanner, SaysHowToGiveTheDirection) {
  PathPoints given = ThreePointTurn();
  given.direction.clear();
  PathFileOptions options;
  options.path = std::make_shared<const FittedPath>(FitPath(given, {}));
  const Plan plan = MakePlan(RequestAlong(Bend()), options);
  EXPECT_EQ(plan.status, PlanStatus::kUTurn);
  EXPECT_THAT(plan.reason, HasSubstr("add a column direction of 1 and -1"));
}

/// A line, an arc of the given curvature, and a line, with points 0.4 m apart.
std::vector<Vec2> TurnOf(double curvature, double turn) {
  const Path path({0.0, 0.0, 0.0},
                  {{.length = 15.0, .curvature = 0.0, .direction = 1},
                   {.length = turn / std::abs(curvature), .curvature = curvature, .direction = 1},
                   {.length = 15.0, .curvature = 0.0, .direction = 1}});
  std::vector<Vec2> points;
  for (double s = 0.0; s <= path.length(); s += 0.4) {
    points.push_back(path.At(s).pose.position());
  }
  return points;
}

TEST(PathFilePlanner, PlansTurnsNearFullLock) {
  const VehicleParams car = ReferenceCar();
  const double limit = CurvatureForSteering(car, car.steering_limit);
  for (const double share : {0.98, 0.99, 0.995, -0.985, -0.995}) {
    for (const double turn : {1.0, 1.6, 3.0}) {
      const PathFileOptions options = Options(TurnOf(share * limit, turn));
      PlanRequest request = RequestAlong(options);
      request.infeasible = InfeasiblePolicy::kSlowDown;
      const Plan plan = MakePlan(request, options);
      ASSERT_TRUE(plan.ok()) << share << ", " << turn << ": " << plan.reason;
      for (double s = 0.0; s <= plan.reference.path.length(); s += 0.05) {
        EXPECT_LE(std::abs(plan.reference.path.At(s).curvature), limit) << s;
      }
      EXPECT_LE(DiagnosticsJson(plan).at("deviation_m").get<double>(), 0.05);
    }
  }
  // A turn that is clearly too tight is refused.
  const PathFileOptions tight = Options(TurnOf(1.2 * limit, 1.6));
  EXPECT_FALSE(MakePlan(RequestAlong(tight), tight).ok());
}

TEST(PathFilePlanner, RefusesACarThatStartsElsewhere) {
  const PathFileOptions options = Bend();
  PlanRequest request = RequestAlong(options);
  request.start.x += 1.0;
  EXPECT_THAT(MakePlan(request, options)->reason, HasSubstr("initial position"));
}

}  // namespace
}  // namespace trackbed
