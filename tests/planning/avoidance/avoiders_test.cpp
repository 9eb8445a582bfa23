#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/planning/obstacle_turns.h"
#include "tests/tolerance.h"
#include "trackbed/path/bezier.h"
#include "trackbed/planning/common/plan.h"

/// Tests the guarantees that every local planner must give.
namespace trackbed {

void PrintTo(const AvoiderEntry& entry, std::ostream* out) {
  *out << entry.name;
}

namespace {

class EveryAvoider : public testing::TestWithParam<AvoiderEntry> {};

INSTANTIATE_TEST_SUITE_P(LocalPlanners, EveryAvoider, testing::ValuesIn(LocalPlanners()),
                         [](const auto& entry) { return std::string(entry.param.name); });

TEST(LocalPlanners, AreNamedOnceAndHaveOptionsOfTheirOwn) {
  ASSERT_EQ(LocalPlanners().size(), std::variant_size_v<AvoiderOptions>);
  EXPECT_STREQ(LocalPlanners()[0].name, "bezier");
  EXPECT_STREQ(LocalPlanners()[1].name, "listing");
  for (std::size_t i = 0; i < LocalPlanners().size(); ++i) {
    EXPECT_EQ(LocalPlanners()[i].defaults.index(), i);
  }
}

/// Returns a box of 2 m x 2 m in the middle of the turn.
OrientedBox InTheMiddle(const Course& course) {
  const Pose2 at = course.OnArc(0.5);
  return {{at.x, at.y, 0.0}, 2.0, 2.0};
}

TEST_P(EveryAvoider, LeavesAPlanThatNothingStandsInTheWayOf) {
  const Plan global = Course{}.Global();
  // The car is 1.725 m wide. A box whose side is 2.3625 m from the path is therefore 1.5 m from the
  // side of the car.
  const OrientedBox beside{{20.0, 3.3626, 0.0}, 2.0, 2.0};
  const Plan plan = Around(global, {beside}, GetParam().defaults);
  EXPECT_EQ(plan.reference.path.segments(), global.reference.path.segments());
  EXPECT_TRUE(plan.diagnostics.avoided.empty());
  EXPECT_EQ(plan.blocked, "");
  const OrientedBox nearer{{20.0, 3.36, 0.0}, 2.0, 2.0};
  const Plan around = Around(global, {nearer}, GetParam().defaults);
  EXPECT_NE(!around.diagnostics.avoided.empty(), !around.blocked.empty());
}

TEST_P(EveryAvoider, LeavesTheWayToTheCurveAsItWas) {
  const Course course;
  const Plan global = course.Global();
  const Plan plan = Around(global, {InTheMiddle(course)}, GetParam().defaults);
  ASSERT_EQ(plan.blocked, "");
  const double leave = DiagnosticsJson(plan)["avoid"][0]["leave_s_m"].get<double>();
  // The arc begins at 42.7 m, and the curve begins S = r + v t_d = 22.7 m before the arc.
  EXPECT_NEAR(leave, 42.7 - 22.7, Tolerance(0.1));
  constexpr double kStep = 1e-6;  // If the steering jumps, the curve may begin this much earlier
                                  // [m].
  for (double s = 0.0; s < leave - kStep; s += 0.5) {
    EXPECT_EQ(plan.reference.path.At(s).pose, global.reference.path.At(s).pose);
    EXPECT_EQ(plan.schedule.At(s), global.schedule.At(s));
  }
}

TEST_P(EveryAvoider, ComesBackToThePlan) {
  const Course course{.turn = -1.3};
  const Plan global = course.Global();
  const Plan plan = Around(global, {InTheMiddle(course)}, GetParam().defaults);
  ASSERT_EQ(plan.blocked, "");
  // Approximating the curve by path segments displaces the path after the curve; SegmentsThrough
  // states this error.
  const Pose2 end = plan.reference.path.At(plan.reference.path.length()).pose;
  const Pose2 goal = global.reference.path.At(global.reference.path.length()).pose;
  EXPECT_LE((end.position() - goal.position()).norm(), Tolerance(1e-6));
  EXPECT_NEAR(end.yaw, goal.yaw, Tolerance(1e-7));
}

TEST_P(EveryAvoider, DrivesTheCurveOfItsControlPoints) {
  const Course course;
  const Plan plan = Around(course.Global(), {InTheMiddle(course)}, GetParam().defaults);
  ASSERT_EQ(plan.blocked, "");
  const nlohmann::json stretch = DiagnosticsJson(plan)["avoid"][0];
  std::vector<Vec2> points;
  for (const nlohmann::json& point : stretch["control_points_m"]) {
    points.emplace_back(point[0].get<double>(), point[1].get<double>());
  }
  ASSERT_EQ(points.size(), 8U);
  const BezierCurve curve(points);
  const double leave = stretch["leave_s_m"].get<double>();
  const double back = stretch["return_s_m"].get<double>();
  EXPECT_NEAR(back - leave, curve.Length(), Tolerance(1e-6));
  for (double u = 0.0; u <= 1.0; u += 0.05) {
    const Vec2 on_curve = curve.At(u);
    const Vec2 on_path = plan.reference.path.At(leave + curve.Length(0.0, u)).pose.position();
    EXPECT_LE((on_path - on_curve).norm(), Tolerance(1e-6)) << u;
  }
}

TEST_P(EveryAvoider, TellsHowNearItsCurveComes) {
  const Course course;
  const OrientedBox box = InTheMiddle(course);
  const Plan plan = Around(course.Global(), {box}, GetParam().defaults);
  ASSERT_EQ(plan.blocked, "");
  const nlohmann::json stretch = DiagnosticsJson(plan)["avoid"][0];
  const Stations curve{stretch["leave_s_m"].get<double>(), stretch["return_s_m"].get<double>()};
  // The planner samples the clearance every 0.05 m, and this test every 0.02 m.
  EXPECT_NEAR(stretch["clearance_m"].get<double>(),
              PathClearance(plan.reference.path, {box}, ReferenceCar(), curve),
              Tolerance(kBetweenSamples));
  if (GetParam().keeps_clear) {
    EXPECT_GE(stretch["clearance_m"].get<double>(), kDistance);
    EXPECT_LE(stretch["steering_rate_max_radps"].get<double>(), ReferenceCar().steering_rate);
    EXPECT_TRUE(plan.notes.empty());
  }
}

TEST_P(EveryAvoider, TheScheduleDrivesTheCurveOpenLoop) {
  const Course course;
  const Plan plan = Around(course.Global(), {InTheMiddle(course)}, GetParam().defaults);
  ASSERT_EQ(plan.blocked, "");
  const Path& path = plan.reference.path;
  const nlohmann::json stretch = DiagnosticsJson(plan)["avoid"][0];
  const double leave = stretch["leave_s_m"].get<double>();
  const double back = stretch["return_s_m"].get<double>();
  // The schedule has a knot at least every 0.1 m with the exact steering angle of the curve, and is
  // linear between knots.
  for (double s = leave; s < back; s += 0.37) {
    EXPECT_NEAR(plan.schedule.At(s), SteeringForCurvature(ReferenceCar(), path.At(s).curvature),
                Tolerance(1e-4));
  }
  const KinematicState end = RollOut(ReferenceCar(), {.pose = path.At(0.0).pose, .speed = kSpeed},
                                     plan.schedule, back, 0.05);
  // Between two knots, the wheels turn at their full rate and then rest. The wheels are ahead of
  // the schedule by at most the distance between two knots, 0.1 m. This lead displaces the path by
  // at most 0.1 m times the heading change. Turns in opposite directions cancel most of this
  // displacement.
  EXPECT_NEAR((end.pose.position() - path.At(back).pose.position()).norm(), 0.0, Tolerance(0.05));
  EXPECT_LE(stretch["open_loop"]["end_distance_m"].get<double>(), 0.05);
}

}  // namespace
}  // namespace trackbed
