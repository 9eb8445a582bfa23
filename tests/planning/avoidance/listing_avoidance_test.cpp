#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/geometry/random.h"
#include "tests/planning/obstacle_turns.h"
#include "tests/planning/routes.h"
#include "tests/support/obstacle_cases.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/avoidance/turn_maneuver.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/fillet/fillet.h"
#include "trackbed/planning/registry/planners.h"

/// Tests the local planner `listing`, which states each turn of the plan as the problem of the
/// published code listing, and replaces the turn by the curve of the listing.
namespace trackbed {
namespace {

using testing::HasSubstr;

ListingAvoidanceOptions OptionsFor(PassingSideChoice passing_side) {
  ListingAvoidanceOptions options;
  options.inner_width = passing_side == PassingSideChoice::kInner ? 1.0 : 0.0;
  options.outer_width = passing_side == PassingSideChoice::kInner ? 0.0 : 1.0;
  return options;
}

std::vector<Vec2> ReadControlPoints(const nlohmann::json& stretch) {
  std::vector<Vec2> points;
  for (const nlohmann::json& point : stretch["control_points_m"]) {
    points.emplace_back(point[0].get<double>(), point[1].get<double>());
  }
  return points;
}

OrientedBox BoxAt(const Pose2& pose) {
  return {{pose.x, pose.y, 0.0}, 2.0, 2.0};
}

class ListedObstacle : public testing::TestWithParam<ObstacleCase> {};

INSTANTIATE_TEST_SUITE_P(Cases, ListedObstacle, testing::ValuesIn(AllObstacleCases()), CaseName);

TEST_P(ListedObstacle, IsPassedOnTheCurveOfTheListing) {
  const ObstacleCase& c = GetParam();
  const Course course{.turn = c.side * (0.5 * kPi - c.reduction)};
  const OrientedBox box = BoxAt(course.OnArc(c.sixth / 6.0));
  const ListingAvoidanceOptions options = OptionsFor(c.passing_side);
  const Plan plan = Around(course.Global(), {box}, options);
  ASSERT_EQ(plan.blocked, "");

  TurnManeuver problem;  // The default values of TurnManeuver describe the same turn as Course.
  problem.reduction = c.reduction;
  problem.side = c.side > 0.0 ? TurnSide::kLeft : TurnSide::kRight;
  problem.obstacle_sixth = c.sixth;
  problem.inner_width = options.inner_width;
  problem.outer_width = options.outer_width;
  problem.literal = kLiteralTurn;
  const TurnLayout layout = LayOutTurn(problem, ReferenceCar());
  const LiteralTree tree = LiteralRrtStar(problem, layout, 1);
  const auto expected = ControlPoints(problem, layout, ReferenceCar(), tree.final_y);

  ASSERT_EQ(plan.diagnostics.avoided.size(), 1U);
  const nlohmann::json stretch = DiagnosticsJson(plan)["avoid"][0];
  const std::vector<Vec2> points = ReadControlPoints(stretch);
  ASSERT_EQ(points.size(), 8U);
  for (std::size_t k = 0; k < 8; ++k) {
    // The maneuver's frame is 20 m from the start, at the distance S = 22.7 m before the arc. The
    // tolerance allows for rounding of sums of lengths up to 100 m.
    EXPECT_NEAR(points[k].x(), 20.0 + expected[k].x(), Tolerance(1e-9)) << k;
    EXPECT_NEAR(points[k].y(), expected[k].y(), Tolerance(1e-9)) << k;
  }
  EXPECT_NEAR(stretch["leave_s_m"].get<double>(), 20.0, Tolerance(1e-9));
  EXPECT_EQ(stretch["passing_side"],
            c.passing_side == PassingSideChoice::kInner ? "inner" : "outer");
  EXPECT_EQ(stretch["obstacle_sixth"], c.sixth);
  EXPECT_EQ(stretch["rrt_star"]["final_y_m"], tree.final_y);
  ASSERT_EQ(plan.tree.size(), tree.nodes.size());
  EXPECT_NEAR(plan.tree.back().position.x(), 20.0 + tree.nodes.back().position.x(),
              Tolerance(1e-9));
}

TEST(Listing, PassesOnThePrintedPoints) {
  // The expected points are printed in section 5.10, relative to P_0, which is at (20, 0). The
  // height of the control point P_3 depends on the random tree.
  const Course course{.turn = 75.0 * kPi / 180.0};
  const Plan plan = Around(course.Global(), {BoxAt(course.OnArc(0.5))}, ListingAvoidanceOptions{});
  const nlohmann::json stretch = DiagnosticsJson(plan)["avoid"][0];
  const std::vector<Vec2> points = ReadControlPoints(stretch);
  const double final_y = stretch["rrt_star"]["final_y_m"].get<double>();
  const std::array<Vec2, 8> printed{Vec2{0.0, 0.0},         Vec2{7.6266, 0.0},
                                    Vec2{15.2533, 0.0008},  Vec2{22.8799, final_y},
                                    Vec2{28.5834, 12.2608}, Vec2{42.0185, 14.8236},
                                    Vec2{44.9561, 25.7869}, Vec2{47.8937, 36.7501}};
  for (std::size_t k = 0; k < 8; ++k) {
    EXPECT_NEAR(points[k].x(), 20.0 + printed[k].x(), Tolerance(Printed(4))) << k;
    EXPECT_NEAR(points[k].y(), printed[k].y(), Tolerance(Printed(4))) << k;
  }
}

TEST(Listing, IsDrivenHoweverNearItComes) {
  // Section 5.10 uses a safe distance of 1.5 m. With this safe distance, the curves of the listing
  // have a clearance of 0.6 to 1.5 m on the outside of the turn, and of 4 m or more on the inside.
  const Course course{.turn = 75.0 * kPi / 180.0};
  const OrientedBox box = BoxAt(course.OnArc(0.5));
  const Plan outer = Around(course.Global(), {box}, OptionsFor(PassingSideChoice::kOuter));
  const nlohmann::json stretch = DiagnosticsJson(outer)["avoid"][0];
  EXPECT_LT(stretch["clearance_m"].get<double>(), 1.5);
  EXPECT_EQ(stretch["one_point_check"]["passed"], true);
  ASSERT_EQ(outer.notes.size(), 1U);
  EXPECT_THAT(outer.notes[0],
              testing::MatchesRegex("infeasible, kept anyway: the curve past the obstacle at "
                                    "\\(54\\.88, 4\\.133\\): clearance [01]\\.[0-9]* m is below "
                                    "the safe distance of 1\\.5 m"));
  const Plan inner = Around(course.Global(), {box}, OptionsFor(PassingSideChoice::kInner));
  EXPECT_GT(DiagnosticsJson(inner)["avoid"][0]["clearance_m"].get<double>(), 4.0);
  EXPECT_TRUE(inner.notes.empty());
}

TEST(Listing, TellsWhatTheSteeringCannotDo) {
  const Course course;
  AvoidanceRequest request{.vehicle = ReferenceCar(),
                           .plan = course.Global(),
                           .speed = kLimits,
                           .obstacles = {BoxAt(course.OnArc(0.5))},
                           .station = 0.0,
                           .station_speed = kSpeed,
                           .car = {},
                           .seed = 1};
  request.vehicle.steering_rate = 0.01;
  request.vehicle.steering_limit = 0.1;
  const Plan plan = PlanAround(request, ListingAvoidanceOptions{});
  ASSERT_EQ(plan.notes.size(), 1U);
  EXPECT_THAT(plan.notes[0], testing::AllOf(HasSubstr("kept anyway: steering angle 0.1"),
                                            HasSubstr(" rad exceeds 0.1 rad at s = "),
                                            HasSubstr("; steering rate "),
                                            HasSubstr(" rad/s exceeds 0.01 rad/s")));
}

TEST(Listing, TakesTheNearestSixth) {
  const Course course;
  const auto sixth_at = [&](double share) {
    const Plan plan =
        Around(course.Global(), {BoxAt(course.OnArc(share))}, ListingAvoidanceOptions{});
    return DiagnosticsJson(plan)["avoid"][0]["obstacle_sixth"].get<int>();
  };
  EXPECT_EQ(sixth_at(0.01), 1);
  EXPECT_EQ(sixth_at(0.24), 1);  // 0.24 of the arc is 1.44 sixths of the arc, rounded to 1.
  EXPECT_EQ(sixth_at(0.26), 2);  // 0.26 of the arc is 1.56 sixths of the arc, rounded to 2.
  EXPECT_EQ(sixth_at(0.99), 5);
}

TEST(Listing, SteersStraightAgainBehindACurveThatEndsBent) {
  // In a right turn, the listing's control point P_5 is not on the tangent through P_6 and P_7. The
  // curve therefore ends with the curvature (6/7) h/(S/2)^2, where h = cos(1.2) sin(1.2) is the
  // distance of P_5 from the tangent.
  const Course course{.turn = -1.2};
  const Plan plan = Around(course.Global(), {BoxAt(course.OnArc(0.5))}, ListingAvoidanceOptions{});
  const double back = DiagnosticsJson(plan)["avoid"][0]["return_s_m"].get<double>();
  const double curvature = 6.0 / 7.0 * std::cos(1.2) * std::sin(1.2) / std::pow(0.5 * 22.7, 2);
  EXPECT_NEAR(std::abs(plan.schedule.At(back)), SteeringForCurvature(ReferenceCar(), curvature),
              Tolerance(1e-9));
  EXPECT_EQ(plan.schedule.At(back + 1e-3), 0.0);
  EXPECT_EQ(plan.reference.path.At(back + 1e-3).curvature, 0.0);
}

TEST(Listing, MendedTurnsMirrorEachOther) {
  const Course left{.turn = 1.2};
  const Course right{.turn = -1.2};
  ListingAvoidanceOptions options = OptionsFor(PassingSideChoice::kOuter);
  const auto points_of = [&](const Course& course) {
    return ReadControlPoints(
        DiagnosticsJson(Around(course.Global(), {BoxAt(course.OnArc(0.5))}, options))["avoid"][0]);
  };
  // The published listing shifts the control point P_5 of a right turn along x by the cosine of the
  // turn's angle (defect L9).
  EXPECT_NEAR(points_of(right)[5].x() - points_of(left)[5].x(), std::cos(1.2), Tolerance(1e-9));
  options.literal = {};
  for (std::size_t k = 0; k < 8; ++k) {
    if (k != 3) {  // The height of P_3 is rounded down to whole meters, which is not mirror
                   // symmetric.
      EXPECT_NEAR(points_of(right)[k].x(), points_of(left)[k].x(), Tolerance(1e-9)) << k;
      EXPECT_NEAR(points_of(right)[k].y(), -points_of(left)[k].y(), Tolerance(1e-9)) << k;
    }
  }
}

/// Returns the reason why the listing has no curve for an obstacle.
std::string BlockedMessage(const Course& course, const OrientedBox& box,
                           const ListingAvoidanceOptions& options = {}) {
  const Plan plan = Around(course.Global(), {box}, options);
  EXPECT_TRUE(plan.diagnostics.avoided.empty());
  EXPECT_EQ(DiagnosticsJson(plan)["blocked"], plan.blocked);
  EXPECT_EQ(plan.reference.speed.SpeedAt(plan.reference.path.length()), 0.0);
  return plan.blocked;
}

TEST(Listing, StopsBeforeWhatItHasNoCurveFor) {
  EXPECT_EQ(BlockedMessage({}, {{20.0, 0.0, 0.0}, 2.0, 2.0}),
            "stops before the obstacle at (20, 0): the listing only handles obstacles in turns of "
            "constant radius");
  const Course tight{.radius = 10.0};
  EXPECT_THAT(BlockedMessage(tight, BoxAt(tight.OnArc(0.5))),
              HasSubstr("): passing on the inside needs 10.2784 m (safe distance, obstacle "
                        "diagonal, car width and the 1 m kept free); the turn radius is 10 m"));
}

TEST(Listing, NeedsStraightsBeforeAndAfterTheTurn) {
  const Course early{.before = 22.0};
  EXPECT_THAT(BlockedMessage(early, BoxAt(early.OnArc(0.5))),
              HasSubstr("): the listing needs straights of 22.7 m before and 15.79 m after the "
                        "turn; found 22 m and 42.7 m"));
  const Course late{.turn = -1.2, .after = 20.0};
  EXPECT_THAT(BlockedMessage(late, BoxAt(late.OnArc(0.5))),
              HasSubstr("): the listing needs straights of 22.7 m before and 22.7 m after the "
                        "turn; found 42.7 m and 20 m"));
  // The straights before and after the turn may have exactly the required length.
  const Course enough{.before = 22.7, .turn = -1.2, .after = 22.7};
  EXPECT_EQ(Around(enough.Global(), {BoxAt(enough.OnArc(0.5))}, ListingAvoidanceOptions{}).blocked,
            "");
}

TEST(Listing, TurnsWithItsRoute) {
  // If the problem is moved and rotated, the curve must be the same in the frame of the maneuver.
  const Course course;
  const OrientedBox box = BoxAt(course.OnArc(0.6));
  const Pose2 X_WN{-30.0, 12.0, 2.1};
  std::vector<Vec2> waypoints = course.Waypoints();
  for (Vec2& point : waypoints) {
    point = ToWorld(X_WN, point);
  }
  FilletOptions fillets;
  fillets.radius = course.radius;
  fillets.constraint = RadiusConstraint::kNone;
  const Plan global = MakePlan({.vehicle = ReferenceCar(),
                                .waypoints = waypoints,
                                .start = X_WN,
                                .start_speed = kSpeed,
                                .speed = kLimits},
                               fillets);
  ASSERT_TRUE(global.ok()) << global.reason;
  const OrientedBox moved{Compose(X_WN, box.center), box.length, box.width};
  const auto points = ReadControlPoints(
      DiagnosticsJson(Around(course.Global(), {box}, ListingAvoidanceOptions{}))["avoid"][0]);
  const Plan plan = Around(global, {moved}, ListingAvoidanceOptions{});
  const auto elsewhere = ReadControlPoints(DiagnosticsJson(plan)["avoid"][0]);
  for (std::size_t k = 0; k < 8; ++k) {
    EXPECT_LE((elsewhere[k] - ToWorld(X_WN, points[k])).norm(), Tolerance(1e-9)) << k;
  }
}

TEST(Listing, RefusesOptionsOutOfRange) {
  ListingAvoidanceOptions options;
  options.outer_width = -1.0;
  EXPECT_THROW(Around(Course{}.Global(), {}, options), InternalError);
}

}  // namespace
}  // namespace trackbed
