#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/geometry/random.h"
#include "tests/planning/routes.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/fillet/fillet.h"

// Tests the radius searches of the global planner (Skackauskas, dissertation, listing F.1).
namespace trackbed {
namespace {

using ::testing::HasSubstr;

constexpr double kSpeed = 3.0;
constexpr ReferencePoint kRear = ReferencePoint::kRearAxle;
constexpr ReferencePoint kCg = ReferencePoint::kCenterOfGravity;

FilletOptions Options(RadiusObjective objective, SearchMethod method = SearchMethod::kCrs2) {
  FilletOptions options;
  options.objective = objective;
  options.search.method = method;
  return options;
}

/// Returns the accuracy that a search must reach for a radius [m].
double Accepted(double radius) {
  return std::max(0.01, 1e-3 * radius);
}

// --- Optima of the objectives --------------------------------------------------------------------

struct FreeRadiusCase {
  const char* name;
  std::vector<Vec2> route;
  RadiusObjective objective;
  ReferencePoint reference;
  std::vector<double> radii;  // Expected radii [m]; 0 if the car does not turn within the window of
                              // the search.
  int decimals;
};

void PrintTo(const FreeRadiusCase& c, std::ostream* out) {
  *out << c.name;
}

class FreeRadius : public ::testing::TestWithParam<FreeRadiusCase> {};

TEST_P(FreeRadius, IsAsPrinted) {
  const FreeRadiusCase& c = GetParam();
  FilletOptions options = Options(c.objective);
  options.reference = c.reference;
  const FilletPlan plan = PlanFillets(ReferenceCar(), c.route, kSpeed, options);
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  for (std::size_t k = 0; k < c.radii.size(); ++k) {
    const double free_radius = plan.turns[k].search->free_radius;
    if (c.radii[k] == 0.0) {
      EXPECT_TRUE(std::isinf(free_radius)) << free_radius;
    } else {
      EXPECT_NEAR(free_radius, c.radii[k], Tolerance(Printed(c.decimals))) << "turn " << k + 1;
    }
  }
}

constexpr RadiusObjective kLiteral = RadiusObjective::kLiteral;
constexpr RadiusObjective kTurnLocal = RadiusObjective::kTurnLocal;

INSTANTIATE_TEST_SUITE_P(
    Section48, FreeRadius,
    ::testing::Values(
        FreeRadiusCase{"ALiteralCg", RouteA(), kLiteral, kCg, {62.8, 0.0, 0.0}, 1},
        FreeRadiusCase{"ALiteralRear", RouteA(), kLiteral, kRear, {62.1, 0.0, 0.0}, 1},
        FreeRadiusCase{"BLiteralCg", RouteB(), kLiteral, kCg, {317.58, 115.43, 623.92}, 2},
        FreeRadiusCase{"BLiteralRear", RouteB(), kLiteral, kRear, {317.09, 115.02, 617.69}, 2},
        FreeRadiusCase{"ALocalCg", RouteA(), kTurnLocal, kCg, {13.1407, 13.1407, 13.1407}, 4},
        FreeRadiusCase{"ALocalRear", RouteA(), kTurnLocal, kRear, {13.0626, 13.0626, 13.0626}, 4},
        FreeRadiusCase{"BLocalRear", RouteB(), kTurnLocal, kRear, {35.7426, 21.2381, 18.7977}, 4}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(FreeRadius, IsWhereTheObjectiveVanishes) {
  // Section 4.7 of the specification gives the closed form sqrt((v t/|dpsi|)^2 - l_g^2), with the
  // duration t and the heading change dpsi of the window, and the distance l_g = 1.4 m from the
  // rear axle to the center of gravity.
  FilletOptions options = Options(kTurnLocal);
  options.reference = kCg;
  const FilletPlan plan = PlanFillets(ReferenceCar(), RouteB(), kSpeed, options);
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  for (const FilletTurn& turn : plan.turns) {
    const TurnSearch& search = *turn.search;
    const double along = kSpeed * search.time / search.heading;
    EXPECT_NEAR(search.free_radius, std::sqrt(along * along - 1.4 * 1.4), Tolerance(1e-9));
    EXPECT_LT(search.result.value, 1e-12);
    EXPECT_EQ(search.heading > 0.0, turn.heading_change > 0.0) << "signed";
    EXPECT_EQ(search.first_radius, ReferenceCar().min_turning_radius());
  }
}

// --- The second pass -----------------------------------------------------------------------------

struct EndCase {
  const char* name;
  std::vector<Vec2> route;
  RadiusConstraint constraint;
  RadiusObjective objective;
  ReferencePoint reference;
  double error;  // Distance from the goal [m].
  int decimals;
};

void PrintTo(const EndCase& c, std::ostream* out) {
  *out << c.name;
}

class SecondPass : public ::testing::TestWithParam<EndCase> {};

TEST_P(SecondPass, MissesTheGoalAsPrinted) {
  const EndCase& c = GetParam();
  FilletOptions options = Options(c.objective);
  options.constraint = c.constraint;
  options.reference = c.reference;
  const FilletPlan plan = PlanFillets(ReferenceCar(), c.route, kSpeed, options);
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  // The verification integrates ramps with steps of 0.5 m, which causes an error of 1e-6 m.
  EXPECT_NEAR(plan.verification.goal_distance, c.error, Tolerance(Printed(c.decimals) + 1e-6));
}

constexpr RadiusConstraint kHalfLeg = RadiusConstraint::kHalfLeg;
constexpr RadiusConstraint kRoom = RadiusConstraint::kSteeringRoom;

INSTANTIATE_TEST_SUITE_P(
    Section49, SecondPass,
    ::testing::Values(EndCase{"AHalfLegCg", RouteA(), kHalfLeg, kLiteral, kCg, 5.519, 3},
                      EndCase{"AHalfLegRear", RouteA(), kHalfLeg, kLiteral, kRear, 3.767, 3},
                      EndCase{"ARoomCg", RouteA(), kRoom, kLiteral, kCg, 1.642, 3},
                      EndCase{"ARoomRear", RouteA(), kRoom, kLiteral, kRear, 0.1285, 4},
                      EndCase{"ALocalCg", RouteA(), kRoom, kTurnLocal, kCg, 1.425, 3},
                      EndCase{"ALocalRear", RouteA(), kRoom, kTurnLocal, kRear, 0.305, 3},
                      EndCase{"BHalfLegCg", RouteB(), kHalfLeg, kLiteral, kCg, 0.575, 3},
                      EndCase{"BHalfLegRear", RouteB(), kHalfLeg, kLiteral, kRear, 0.0076, 4},
                      EndCase{"BRoomCg", RouteB(), kRoom, kLiteral, kCg, 0.566, 3},
                      EndCase{"BRoomRear", RouteB(), kRoom, kLiteral, kRear, 0.0104, 4},
                      EndCase{"BLocalCg", RouteB(), kRoom, kTurnLocal, kCg, 0.563, 3},
                      EndCase{"BLocalRear", RouteB(), kRoom, kTurnLocal, kRear, 0.0375, 4}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(SecondPass, LiteralOptimumOfAFirstTurnIsNeverInterior) {
  // The test plans 1500 random routes of two legs of 12 to 80 m, with heading changes of 10 to 150
  // degrees.
  Random random(1500);
  int planned = 0;
  for (int i = 0; i < 1500; ++i) {
    const double turn = random.Uniform(Radians(10.0), Radians(150.0)) * (i % 2 == 0 ? 1.0 : -1.0);
    const std::vector<Vec2> route{{0, 0}, {random.Uniform(12.0, 80.0), 0}, {0, 0}};
    std::vector<Vec2> bent = route;
    bent[2] = bent[1] + random.Uniform(12.0, 80.0) * Direction(turn);
    FilletOptions options = Options(kLiteral, SearchMethod::kCobyla);
    options.constraint = kHalfLeg;
    const FilletPlan plan = PlanFillets(ReferenceCar(), bent, kSpeed, options);
    if (plan.status != PlanStatus::kOk) {
      continue;
    }
    ++planned;
    EXPECT_NE(plan.turns[0].active, ActiveConstraint::kNone) << i;
  }
  EXPECT_GT(planned, 1000);
}

TEST(SecondPass, LiteralOptimumOfALaterTurnMayBeInterior) {
  // The route has legs of 40 m and turns by +100 degrees and then by +20 degrees. The window of the
  // second turn contains the return ramp of the first turn. An independent computation with a
  // sampled window found a radius of 44.57 m. The sampled window has an error of 4 ms in 11.6 s,
  // which explains the difference of 0.015 m from the converged radius.
  const Vec2 second = Vec2{40, 0} + 40.0 * Direction(Radians(100.0));
  const std::vector<Vec2> route{{0, 0}, {40, 0}, second, second + 40.0 * Direction(Radians(120.0))};
  FilletOptions options = Options(kLiteral);
  options.constraint = kHalfLeg;
  options.reference = kCg;
  const FilletPlan plan = PlanFillets(ReferenceCar(), route, kSpeed, options);
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  EXPECT_NEAR(plan.turns[1].search->free_radius, 44.57, Tolerance(0.004 / 11.6 * 44.57));
  EXPECT_NEAR(plan.turns[1].radius, plan.turns[1].search->free_radius, Tolerance(1e-3));
  EXPECT_EQ(plan.turns[1].active, ActiveConstraint::kNone);
}

TEST(SecondPass, TurnLocalOptimumIsOftenInterior) {
  FilletOptions options = Options(kTurnLocal);
  const FilletPlan plan = PlanFillets(ReferenceCar(), RouteB(), kSpeed, options);
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  for (const FilletTurn& turn : plan.turns) {
    EXPECT_EQ(turn.active, ActiveConstraint::kNone);
    EXPECT_NEAR(turn.radius, turn.search->free_radius, Tolerance(1e-4));
  }
}

TEST(SecondPass, SimulatesAgainWhenAskedTo) {
  // A second simulation leaves the window of the first turn unchanged. The window of the published
  // listing for the second turn changes, because the first turn then ends on its new radius.
  FilletOptions once = Options(kLiteral);
  FilletOptions again = once;
  again.resimulate_each_turn = true;
  const FilletPlan a = PlanFillets(ReferenceCar(), RouteB(), kSpeed, once);
  const FilletPlan b = PlanFillets(ReferenceCar(), RouteB(), kSpeed, again);
  ASSERT_EQ(a.status, PlanStatus::kOk) << a.reason;
  ASSERT_EQ(b.status, PlanStatus::kOk) << b.reason;
  EXPECT_EQ(a.turns[0].search->time, b.turns[0].search->time);
  EXPECT_NE(a.turns[1].search->time, b.turns[1].search->time);
  // The turn-local window covers only one turn and does not depend on the other turns, so its
  // result stays the same.
  once.objective = again.objective = kTurnLocal;
  const FilletPlan c = PlanFillets(ReferenceCar(), RouteB(), kSpeed, once);
  const FilletPlan d = PlanFillets(ReferenceCar(), RouteB(), kSpeed, again);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(c.turns[k].search->free_radius, d.turns[k].search->free_radius, Tolerance(1e-6));
  }
}

// --- The searches against the closed form --------------------------------------------------------

struct SearchCase {
  SearchMethod method;
  RadiusConstraint constraint;
};

void PrintTo(const SearchCase& c, std::ostream* out) {
  *out << SearchFor(c.method).name;
}

class SearchedRadius : public ::testing::TestWithParam<SearchCase> {};

/// Returns the best radius of a scan with steps of 0.02 m within the bounds, and then of 0.0001 m
/// around the best radius found.
std::optional<double> Scanned(const FilletTurn& turn, double free_radius, RadiusConstraint c) {
  const auto kept = [&](double r) {
    const double ramp = c == kRoom ? kSpeed * 17.6 / 2.65 * std::atan(2.7 / r) : 0.0;
    return r / std::tan(turn.interior_angle / 2.0) + ramp <= turn.shorter_leg / 2.0 + 1e-9;
  };
  std::optional<double> best;
  const auto scan = [&](double from, double to, double step) {
    for (double r = from; r <= to; r += step) {
      if (kept(r) && (!best || std::abs(1.0 / r - 1.0 / free_radius) <
                                   std::abs(1.0 / *best - 1.0 / free_radius))) {
        best = r;
      }
    }
  };
  scan(5.1, 154.0, 0.02);
  if (best) {
    scan(std::max(5.1, *best - 0.02), std::min(154.0, *best + 0.02), 1e-4);
  }
  return best;
}

TEST_P(SearchedRadius, IsTheClosedFormsOnRandomTurns) {
  Random random(4711);
  int interior = 0;
  int on_constraint = 0;
  int empty = 0;
  for (int i = 0; i < 1000; ++i) {
    const double turn = random.Uniform(Radians(10.0), Radians(150.0)) * (i % 2 == 0 ? 1.0 : -1.0);
    std::vector<Vec2> route{{0, 0}, {random.Uniform(12.0, 80.0), 0}};
    route.push_back(route[1] + random.Uniform(12.0, 80.0) * Direction(turn));
    SCOPED_TRACE(fmt::format("case {}: {} deg, legs to ({}, 0) and ({}, {})", i, Degrees(turn),
                             route[1].x(), route[2].x(), route[2].y()));
    FilletOptions options = Options(kTurnLocal, GetParam().method);
    options.constraint = GetParam().constraint;
    options.without_room = InfeasibleTurnPolicy::kRefuse;
    const FilletPlan plan =
        PlanFillets(ReferenceCar(), route, kSpeed, options, static_cast<std::uint64_t>(i));
    // The plan without a search has the same geometry, and shows whether any radius is feasible.
    FilletOptions closed = options;
    closed.objective = RadiusObjective::kLargest;
    const FilletPlan largest = PlanFillets(ReferenceCar(), route, kSpeed, closed);
    ASSERT_EQ(plan.status, largest.status) << plan.reason << "; " << largest.reason;
    if (largest.status != PlanStatus::kOk) {
      ++empty;
      continue;
    }
    const FilletTurn& found = plan.turns[0];
    const double free_radius = found.search->free_radius;
    const auto best = Scanned(largest.turns[0], free_radius, options.constraint);
    ASSERT_TRUE(best || largest.turns[0].radius - 5.1 < 0.02) << "the scan found none";
    if (best) {
      EXPECT_NEAR(found.radius, *best, Tolerance(Accepted(*best) + 1e-4));
    }
    if (options.constraint == kHalfLeg) {
      EXPECT_NEAR(found.radius, std::clamp(free_radius, 5.1, largest.turns[0].radius),
                  Tolerance(Accepted(found.radius)));
    }
    ++(found.active == ActiveConstraint::kNone ? interior : on_constraint);
  }
  // The random turns include all three kinds of results.
  EXPECT_GT(interior, 200);
  EXPECT_GT(on_constraint, 100);
  EXPECT_GT(empty, 50);
}

INSTANTIATE_TEST_SUITE_P(HalfLeg, SearchedRadius,
                         ::testing::Values(SearchCase{SearchMethod::kIsres, kHalfLeg},
                                           SearchCase{SearchMethod::kCrs2, kHalfLeg},
                                           SearchCase{SearchMethod::kDirect, kHalfLeg},
                                           SearchCase{SearchMethod::kCobyla, kHalfLeg}),
                         [](const auto& test) {
                           return std::string(SearchFor(test.param.method).name);
                         });
INSTANTIATE_TEST_SUITE_P(SteeringRoom, SearchedRadius,
                         ::testing::Values(SearchCase{SearchMethod::kIsres, kRoom},
                                           SearchCase{SearchMethod::kCrs2, kRoom},
                                           SearchCase{SearchMethod::kDirect, kRoom},
                                           SearchCase{SearchMethod::kCobyla, kRoom}),
                         [](const auto& test) {
                           return std::string(SearchFor(test.param.method).name);
                         });

TEST(SearchedRadius, KeepsItsHistory) {
  const FilletPlan plan =
      PlanFillets(ReferenceCar(), RouteA(), kSpeed, Options(kTurnLocal, SearchMethod::kIsres), 7);
  ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
  const SearchResult& result = plan.turns[0].search->result;
  EXPECT_EQ(result.evaluations, 10000);
  EXPECT_EQ(result.history.size(), 100U) << "one per generation of 100";
  EXPECT_EQ(result.history.back().x[0], plan.turns[0].radius);
}

// --- The driven objective ------------------------------------------------------------------------

TEST(Driven, EndsAtTheGoalAndStaysNearerToThePath) {
  for (const auto& [route, goal] : {std::pair{RouteA(), 0.05}, std::pair{RouteB(), 0.01}}) {
    const FilletPlan closed = PlanFillets(ReferenceCar(), route, kSpeed, {});
    for (const SearchMethod method : {SearchMethod::kDirect, SearchMethod::kSlsqp}) {
      const FilletPlan plan =
          PlanFillets(ReferenceCar(), route, kSpeed, Options(RadiusObjective::kDriven, method), 1);
      ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
      EXPECT_LE(plan.verification.goal_distance, goal);
      EXPECT_LE(plan.verification.deviation_max, closed.verification.deviation_max);
      EXPECT_LT(plan.stop_distance, plan.path.length()) << "ramps cut corners";
      for (const FilletTurn& turn : plan.turns) {
        const double need = turn.tangent_length + turn.ramp_distance;
        EXPECT_LE(need, turn.shorter_leg / 2.0 + Tolerance(1e-9)) << "C.40";
      }
    }
  }
}

TEST(Driven, WeighsWhatItIsTold) {
  FilletOptions options = Options(RadiusObjective::kDriven, SearchMethod::kSlsqp);
  options.weights = {.position = 0.0, .heading = 0.0, .end = 1.0};
  const FilletPlan end_only = PlanFillets(ReferenceCar(), RouteA(), kSpeed, options);
  EXPECT_LT(end_only.verification.goal_distance, 1e-4) << "ten variables for two coordinates";
  options.weights = {.position = 1.0, .heading = 0.0, .end = 0.0};
  const FilletPlan position_only = PlanFillets(ReferenceCar(), RouteA(), kSpeed, options);
  EXPECT_GT(position_only.verification.goal_distance, end_only.verification.goal_distance);
}

TEST(Driven, IsNoWorseThanWhereItStarted) {
  // Some legs are so short that constraint C.40 has no feasible radius at 3 m/s. The planner
  // reduces the speed in such turns.
  Random random(31);
  for (int i = 0; i < 10; ++i) {
    const std::vector<Vec2> route = RandomRoute(random, 4, 25.0, 60.0, Radians(100.0));
    const FilletPlan closed = PlanFillets(ReferenceCar(), route, kSpeed, {});
    if (closed.status != PlanStatus::kOk) {
      continue;
    }
    const FilletPlan plan = PlanFillets(ReferenceCar(), route, kSpeed,
                                        Options(RadiusObjective::kDriven, SearchMethod::kSlsqp));
    ASSERT_EQ(plan.status, PlanStatus::kOk) << plan.reason;
    ASSERT_FALSE(plan.search->history.empty());
    EXPECT_LE(plan.search->value, plan.search->history.front().value);
    EXPECT_LE(plan.verification.goal_distance, closed.verification.goal_distance + 1e-3) << i;
  }
}

// --- Laws ----------------------------------------------------------------------------------------

TEST(SearchedPlans, OfMovedAndMirroredRoutesAreMovedAndMirrored) {
  Random random(99);
  for (int i = 0; i < 30; ++i) {
    const std::vector<Vec2> route = RandomRoute(random, 5, 35.0, 80.0, Radians(100.0));
    const Pose2 X_WA{random.Uniform(-100.0, 100.0), random.Uniform(-100.0, 100.0),
                     random.Uniform(-kPi, kPi)};
    std::vector<Vec2> moved;
    std::vector<Vec2> mirrored;
    for (const Vec2& w : route) {
      moved.push_back(ToWorld(X_WA, w));
      mirrored.emplace_back(w.x(), -w.y());
    }
    for (const RadiusObjective objective : {kLiteral, kTurnLocal}) {
      const FilletOptions options = Options(objective, SearchMethod::kDirect);
      const FilletPlan plan = PlanFillets(ReferenceCar(), route, kSpeed, options);
      const FilletPlan a = PlanFillets(ReferenceCar(), moved, kSpeed, options);
      const FilletPlan b = PlanFillets(ReferenceCar(), mirrored, kSpeed, options);
      ASSERT_EQ(plan.status, a.status);
      ASSERT_EQ(plan.status, b.status);
      for (std::size_t k = 0; k < plan.turns.size(); ++k) {
        const double radius = plan.turns[k].radius;
        EXPECT_NEAR(a.turns[k].radius, radius, Tolerance(Accepted(radius)));
        EXPECT_NEAR(b.turns[k].radius, radius, Tolerance(Accepted(radius)));
        EXPECT_EQ(a.turns[k].steering > 0.0, plan.turns[k].steering > 0.0);
        EXPECT_NE(b.turns[k].steering > 0.0, plan.turns[k].steering > 0.0);
      }
    }
  }
}

TEST(SearchedPlans, AreContinuousAndKeepWhatTheyClaimOrSayWhyNot) {
  Random random(12);
  int planned = 0;
  int refused = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::vector<Vec2> route =
        RandomRoute(random, 3 + random.Below(10), 12.0, 90.0, Radians(140.0));
    SCOPED_TRACE(fmt::format("case {}", i));
    FilletOptions options = Options(i % 2 == 0 ? kLiteral : kTurnLocal,
                                    i % 3 == 0 ? SearchMethod::kDirect : SearchMethod::kCobyla);
    options.constraint = i % 5 == 0 ? kHalfLeg : kRoom;
    const FilletPlan plan = PlanFillets(ReferenceCar(), route, kSpeed, options);
    if (plan.status != PlanStatus::kOk) {
      ++refused;
      EXPECT_THAT(plan.reason, HasSubstr(fmt::format("waypoint {}", plan.waypoint)));
      continue;
    }
    ++planned;
    const Pose2 end = plan.path.At(plan.path.length()).pose;
    EXPECT_NEAR((end.position() - route.back()).norm(), 0.0, Tolerance(1e-9));
    for (const FilletTurn& turn : plan.turns) {
      EXPECT_GE(turn.radius, 5.1 - 1e-9);
      EXPECT_LE(turn.radius, options.max_radius);
      const bool room =
          options.constraint == kRoom && turn.note.find("under C.34") == std::string::npos;
      const double ramps = turn.note.find("half of the ramp") == std::string::npos ? 1.0 : 0.5;
      const double need = turn.tangent_length + (room ? ramps * turn.ramp_distance : 0.0);
      EXPECT_LE(need, turn.shorter_leg / 2.0 + Tolerance(2e-9));
      // The path must pass through the computed ends of the arc.
      EXPECT_NEAR((plan.path.At(turn.arc_start_s).pose.position() - turn.arc_start).norm(), 0.0,
                  Tolerance(1e-9));
      EXPECT_NEAR(
          (plan.path.At(turn.arc_start_s + turn.arc_length).pose.position() - turn.arc_end).norm(),
          0.0, Tolerance(1e-9));
    }
  }
  EXPECT_GT(planned, 300);
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace trackbed
