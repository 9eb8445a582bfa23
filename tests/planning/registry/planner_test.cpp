
#include "trackbed/planning/common/planner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "tests/planning/print_planner.h"
#include "tests/planning/routes.h"
#include "tests/support/waypoint_planners.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/course/course.h"
#include "trackbed/planning/curves/curve_planners.h"
#include "trackbed/planning/fillet/fillet.h"
#include "trackbed/planning/fillet/fillet_planner.h"
#include "trackbed/planning/path_file/path_file_planner.h"
#include "trackbed/planning/registry/planners.h"

// Tests the guarantees of every registered planner, and properties of the fillet planner.
namespace trackbed {
namespace {

using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

PlanRequest Request(std::vector<Vec2> waypoints) {
  PlanRequest request;
  request.vehicle = ReferenceCar();
  request.waypoints = std::move(waypoints);
  const Vec2 leg = request.waypoints[1] - request.waypoints[0];
  request.start = {request.waypoints[0].x(), request.waypoints[0].y(),
                   std::atan2(leg.y(), leg.x())};
  request.start_speed = 0.0;
  request.speed = {.speed = 3.0, .acceleration = 1.0, .deceleration = 1.5};
  return request;
}

// --- Guarantees of every registered planner ------------------------------------------------------

/// Returns a path of continuous curvature from `start`, in the form that FitPath returns.
std::shared_ptr<const FittedPath> FittedFrom(const Pose2& start) {
  FittedPath fitted;
  fitted.path = Path(start, {{.length = 10.0},
                             {.length = 5.0, .sharpness = 0.01},
                             {.length = 12.0, .curvature = 0.05},
                             {.length = 8.0, .curvature = 0.05, .sharpness = -0.00625}});
  for (const PathPoint& point : fitted.path.Sample(0.5)) {
    fitted.given.points.push_back(point.pose.position());
    fitted.stations.push_back(point.s);
  }
  return std::make_shared<const FittedPath>(std::move(fitted));
}

/// Returns the default options, with a course or a path for the planners that require one.
PlannerOptions DefaultOptions(const PlannerEntry& entry, const PlanRequest& request) {
  PlannerOptions options = entry.defaults;
  if (auto* path = options.GetIf<PathFileOptions>()) {
    path->path = FittedFrom(std::isfinite(request.start.yaw) ? request.start : Pose2{});
  }
  if (auto* course = options.GetIf<CourseOptions>()) {
    course->segments = {{.length = 10.0, .curvature = 0.0},
                        {.length = 5.0, .curvature_to = 0.05},
                        {.length = 12.0, .curvature = 0.05},
                        {.length = 8.0, .curvature = -0.1}};
  }
  return options;
}

Plan PlanWithDefaults(const PlanRequest& request, const PlannerEntry& entry) {
  return MakePlan(request, DefaultOptions(entry, request));
}

class EveryPlanner : public ::testing::TestWithParam<PlannerEntry> {};

TEST_P(EveryPlanner, IsNamedByItsOptions) {
  EXPECT_STREQ(PlannerFor(GetParam().defaults).name, GetParam().name);
  EXPECT_FALSE(std::string(GetParam().summary).empty());
}

TEST_P(EveryPlanner, NeedsItsFewestWaypointsAndNoMore) {
  const std::size_t fewest = GetParam().min_waypoints;
  std::vector<Vec2> route = RouteA();
  ASSERT_GE(route.size(), fewest);
  route.resize(fewest);
  PlanRequest request = Request(RouteA());
  request.waypoints = route;
  EXPECT_TRUE(PlanWithDefaults(request, GetParam()).ok());
  if (fewest > 0) {
    request.waypoints.pop_back();
    EXPECT_EQ(PlanWithDefaults(request, GetParam()).status, PlanStatus::kTooFewWaypoints);
  }
}

TEST_P(EveryPlanner, StartsWhereTheCarIsAndEndsAtGoal) {
  const Plan plan = PlanWithDefaults(Request(RouteA()), GetParam());
  ASSERT_TRUE(plan.ok()) << plan.reason;
  EXPECT_EQ(plan.reason, "");
  const Path& path = plan.reference.path;
  // Planners guarantee an accuracy of 1e-9 m.
  EXPECT_NEAR((path.At(0.0).pose.position() - RouteA().front()).norm(), 0.0, Tolerance(1e-9));
  const Vec2 end = path.At(path.length()).pose.position();
  EXPECT_NEAR((end - plan.goal.position()).norm(), 0.0, Tolerance(1e-9));
  if (GetParam().min_waypoints > 0) {
    EXPECT_NEAR((end - RouteA().back()).norm(), 0.0, Tolerance(1e-9));
  }
}

TEST_P(EveryPlanner, StaysWithinTheCarsSteering) {
  const Plan plan = PlanWithDefaults(Request(RouteA()), GetParam());
  ASSERT_TRUE(plan.ok()) << plan.reason;
  for (const Segment& segment : plan.reference.path.segments()) {
    for (const double d : {0.0, segment.length}) {
      EXPECT_LE(std::abs(SteeringForCurvature(ReferenceCar(), segment.CurvatureAt(d))),
                ReferenceCar().steering_limit + Tolerance(1e-12));
    }
    EXPECT_TRUE(segment.direction > 0 || GetParam().goes_backwards);
  }
  for (const SteeringSchedule::Knot& knot : plan.schedule.knots()) {
    EXPECT_LE(std::abs(knot.steering), ReferenceCar().steering_limit);
  }
}

TEST_P(EveryPlanner, StopsAtTheEndOfItsPath) {
  PlanRequest request = Request(RouteA());
  request.start_speed = 1.25;
  const Plan plan = PlanWithDefaults(request, GetParam());
  ASSERT_TRUE(plan.ok()) << plan.reason;
  const auto& knots = plan.reference.speed.knots();
  ASSERT_GE(knots.size(), 2U);
  EXPECT_EQ(knots.front().s, 0.0);
  EXPECT_EQ(knots.front().speed, 1.25);
  EXPECT_EQ(knots.back().s, plan.reference.path.length());
  EXPECT_EQ(knots.back().speed, 0.0);
  for (const SpeedProfile::Knot& knot : knots) {
    EXPECT_LE(knot.speed, request.speed.speed);
  }
}

TEST_P(EveryPlanner, IsAFunctionOfItsRequest) {
  const Plan a = PlanWithDefaults(Request(RouteB()), GetParam());
  const Plan b = PlanWithDefaults(Request(RouteB()), GetParam());
  EXPECT_EQ(DiagnosticsJson(a), DiagnosticsJson(b));
  EXPECT_EQ(a.reference.path.segments(), b.reference.path.segments());
  EXPECT_EQ(a.caps.size(), b.caps.size());
}

TEST_P(EveryPlanner, IsAsLongAsItsSteps) {
  for (const std::vector<Vec2>& route : {RouteA(), RouteB()}) {
    const Plan plan = PlanWithDefaults(Request(route), GetParam());
    ASSERT_TRUE(plan.ok()) << plan.reason;
    const Path& path = plan.reference.path;
    constexpr double kStep = 0.01;  // [m]
    const auto steps = static_cast<int>(std::ceil(path.length() / kStep));
    const double step = path.length() / steps;
    double length = 0.0;
    for (int i = 1; i <= steps; ++i) {
      const PathPoint a = path.At(step * (i - 1));
      const PathPoint b = path.At(step * i);
      length += (b.pose.position() - a.pose.position()).norm();
      // Over each step, the heading changes by at most the step divided by the smallest turning
      // radius.
      const double turn = std::abs(AngleDifference(b.pose.yaw, a.pose.yaw));
      ASSERT_LE(turn, step / ReferenceCar().min_turning_radius() + Tolerance(1e-9)) << "at " << b.s;
    }
    // A chord is shorter than its arc by the fraction kappa^2 step^2/24 = 1.6e-7, over a length of
    // at most 160 m. At a cusp, the path folds back within one step.
    const double cusps = static_cast<double>(SplitIntoLegs(path).size() - 1);
    EXPECT_NEAR(length, path.length(), Tolerance(1.6e-7 * 160.0) + cusps * step);
  }
}

TEST_P(EveryPlanner, PlansWithEverySeed) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    PlanRequest request = Request(RouteB());
    request.seed = seed;
    const Plan plan = PlanWithDefaults(request, GetParam());
    ASSERT_TRUE(plan.ok()) << plan.reason;
    const Path& path = plan.reference.path;
    EXPECT_NEAR((path.At(path.length()).pose.position() - plan.goal.position()).norm(), 0.0,
                Tolerance(1e-9));
    if (!GetParam().is_random) {
      request.seed = 0;
      EXPECT_EQ(PlanWithDefaults(request, GetParam()).reference.path.segments(), path.segments());
    }
  }
}

TEST_P(EveryPlanner, IsMovedWithItsMission) {
  const Pose2 by{-200.0, 77.0, 2.1};
  PlanRequest moved = Request(RouteB());
  for (Vec2& waypoint : moved.waypoints) {
    waypoint = ToWorld(by, waypoint);
  }
  moved.start = Compose(by, moved.start);
  const Plan here = PlanWithDefaults(Request(RouteB()), GetParam());
  const Plan there = PlanWithDefaults(moved, GetParam());
  ASSERT_TRUE(here.ok() && there.ok()) << there.reason;
  const Path& path = here.reference.path;
  // The tolerance allows for rounding of coordinates of about 250 m, which a search amplifies.
  ASSERT_NEAR(there.reference.path.length(), path.length(), Tolerance(1e-6));
  for (double s = 0.0; s < path.length(); s += 1.0) {
    const Vec2 expected = ToWorld(by, path.At(s).pose.position());
    ASSERT_NEAR((there.reference.path.At(s).pose.position() - expected).norm(), 0.0,
                Tolerance(1e-6));
    ASSERT_NEAR(there.reference.speed.SpeedAt(s), here.reference.speed.SpeedAt(s), Tolerance(1e-4));
  }
}

TEST_P(EveryPlanner, IsNeverFasterThanTheMissionAndEndsAtRest) {
  for (const double speed : {0.7, 2.0, 5.0}) {
    PlanRequest request = Request(RouteA());
    request.speed.speed = speed;
    const Plan plan = PlanWithDefaults(request, GetParam());
    ASSERT_TRUE(plan.ok()) << plan.reason;
    const double length = plan.reference.path.length();
    for (double s = 0.0; s <= length; s += 0.1) {
      ASSERT_LE(plan.reference.speed.SpeedAt(s), speed + Tolerance(1e-12));
      ASSERT_GE(plan.reference.speed.SpeedAt(s), 0.0);
    }
    EXPECT_EQ(plan.reference.speed.SpeedAt(length), 0.0);
  }
}

TEST_P(EveryPlanner, RefusesWithAReasonAndNoPath) {
  PlanRequest request = Request(RouteA());
  const Plan usual = PlanWithDefaults(request, GetParam());
  const std::vector<Segment>& segments = usual.reference.path.segments();
  if (std::all_of(segments.begin(), segments.end(), [](const Segment& segment) {
        return segment.curvature == 0.0 && segment.sharpness == 0.0;
      })) {
    GTEST_SKIP() << "a straight line needs no steering";
  }
  if (GetParam().has_headings) {
    request.obstacles.push_back({{40.0, 40.0, 0.0}, 1.0, 1.0});  // an obstacle on a waypoint
  } else {
    request.vehicle.steering_limit = 1e-3;  // a turning radius of 2.7 km
  }
  const Plan plan = PlanWithDefaults(request, GetParam());
  EXPECT_FALSE(plan.ok());
  EXPECT_NE(plan.reason, "");
  EXPECT_EQ(plan.reference.path.length(), 0.0);
  EXPECT_TRUE(plan.reference.speed.knots().empty());
  EXPECT_TRUE(plan.schedule.knots().empty());
}

TEST_P(EveryPlanner, ThrowsForNumbersThatAreNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity}) {
    SCOPED_TRACE(bad);
    PlanRequest waypoint = Request(RouteA());
    waypoint.waypoints[2].y() = bad;
    EXPECT_THROW(PlanWithDefaults(waypoint, GetParam()), InternalError);
    PlanRequest start = Request(RouteA());
    start.start.yaw = bad;
    EXPECT_THROW(PlanWithDefaults(start, GetParam()), InternalError) << "start";
    PlanRequest start_speed = Request(RouteA());
    start_speed.start_speed = bad;
    EXPECT_THROW(PlanWithDefaults(start_speed, GetParam()), InternalError) << "start speed";
    PlanRequest speed = Request(RouteA());
    speed.speed.speed = bad;
    EXPECT_THROW(PlanWithDefaults(speed, GetParam()), InternalError) << "speed";
    PlanRequest acceleration = Request(RouteA());
    acceleration.speed.acceleration = bad;
    EXPECT_THROW(PlanWithDefaults(acceleration, GetParam()), InternalError) << "acceleration";
    PlanRequest deceleration = Request(RouteA());
    deceleration.speed.deceleration = bad;
    EXPECT_THROW(PlanWithDefaults(deceleration, GetParam()), InternalError) << "deceleration";
  }
}

INSTANTIATE_TEST_SUITE_P(Table, EveryPlanner, ::testing::ValuesIn(WaypointPlanners()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(Planners, HaveNamesAndOptionsOfTheirOwn) {
  const std::vector<PlannerEntry>& all = Planners();
  ASSERT_GE(all.size(), 8U);
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_STRNE(all[i].name, all[j].name);
      EXPECT_FALSE(AreOfOneMethod(all[i].defaults, all[j].defaults)) << all[i].name;
    }
  }
}

TEST(Planners, KeepTheDistanceThatTheirOptionsName) {
  EXPECT_EQ(PlannerSafeDistance(DubinsOptions{.safe_distance = 0.7}), 0.7);
  EXPECT_FALSE(PlannerSafeDistance(CourseOptions{}).has_value());
}

// --- The fillet planner
// ---------------------------------------------------------------------------

TEST(FilletPlanner, FindingsAreThoseOfTheFillets) {
  const FilletPlan fillets = PlanFillets(ReferenceCar(), RouteB(), 3.0, {});
  const Plan plan = MakePlan(Request(RouteB()), FilletOptions{});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  const auto turns = DiagnosticsJson(plan).at("turns");
  ASSERT_EQ(turns.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& json = turns[k];
    const FilletTurn& turn = fillets.turns[k];
    EXPECT_EQ(json.at("waypoint"), turn.waypoint);
    EXPECT_EQ(json.at("heading_change_rad"), turn.heading_change);
    EXPECT_EQ(json.at("interior_angle_rad"), turn.interior_angle);
    EXPECT_EQ(json.at("radius_m"), turn.radius);
    EXPECT_EQ(json.at("center_m"), nlohmann::json::array({turn.center.x(), turn.center.y()}));
    EXPECT_EQ(json.at("arc_start_m"),
              nlohmann::json::array({turn.arc_start.x(), turn.arc_start.y()}));
    EXPECT_EQ(json.at("arc_end_m"), nlohmann::json::array({turn.arc_end.x(), turn.arc_end.y()}));
    EXPECT_EQ(json.at("arc_start_s_m"), turn.arc_start_s);
    EXPECT_EQ(json.at("arc_length_m"), turn.arc_length);
    EXPECT_EQ(json.at("tangent_length_m"), turn.tangent_length);
    EXPECT_EQ(json.at("steering_rad"), turn.steering);
    EXPECT_EQ(json.at("ramp_time_s"), turn.ramp_time);
    EXPECT_EQ(json.at("ramp_distance_m"), turn.ramp_distance);
    EXPECT_EQ(json.at("steer_start_m"), turn.steer_start);
    EXPECT_EQ(json.at("steer_return_m"), turn.steer_return);
    EXPECT_EQ(json.at("ramp_truncated"), turn.ramp_truncated);
    std::set<std::string> keys;
    for (const auto& [key, value] : json.items()) {
      keys.insert(key);
    }
    EXPECT_THAT(keys, UnorderedElementsAre("waypoint", "heading_change_rad", "interior_angle_rad",
                                           "radius_m", "speed_mps", "active_constraint",
                                           "predicted", "center_m", "arc_start_m", "arc_end_m",
                                           "arc_start_s_m", "arc_length_m", "tangent_length_m",
                                           "steering_rad", "ramp_time_s", "ramp_distance_m",
                                           "steer_start_m", "steer_return_m", "ramp_truncated"));
  }
}

TEST(FilletPlanner, SaysWhatHoldsTheRadius) {
  const auto active = [](const std::vector<Vec2>& route, const FilletOptions& options) {
    const Plan plan = MakePlan(Request(route), options);
    return plan.ok() ? DiagnosticsJson(plan)["turns"][0]["active_constraint"].get<std::string>()
                     : plan.reason;
  };
  EXPECT_EQ(active(RouteA(), {}), "steering_room");
  EXPECT_EQ(active(RouteA(), {.radius = std::nullopt, .constraint = RadiusConstraint::kHalfLeg}),
            "half_leg");
  EXPECT_EQ(active(RouteA(), {.radius = 10.0, .constraint = RadiusConstraint::kNone}), "given");
  FilletOptions capped;
  capped.max_radius = 12.0;
  EXPECT_EQ(active(RouteA(), capped), "max_radius");
}

TEST(FilletPlanner, NamesTheWaypointOfARefusal) {
  FilletOptions options;
  options.without_room = InfeasibleTurnPolicy::kRefuse;
  const Plan plan = MakePlan(Request({{0, 0}, {60, 0}, {60, 60}, {88, 60}}), options);
  EXPECT_EQ(plan.status, PlanStatus::kNoRoomForSteering);
  EXPECT_EQ(DiagnosticsJson(plan).at("waypoint"), 2);
  EXPECT_THAT(plan.reason, HasSubstr("waypoint 2"));
}

}  // namespace
}  // namespace trackbed
