#include "trackbed/planning/avoidance/turn_maneuver.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "tests/geometry/random.h"
#include "tests/planning/routes.h"
#include "tests/support/expect_near.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/world/world.h"

// Tests the avoidance maneuver in a turn against the code listing and the printed numbers of
// Skackauskas, dissertation, sections 5.1 to 5.10: layout, safe point, control points, Bezier
// curve, run and search. Labels such as L9 refer to known defects of the listing, which
// docs/published-experiments.md explains.
namespace trackbed {
namespace {

// Rounding error [m] of some ten operations on coordinates up to 300 m. Each operation has an error
// of 300 x 2^-53 = 3e-14 m.
constexpr double kRounding = 1e-12;

using Points = std::array<Vec2, 8>;

TurnManeuver Literal(TurnSide side, PassingSide passing_side, double reduction = kPi / 12.0,
                     int sixth = 3) {
  TurnManeuver maneuver;
  maneuver.side = side;
  maneuver.inner_width = passing_side == PassingSide::kInner ? 1.0 : 0.0;
  maneuver.outer_width = passing_side == PassingSide::kInner ? 0.0 : 1.0;
  maneuver.reduction = reduction;
  maneuver.obstacle_sixth = sixth;
  maneuver.literal = kLiteralTurn;
  return maneuver;
}

TurnLayout LayOut(const TurnManeuver& maneuver) {
  TurnLayout layout = LayOutTurn(maneuver, ReferenceCar());
  EXPECT_EQ(layout.status, TurnStatus::kOk) << layout.reason;
  return layout;
}

Points ControlPointsFor(const TurnManeuver& maneuver, double final_y) {
  return ControlPoints(maneuver, LayOut(maneuver), ReferenceCar(), final_y);
}

BezierCurve CurveThrough(const Points& points) {
  return BezierCurve({points.begin(), points.end()});
}

/// Returns a car whose rear axle is in the middle of its footprint. The center of the footprint
/// then moves along the curve, as in the listing.
VehicleParams CenteredCar() {
  VehicleParams car = ReferenceCar();
  car.rear_overhang = 0.5 * car.length;
  return car;
}

ManeuverRun Drive(const TurnManeuver& maneuver, double final_y,
                  const VehicleParams& car = CenteredCar()) {
  const TurnLayout layout = LayOut(maneuver);
  const Points points = ControlPoints(maneuver, layout, car, final_y);
  return SimulateManeuver(maneuver, layout, car, CurveThrough(points));
}

/// Returns a random problem with a valid layout. The problems cover every branch of the listing.
/// The angle of the turn keeps its default, because the arc of the listing starts from pi/2.
TurnManeuver RandomLiteral(Random& random) {
  const TurnSide side = random.Below(2) == 0 ? TurnSide::kLeft : TurnSide::kRight;
  const PassingSide passing_side = random.Below(2) == 0 ? PassingSide::kInner : PassingSide::kOuter;
  const double reduction = random.Below(3) == 0 ? 0.0 : random.Uniform(-0.5, 1.3);
  TurnManeuver maneuver = Literal(side, passing_side, reduction, 1 + random.Below(5));
  maneuver.radius = random.Uniform(30.0, 60.0);
  maneuver.speed = random.Uniform(0.5, 8.0);
  maneuver.delay = random.Uniform(0.0, 2.0);
  maneuver.obstacle_length = random.Uniform(0.5, 4.0);
  maneuver.obstacle_width = random.Uniform(0.5, 4.0);
  maneuver.safe_distance = random.Uniform(0.0, 3.0);
  maneuver.inner_width += random.Uniform(0.0, 0.5);
  maneuver.outer_width += random.Uniform(0.0, 0.5);
  return maneuver;
}

std::string Describe(const TurnManeuver& m) {
  return fmt::format("{} {}, r_1 {}, reduction {}, sixth {}",
                     m.side == TurnSide::kLeft ? "left" : "right",
                     m.passing_side() == PassingSide::kInner ? "inner" : "outer", m.radius,
                     m.reduction, m.obstacle_sixth);
}

// --- Arc and obstacle: sections 5.1 and 5.2 ----------------------------------------------------

TEST(TurnManeuver, DefaultsAreTheListings) {
  const TurnManeuver maneuver;
  EXPECT_NEAR(maneuver.straight(), 22.7, Tolerance(kRounding));
  EXPECT_EQ(maneuver.passing_side(), PassingSide::kInner);
  EXPECT_EQ(maneuver.turn_angle, kPi / 2.0);
  EXPECT_EQ(maneuver.reduction, kPi / 12.0);
}

TEST(TurnManeuver, TakesTheInnerRingWhenBothAreAlike) {
  TurnManeuver maneuver;
  maneuver.outer_width = maneuver.inner_width;
  EXPECT_EQ(maneuver.passing_side(), PassingSide::kInner);
  maneuver.outer_width = std::nextafter(maneuver.inner_width, 2.0);
  EXPECT_EQ(maneuver.passing_side(), PassingSide::kOuter);
}

TEST(LayOutTurn, LeftTurnGoesToPositiveY) {
  TurnManeuver maneuver;
  EXPECT_GT(LayOut(maneuver).arc.back().position.y(), 1.0);
  maneuver.side = TurnSide::kRight;
  EXPECT_LT(LayOut(maneuver).arc.back().position.y(), -1.0);
}

TEST(LayOutTurn, ArcRunsFromEndToEnd) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    TurnManeuver maneuver = RandomLiteral(random);
    maneuver.literal = {};
    maneuver.turn_angle = maneuver.reduction + random.Uniform(0.05, 3.0);
    SCOPED_TRACE(Describe(maneuver));
    const TurnLayout layout = LayOut(maneuver);
    const double sign = maneuver.side == TurnSide::kLeft ? 1.0 : -1.0;
    const Vec2 center{maneuver.straight(), sign * maneuver.radius};
    ASSERT_GE(layout.arc.size(), 2U);
    ExpectNear(layout.arc.front().position, {maneuver.straight(), 0.0}, kRounding);
    EXPECT_EQ(layout.arc.front().angle, 0.0);
    EXPECT_EQ(layout.arc.back().angle, maneuver.turn_angle - maneuver.reduction);
    for (std::size_t k = 1; k < layout.arc.size(); ++k) {
      EXPECT_NEAR((layout.arc[k].position - center).norm(), maneuver.radius, Tolerance(kRounding));
      EXPECT_LE(layout.arc[k].angle - layout.arc[k - 1].angle, 0.01 + Tolerance(kRounding));
    }
    // The obstacle is at n sixths of the arc, and the safe point is at the same angle.
    const double angle = maneuver.obstacle_sixth / 6.0 * layout.arc.back().angle;
    EXPECT_NEAR(layout.safe_angle, angle, Tolerance(kRounding));
    const Vec2 out{std::sin(angle), -sign * std::cos(angle)};
    ExpectNear(layout.obstacle.center.position(), center + maneuver.radius * out, kRounding);
    ExpectNear(layout.safe_point, center + layout.safe_radius * out, kRounding);
    EXPECT_NEAR(layout.arc[layout.obstacle_at - 1].angle, angle, 0.005 + Tolerance(kRounding));
  }
}

TEST(LayOutTurn, LiteralGridHasThePrintedPoints) {
  const TurnLayout layout = LayOut(Literal(TurnSide::kLeft, PassingSide::kInner));
  EXPECT_EQ(layout.arc.size(), 131U);
  ExpectNear(layout.arc.front().position, {22.8799, 0.0008}, Printed(4));
  // The other end of the arc is exactly at 90 - 15 = 75 degrees.
  EXPECT_NEAR(layout.arc.back().angle, 75.0 * kPi / 180.0, Tolerance(kRounding));
  EXPECT_EQ(LayOut(Literal(TurnSide::kLeft, PassingSide::kInner, 0.0)).arc.size(), 158U);
}

TEST(LayOutTurn, LiteralObstacleStandsOnThePrintedPoint) {
  const std::array<std::size_t, 5> reduced{22, 44, 66, 87, 109};
  const std::array<std::size_t, 5> whole{26, 53, 79, 105, 132};
  for (int n = 1; n <= 5; ++n) {
    const auto i = static_cast<std::size_t>(n) - 1;
    EXPECT_EQ(LayOut(Literal(TurnSide::kLeft, PassingSide::kInner, kPi / 12.0, n)).obstacle_at,
              reduced[i]);
    EXPECT_EQ(LayOut(Literal(TurnSide::kLeft, PassingSide::kInner, 0.0, n)).obstacle_at, whole[i]);
  }
  const TurnLayout layout = LayOut(Literal(TurnSide::kLeft, PassingSide::kInner));
  ExpectNear(layout.obstacle.center.position(), {34.946483, 4.187863}, Printed(6));
  EXPECT_NEAR(layout.safe_angle + kPi / 12.0, 0.911799, Tolerance(Printed(6)));
  ExpectNear(layout.obstacle.Corners()[2], {33.9465, 3.1879}, Printed(4));
  ExpectNear(layout.obstacle.Corners()[0], {35.9465, 5.1879}, Printed(4));
}

TEST(LayOutTurn, LiteralAnglesMissByLessThanAStep) {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const TurnManeuver maneuver = RandomLiteral(random);
    SCOPED_TRACE(Describe(maneuver));
    const TurnLayout layout = LayOut(maneuver);
    // The range of angles is not a whole number of the grid's steps. The remainder is at most one
    // step of 0.01 rad.
    const double late = layout.arc.front().angle;
    EXPECT_GE(late, -Tolerance(kRounding));
    EXPECT_LE(late, 0.01 + Tolerance(kRounding));
    EXPECT_NEAR(layout.arc[layout.obstacle_at - 1].angle, layout.safe_angle + late,
                Tolerance(kRounding));
  }
}

// --- Safe point -------------------------------------------------------------------------------

TEST(SafeRadius, IsAsPrinted) {
  TurnManeuver maneuver;
  EXPECT_NEAR(SafeRadius(maneuver, 1.725, PassingSide::kInner), 9.721573, Tolerance(Printed(6)));
  EXPECT_NEAR(SafeRadius(maneuver, 1.725, PassingSide::kOuter), 43.917641, Tolerance(Printed(6)));
  maneuver.outer_width = 1.0;
  EXPECT_NEAR(SafeRadius(maneuver, 1.725, PassingSide::kOuter), 45.417641, Tolerance(Printed(6)));
}

TEST(LayOutTurn, SafePointIsAsPrinted) {
  struct Row {
    PassingSide passing_side;
    double reduction;
    Vec2 point;
    int decimals;
  };
  const std::vector<Row> rows{{PassingSide::kInner, kPi / 12.0, {28.583364, 12.260813}, 6},
                              {PassingSide::kOuter, kPi / 12.0, {50.1861, -16.1562}, 4},
                              {PassingSide::kInner, 0.0, {29.5370, 13.0888}, 4},
                              {PassingSide::kOuter, 0.0, {54.6413, -12.2880}, 4}};
  for (const Row& row : rows) {
    ExpectNear(LayOut(Literal(TurnSide::kLeft, row.passing_side, row.reduction)).safe_point,
               row.point, Printed(row.decimals));
    ExpectNear(LayOut(Literal(TurnSide::kRight, row.passing_side, row.reduction)).safe_point,
               {row.point.x(), -row.point.y()}, Printed(row.decimals));
  }
}

/// Computes the safe point by the branches of the listing, with corrected parentheses. The last
/// branch has the angle theta_m + 3 pi/2 - dec. With -theta_m, as printed, the safe point of a
/// right turn would not mirror the safe point of the left turn.
Vec2 SafePointByBranches(const TurnManeuver& m, double r_k, double theta_m) {
  const bool inner = m.inner_width >= m.outer_width;
  const double dec = m.reduction;
  const double c_x = m.straight();
  const double c_y = m.side == TurnSide::kLeft ? m.radius : -m.radius;
  const double quarter = 3.0 * kPi / 2.0;
  if (inner) {
    if (dec == 0.0) {
      if (c_y > 0.0) {
        return {c_x + r_k * std::cos(theta_m + quarter), c_y + r_k * std::sin(theta_m + quarter)};
      }
      return {c_x + r_k * std::cos(theta_m + quarter), c_y - r_k * std::sin(-theta_m + quarter)};
    }
    if (c_y > 0.0) {
      return {c_x + r_k * std::cos(theta_m + quarter - dec),
              c_y + r_k * std::sin(theta_m + quarter - dec)};
    }
    return {c_x + r_k * std::cos(theta_m + quarter - dec),
            c_y - r_k * std::sin(-theta_m + quarter + dec)};
  }
  if (dec == 0.0) {
    if (c_y > 0.0) {
      return {c_x + r_k * std::cos(theta_m + quarter), c_y + r_k * std::sin(theta_m + quarter)};
    }
    return {c_x + r_k * std::cos(theta_m + quarter), c_y - r_k * std::sin(-theta_m + quarter)};
  }
  if (c_y > 0.0) {
    return {c_x + r_k * std::cos(theta_m + quarter - dec),
            c_y + r_k * std::sin(theta_m + quarter - dec)};
  }
  return {c_x + r_k * std::cos(theta_m + quarter - dec),
          c_y - r_k * std::sin(theta_m + quarter - dec)};
}

TEST(LayOutTurn, OneFormulaIsAllEightBranches) {
  Random random(3);
  std::array<int, 8> seen{};
  for (int i = 0; i < 2000; ++i) {
    const TurnManeuver maneuver = RandomLiteral(random);
    SCOPED_TRACE(Describe(maneuver));
    const TurnLayout layout = LayOut(maneuver);
    const double is_k = std::sqrt(maneuver.obstacle_width * maneuver.obstacle_width +
                                  maneuver.obstacle_length * maneuver.obstacle_length) /
                        2.0;
    const double need = 2.0 * maneuver.safe_distance + 2.0 * is_k + 2.0 * 1.725;
    const bool inner = maneuver.passing_side() == PassingSide::kInner;
    const double r_k = inner ? maneuver.radius - need - maneuver.inner_width
                             : 1.5 * (maneuver.radius + need + maneuver.outer_width);
    EXPECT_NEAR(layout.safe_radius, r_k, Tolerance(kRounding));
    const double theta_m =
        maneuver.reduction + 0.01 * (static_cast<double>(layout.obstacle_at) - 1.0);
    ExpectNear(layout.safe_point, SafePointByBranches(maneuver, r_k, theta_m), kRounding);
    ++seen[(inner ? 4U : 0U) + (maneuver.reduction == 0.0 ? 2U : 0U) +
           (maneuver.side == TurnSide::kLeft ? 1U : 0U)];
  }
  EXPECT_GT(*std::min_element(seen.begin(), seen.end()), 100);
}

TEST(LayOutTurn, RefusesATurnTooTightToPassInside) {
  // Passing on the inside needs a radius of at least 2 SD + 2 IS_k + 2 w_a + 1 = 3 + 2 sqrt(2) +
  // 3.45 + 1 = 10.2784 m, where SD is the safe distance, IS_k is half the obstacle's diagonal and
  // w_a is the car's width.
  const double limit = 7.45 + std::sqrt(8.0);
  TurnManeuver maneuver;
  maneuver.radius = limit * (1.0 + 1e-12);
  EXPECT_EQ(LayOutTurn(maneuver, ReferenceCar()).status, TurnStatus::kOk);
  maneuver.radius = limit * (1.0 - 1e-12);
  EXPECT_EQ(LayOutTurn(maneuver, ReferenceCar()).status, TurnStatus::kNoSafePoint);
  maneuver.radius = 10.0;
  const TurnLayout layout = LayOutTurn(maneuver, ReferenceCar());
  EXPECT_EQ(layout.status, TurnStatus::kNoSafePoint);
  EXPECT_EQ(layout.reason,
            "passing on the inside needs 10.2784 m (safe distance, obstacle diagonal, car width "
            "and the 1 m kept free); the turn radius is 10 m");
  EXPECT_THROW(ControlPoints(maneuver, layout, ReferenceCar(), 0.0), InternalError);
  // Passing on the outside is always possible.
  maneuver.outer_width = 2.0;
  EXPECT_EQ(LayOutTurn(maneuver, ReferenceCar()).status, TurnStatus::kOk);
}

TEST(LayOutTurn, RefusesAReductionThatLeavesNoTurn) {
  TurnManeuver maneuver;
  maneuver.reduction = maneuver.turn_angle;
  const TurnLayout layout = LayOutTurn(maneuver, ReferenceCar());
  EXPECT_EQ(layout.status, TurnStatus::kNoTurn);
  EXPECT_EQ(layout.reason, "a turn of 1.5708 rad less 1.5708 rad leaves no arc");
  // With these values, the grid of the published listing has only two points. One sixth of two
  // points is rounded to zero points.
  maneuver.literal.grid = true;
  maneuver.obstacle_sixth = 1;
  maneuver.reduction = maneuver.turn_angle - 0.015;
  EXPECT_EQ(LayOutTurn(maneuver, ReferenceCar()).status, TurnStatus::kNoTurn);
}

TEST(LayOutTurn, NumbersOutOfRangeAreBugs) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](auto change) {
    TurnManeuver maneuver;
    change(maneuver);
    EXPECT_THROW(LayOutTurn(maneuver, ReferenceCar()), InternalError);
  };
  // The published listing uses abs(r_1), as if right turns had a negative radius r_1. With a
  // negative radius, the length S of the maneuver would be wrong.
  refused([](TurnManeuver& m) { m.radius = -20.0; });
  refused([](TurnManeuver& m) { m.speed = 0.0; });
  refused([](TurnManeuver& m) { m.delay = -0.1; });
  refused([&](TurnManeuver& m) { m.reduction = nan; });
  refused([](TurnManeuver& m) { m.turn_angle = 7.0; });
  refused([](TurnManeuver& m) { m.obstacle_sixth = 0; });
  refused([](TurnManeuver& m) { m.obstacle_sixth = 6; });
  refused([](TurnManeuver& m) { m.obstacle_length = 0.0; });
  refused([&](TurnManeuver& m) { m.obstacle_width = nan; });
  refused([](TurnManeuver& m) { m.safe_distance = -1.0; });
  refused([](TurnManeuver& m) { m.inner_width = -1.0; });
  refused([&](TurnManeuver& m) { m.outer_width = nan; });
}

// --- Control points ----------------------------------------------------------------------------

/// Computes the control points by the branches of the listing.
Points PointsByBranches(const TurnManeuver& m, const TurnLayout& layout, double final_y) {
  const bool left = m.side == TurnSide::kLeft;
  const bool inner = m.inner_width >= m.outer_width;
  const double c_y = left ? m.radius : -m.radius;
  const double s = m.straight();
  const double dec = m.reduction;
  const Vec2 first = layout.arc.front().position;
  const Vec2 last = layout.arc.back().position;
  const Vec2 goal = layout.safe_point;
  const double theta_m = dec + 0.01 * (static_cast<double>(layout.obstacle_at) - 1.0);
  const double r_k_1 = m.radius - 2.0 * m.safe_distance -
                       std::hypot(m.obstacle_width, m.obstacle_length) - 2.0 * 1.725 -
                       m.inner_width;
  const double y_r_1 = c_y + r_k_1 * std::sin(theta_m + 3.0 * kPi / 2.0);
  const double y_r_2 = c_y - r_k_1 * std::sin(-theta_m + 3.0 * kPi / 2.0);

  Points p;
  p[0] = {0.0, 0.0};
  const auto middle =
      static_cast<std::size_t>(std::round(static_cast<double>(layout.arc.size()) * (3.0 / 6.0)));
  if (layout.obstacle_at > middle) {
    p[2] = first;
  } else {
    p[2] = {first.x() * (2.0 / 3.0), first.y()};
  }
  p[1] = {p[2].x() / 2.0, 0.0};
  p[3] = {first.x(), final_y};
  p[4] = goal;
  const double c = std::cos(kPi / 2.0 - dec);
  const double n = std::sin(kPi / 2.0 - dec);
  if (dec == 0.0) {
    if (inner) {
      p[5] = {last.x(), goal.y()};
      p[6] = {last.x(), left ? goal.y() + s / 2.0 : goal.y() - s / 2.0};
      p[7] = {last.x(), left ? goal.y() + s : goal.y() - s};
    } else if (left) {
      p[5] = {last.x(), y_r_1};
      p[6] = {last.x(), y_r_1 + s / 2.0};
      p[7] = {last.x(), y_r_1 + s};
    } else {
      p[5] = {last.x(), y_r_2};
      p[6] = {last.x(), y_r_2 - s / 2.0};
      p[7] = {last.x(), y_r_2 - s};
    }
  } else if (left) {
    p[5] = last;
    p[6] = {last.x() + c * (s / 2.0), last.y() + n * (s / 2.0)};
    p[7] = {last.x() + c * s, last.y() + n * s};
  } else {
    p[5] = {last.x() + c, last.y()};
    p[6] = {last.x() + c * (s / 2.0), last.y() - n * (s / 2.0)};
    p[7] = {last.x() + c * s, last.y() - n * s};
  }
  return p;
}

TEST(ControlPoints, LiteralOnesAreThoseOfEveryBranch) {
  Random random(4);
  for (int i = 0; i < 2000; ++i) {
    const TurnManeuver maneuver = RandomLiteral(random);
    SCOPED_TRACE(Describe(maneuver));
    const double final_y = random.Uniform(-8.0, 8.0);
    const TurnLayout layout = LayOut(maneuver);
    const Points actual = ControlPoints(maneuver, layout, ReferenceCar(), final_y);
    const Points expected = PointsByBranches(maneuver, layout, final_y);
    for (std::size_t k = 0; k < 8; ++k) {
      SCOPED_TRACE(k);
      ExpectNear(actual[k], expected[k], kRounding);
    }
  }
}

TEST(ControlPoints, LieOnTheTangentsOfTheTurn) {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    TurnManeuver maneuver = RandomLiteral(random);
    maneuver.literal = {};
    SCOPED_TRACE(Describe(maneuver));
    const Points p = ControlPointsFor(maneuver, random.Uniform(-5.0, 5.0));
    const double sign = maneuver.side == TurnSide::kLeft ? 1.0 : -1.0;
    const double s = maneuver.straight();
    const Vec2 exit = Direction(sign * (maneuver.turn_angle - maneuver.reduction));
    const double p_2 = maneuver.obstacle_sixth > 3 ? s : 2.0 / 3.0 * s;
    ExpectNear(p[1], {0.5 * p_2, 0.0}, kRounding);
    ExpectNear(p[2], {p_2, 0.0}, kRounding);
    ExpectNear(p[5], LayOut(maneuver).arc.back().position, kRounding);
    ExpectNear(p[6], p[5] + 0.5 * s * exit, kRounding);
    ExpectNear(p[7], p[5] + s * exit, kRounding);
  }
}

TEST(ControlPoints, DefaultOnesAreAsPrinted) {
  const Points p = ControlPointsFor(Literal(TurnSide::kLeft, PassingSide::kInner), 3.0);
  const std::vector<Vec2> expected{{0, 0},
                                   {7.6266, 0},
                                   {15.2533, 0.0008},
                                   {22.8799, 3},
                                   {28.5834, 12.2608},
                                   {42.0185, 14.8236},
                                   {44.9561, 25.7869},
                                   {47.8937, 36.7501}};
  for (std::size_t k = 0; k < 8; ++k) {
    SCOPED_TRACE(k);
    ExpectNear(p[k], expected[k], Printed(4));
  }
}

TEST(ControlPoints, LiteralRightTurnIsNoMirror) {
  // The published listing mirrors all control points of a right turn except P_5 (defect L9). The x
  // coordinate of P_5 is therefore wrong by cos 75 degrees = 0.2588 m.
  const Points left = ControlPointsFor(Literal(TurnSide::kLeft, PassingSide::kInner), 3.0);
  const Points right = ControlPointsFor(Literal(TurnSide::kRight, PassingSide::kInner), -3.0);
  for (std::size_t k = 0; k < 8; ++k) {
    SCOPED_TRACE(k);
    EXPECT_EQ(right[k].y(), -left[k].y());
    if (k != 5) {
      EXPECT_EQ(right[k].x(), left[k].x());
    }
  }
  EXPECT_NEAR(right[5].x() - left[5].x(), 0.2588, Tolerance(Printed(4)));
  EXPECT_NEAR(Drive(Literal(TurnSide::kLeft, PassingSide::kInner), 3.0).length, 65.0248,
              Tolerance(Printed(4)));
  TurnManeuver maneuver = Literal(TurnSide::kRight, PassingSide::kInner);
  EXPECT_NEAR(Drive(maneuver, -3.0).length, 65.0590, Tolerance(Printed(4)));
  maneuver.literal.right_shift = false;
  EXPECT_NEAR(Drive(maneuver, -3.0).length, 65.0248, Tolerance(Printed(4)));
}

TEST(TurnManeuver, RightTurnMirrorsTheLeftToTheLastBit) {
  Random random(6);
  for (int i = 0; i < 50; ++i) {
    TurnManeuver left = RandomLiteral(random);
    left.side = TurnSide::kLeft;
    left.literal = {};
    TurnManeuver right = left;
    right.side = TurnSide::kRight;
    SCOPED_TRACE(Describe(left));
    const double final_y = random.Uniform(-5.0, 5.0);
    const Points p = ControlPointsFor(left, final_y);
    const Points q = ControlPointsFor(right, -final_y);
    for (std::size_t k = 0; k < 8; ++k) {
      EXPECT_EQ(p[k].x(), q[k].x());
      EXPECT_EQ(p[k].y(), -q[k].y());
    }
    const ManeuverRun a = Drive(left, final_y, ReferenceCar());
    const ManeuverRun b = Drive(right, -final_y, ReferenceCar());
    for (std::size_t k = 0; k < a.samples.size(); ++k) {
      EXPECT_EQ(a.samples[k].steering, -b.samples[k].steering);
    }
    EXPECT_EQ(a.length, b.length);
    EXPECT_EQ(a.steering_rate_max, b.steering_rate_max);
    EXPECT_EQ(a.test_distance, b.test_distance);
    EXPECT_EQ(a.clearance, b.clearance);
  }
}

TEST(ControlPoints, NothingJumpsWhenTheReductionVanishes) {
  // A reduction of the turn's angle by 1e-9 rad rotates the exit straight about the arc's center.
  // The far end of the exit is less than r_1 + S < 43 m from the center.
  constexpr double kSmall = 1e-9;
  for (const PassingSide passing_side : {PassingSide::kInner, PassingSide::kOuter}) {
    TurnManeuver none = Literal(TurnSide::kLeft, passing_side, 0.0);
    TurnManeuver small = Literal(TurnSide::kLeft, passing_side, kSmall);
    none.literal = small.literal = {};
    const Points a = ControlPointsFor(none, 3.0);
    const Points b = ControlPointsFor(small, 3.0);
    for (std::size_t k = 0; k < 8; ++k) {
      ExpectNear(a[k], b[k], 43.0 * kSmall + kRounding);
    }
    // If the reduction of the turn's angle is zero, the control points P_5 to P_7 of the published
    // listing jump (defect L18). These points move from the end of the arc to a place beside the
    // safe point, 7 m lower for a pass on the inside. All other points agree.
    none.literal = small.literal = {.right_angle_rule = true};
    const Points c = ControlPointsFor(none, 3.0);
    const Points d = ControlPointsFor(small, 3.0);
    for (std::size_t k = 0; k < 5; ++k) {
      ExpectNear(c[k], d[k], 43.0 * kSmall + kRounding);
    }
    const double inner = SafeRadius(none, 1.725, PassingSide::kInner);
    const double jump = -inner * std::cos(kPi / 4.0);
    EXPECT_LT(jump, -6.8);
    for (std::size_t k = 5; k < 8; ++k) {
      ExpectNear(c[k], d[k] + Vec2{0.0, jump}, 43.0 * kSmall + kRounding);
    }
  }
}

// --- The curve ---------------------------------------------------------------------------------

TEST(TurnManeuver, CurveIsTheListingsOwnCheck) {
  const Points p = ControlPointsFor(Literal(TurnSide::kLeft, PassingSide::kInner), 3.0);
  const BezierCurve curve = CurveThrough(p);
  const std::array<double, 8> position{1, 7, 21, 35, 35, 21, 7, 1};
  const std::array<double, 7> velocity{7, 42, 105, 140, 105, 42, 7};
  const std::array<double, 6> acceleration{42, 210, 420, 420, 210, 42};
  for (int step = 0; step <= 500; ++step) {
    const double u = 0.002 * step;
    Vec2 b{0.0, 0.0};
    Vec2 v{0.0, 0.0};
    Vec2 a{0.0, 0.0};
    for (std::size_t i = 0; i < 8; ++i) {
      const auto k = static_cast<double>(i);
      b += position[i] * std::pow(1.0 - u, 7.0 - k) * std::pow(u, k) * p[i];
      if (i < 7) {
        v += velocity[i] * std::pow(1.0 - u, 6.0 - k) * std::pow(u, k) * (p[i + 1] - p[i]);
      }
      if (i < 6) {
        a += acceleration[i] * std::pow(1.0 - u, 5.0 - k) * std::pow(u, k) *
             (p[i + 2] - 2.0 * p[i + 1] + p[i]);
      }
    }
    ExpectNear(curve.At(u), b, kRounding);
    ExpectNear(curve.Derivative(u, 1), v, 7.0 * kRounding);
    ExpectNear(curve.Derivative(u, 2), a, 42.0 * kRounding);
  }
}

TEST(TurnManeuver, DerivativesAreThoseOfTheCurve) {
  const Points p = ControlPointsFor(Literal(TurnSide::kRight, PassingSide::kOuter), 3.0);
  const BezierCurve curve = CurveThrough(p);
  // The error of a central difference is h^2/6 times the third derivative. The third derivatives of
  // the curve's first and second derivatives are at most 210 x 8 and 840 x 16 times the largest
  // coordinate, 51 m. Rounding adds 1e-13/h.
  constexpr double kStep = 1e-5;
  for (double u = 0.02; u < 0.99; u += 0.02) {
    const Vec2 first = (curve.At(u + kStep) - curve.At(u - kStep)) / (2.0 * kStep);
    const Vec2 second =
        (curve.Derivative(u + kStep, 1) - curve.Derivative(u - kStep, 1)) / (2.0 * kStep);
    ExpectNear(first, curve.Derivative(u, 1), kStep * kStep / 6.0 * 210.0 * 8.0 * 51.0 + 1e-8);
    ExpectNear(second, curve.Derivative(u, 2), kStep * kStep / 6.0 * 840.0 * 16.0 * 51.0 + 7e-8);
  }
}

TEST(SimulateManeuver, DefaultDetailsAreAsPrinted) {
  const ManeuverRun drive = Drive(Literal(TurnSide::kLeft, PassingSide::kInner), 3.0);
  ASSERT_EQ(drive.samples.size(), 501U);
  const ManeuverSample& middle = drive.samples[250];
  EXPECT_EQ(middle.u, 0.5);
  ExpectNear(middle.pose.position(), {26.717941, 8.302342}, Printed(6));
  EXPECT_NEAR(middle.curvature, 0.01183062, Tolerance(Printed(8)));
  EXPECT_NEAR(middle.steering, 0.03193181, Tolerance(Printed(8)));
  EXPECT_NEAR(drive.samples.front().curvature, 1.193e-5, Tolerance(Printed(8)));
  ExpectNear(drive.samples.back().pose.position(), {47.893709, 36.750135}, Printed(6));
}

// --- The run ---------------------------------------------------------------------------------

/// Returns the largest steering rate between neighboring samples [rad/s], computed in the same way
/// as the printed rates.
double LargestQuotient(const ManeuverRun& drive) {
  double largest = 0.0;
  for (std::size_t i = 1; i < drive.samples.size(); ++i) {
    const ManeuverSample& a = drive.samples[i - 1];
    const ManeuverSample& b = drive.samples[i];
    largest = std::max(largest, std::abs((b.steering - a.steering) / (b.time - a.time)));
  }
  return largest;
}

TEST(SimulateManeuver, TableIsAsPrinted) {
  struct Value {
    double value;
    int decimals;
  };
  struct Row {
    const char* name;
    TurnManeuver maneuver;
    double final_y;
    Value length;
    Value duration;
    Value steering;
    Value rate;
    Value test_distance;
    double clearance;
  };
  constexpr TurnSide kLeft = TurnSide::kLeft;
  constexpr TurnSide kRight = TurnSide::kRight;
  constexpr PassingSide kInner = PassingSide::kInner;
  constexpr PassingSide kOuter = PassingSide::kOuter;
  constexpr double kDec = kPi / 12.0;
  // For V_L_1, the published listing prints a clearance of 4.59 m, computed from every second
  // sample (4.586 m). With all samples, and with four times as many samples, the clearance is
  // 4.5847 m. If the listing does not print the duration, the expected duration is a third of the
  // length.
  const auto third = [](double length) { return Value{length / 3.0, 4}; };
  // clang-format off
  const std::vector<Row> rows{
    {"left inner", Literal(kLeft, kInner), 3.0,
     {65.024760, 6}, {21.675, 3}, {0.086075, 6}, {0.0413, 4}, {7.108885, 6}, 5.86},
    {"left outer", Literal(kLeft, kOuter), -3.0,
     {75.5513, 4}, {25.184, 3}, {0.18798, 5}, {0.0529, 4}, {3.2310, 4}, 1.10},
    {"right inner", Literal(kRight, kInner), -3.0,
     {65.0590, 4}, {21.686, 3}, {0.08586, 5}, {0.0438, 4}, {7.0689, 4}, 5.82},
    {"right outer", Literal(kRight, kOuter), 3.0,
     {75.6064, 4}, {25.202, 3}, {0.18704, 5}, {0.0504, 4}, {3.3217, 4}, 1.14},
    {"left inner, no reduction", Literal(kLeft, kInner, 0.0), 3.0,
     {62.4590, 4}, {20.820, 3}, {0.13626, 5}, {0.0442, 4}, {8.7330, 4}, 5.38},
    {"left outer, no reduction", Literal(kLeft, kOuter, 0.0), -3.0,
     {73.6836, 4}, {24.561, 3}, {0.21989, 5}, {0.0470, 4}, {6.1319, 4}, 1.50},
    {"right inner, no reduction", Literal(kRight, kInner, 0.0), -3.0,
     {62.4590, 4}, {20.820, 3}, {0.13626, 5}, {0.0442, 4}, {8.7330, 4}, 5.38},
    {"right outer, no reduction", Literal(kRight, kOuter, 0.0), 3.0,
     {73.6836, 4}, {24.561, 3}, {0.21989, 5}, {0.0470, 4}, {6.1319, 4}, 1.50},
    {"left inner, V_L_1", Literal(kLeft, kInner, kDec, 1), 3.0,
     {64.8745, 4}, third(64.8745), {0.09174, 5}, {0.0522, 4}, {17.4012, 4}, 4.58},
    {"left inner, V_L_2", Literal(kLeft, kInner, kDec, 2), 3.0,
     {64.9807, 4}, third(64.9807), {0.08752, 5}, {0.0463, 4}, {11.2916, 4}, 5.57},
    {"left inner, V_L_4", Literal(kLeft, kInner, kDec, 4), 3.0,
     {65.6770, 4}, third(65.6770), {0.11954, 5}, {0.0377, 4}, {7.8554, 4}, 5.07},
    {"left inner, V_L_5", Literal(kLeft, kInner, kDec, 5), 3.0,
     {65.6050, 4}, third(65.6050), {0.11856, 5}, {0.0354, 4}, {13.3448, 4}, 4.20},
  };
  // clang-format on
  for (const Row& row : rows) {
    SCOPED_TRACE(row.name);
    const auto expect = [](double actual, const Value& printed) {
      EXPECT_NEAR(actual, printed.value, Tolerance(Printed(printed.decimals)));
    };
    const ManeuverRun drive = Drive(row.maneuver, row.final_y);
    expect(drive.length, row.length);
    expect(drive.duration, row.duration);
    expect(drive.steering_max, row.steering);
    expect(LargestQuotient(drive), row.rate);
    expect(drive.test_distance, row.test_distance);
    expect(drive.clearance, {row.clearance, 2});
    // The steering rate at a sample differs from the mean rate between two samples. The difference
    // is largest at the ends of the curve: over half of the first interval, the rate changes by 2
    // %.
    EXPECT_GE(drive.steering_rate_max, LargestQuotient(drive) * (1.0 - 1e-4));
    EXPECT_LE(drive.steering_rate_max, LargestQuotient(drive) * 1.025);
    // If the rear axle instead of the center follows the path, the clearance differs by up to 0.08
    // m.
    EXPECT_NEAR(Drive(row.maneuver, row.final_y, ReferenceCar()).clearance, drive.clearance,
                Tolerance(0.08 + Printed(2)));
    // The listing's test point is free in all rows. On the outer side, the footprint nevertheless
    // comes too close to the obstacle.
    EXPECT_TRUE(drive.test_passed);
    EXPECT_TRUE(drive.steerable);
    EXPECT_EQ(drive.keeps_clear, row.maneuver.passing_side() == kInner);
    EXPECT_EQ(drive.ok(), row.maneuver.passing_side() == kInner);
  }
}

TEST(SimulateManeuver, OuterRingComesAsCloseAsPrinted) {
  const TurnManeuver maneuver = Literal(TurnSide::kLeft, PassingSide::kOuter);
  EXPECT_NEAR(Drive(maneuver, 0.0).clearance, 0.60, Tolerance(Printed(2)));
  EXPECT_NEAR(Drive(maneuver, -2.0).clearance, 0.94, Tolerance(Printed(2)));
  EXPECT_NEAR(Drive(maneuver, -5.0).clearance, 1.41, Tolerance(Printed(2)));
  // The published listing prints a clearance of 0.78 m, computed from every fourth sample (0.7755
  // m). An independent script that computes the distance between the sides of the footprints finds
  // 0.77413, 0.77400 and 0.77390 m with 101, 501 and 4001 samples.
  EXPECT_NEAR(Drive(maneuver, -1.0).clearance, 0.77400, Tolerance(Printed(5)));
}

TEST(SimulateManeuver, CenterLineComesAsCloseAsPrinted) {
  const TurnManeuver maneuver = Literal(TurnSide::kLeft, PassingSide::kOuter, 0.0);
  const TurnLayout layout = LayOut(maneuver);
  double nearest = std::numeric_limits<double>::infinity();
  for (const ManeuverSample& sample : Drive(maneuver, -3.0).samples) {
    const Vec2 p = sample.pose.position();
    nearest = std::min(nearest, Distance(p, p, layout.obstacle));
  }
  EXPECT_NEAR(nearest, 2.3606, Tolerance(Printed(4)));
}

TEST(SimulateManeuver, HeightFromTheSearchShortensTheInnerWay) {
  const TurnManeuver maneuver = Literal(TurnSide::kLeft, PassingSide::kInner);
  EXPECT_NEAR(Drive(maneuver, 0.0).length, 65.44, Tolerance(Printed(2)));
  EXPECT_NEAR(Drive(maneuver, 5.0).length, 64.78, Tolerance(Printed(2)));
}

TEST(SimulateManeuver, ListingsSteeringIsTooSmallByTheFactorPrinted) {
  // The published listing computes atan(L)/R in place of atan(L/R) (defect L1).
  EXPECT_NEAR(std::atan(2.7), 1.2161, Tolerance(Printed(4)));
  EXPECT_NEAR(std::atan(2.7) / 2.7, 0.450, Tolerance(Printed(3)));
  const ManeuverRun drive = Drive(Literal(TurnSide::kLeft, PassingSide::kInner), 3.0);
  double largest = 0.0;
  for (const ManeuverSample& sample : drive.samples) {
    const double listing = std::atan(2.7) * sample.curvature;
    largest = std::max(largest, std::abs(listing));
    // The series atan x = x (1 - x^2/3 + ...) with x <= 0.0863 shows that the factor is accurate to
    // 0.25 %.
    EXPECT_NEAR(listing, std::atan(2.7) / 2.7 * sample.steering,
                std::abs(listing) * 0.0025 + Tolerance(kRounding));
    EXPECT_NEAR(std::tan(sample.steering), 2.7 * sample.curvature, Tolerance(kRounding));
  }
  EXPECT_NEAR(largest, 0.038865, Tolerance(Printed(6)));
}

TEST(SimulateManeuver, SamplesCountChordsAtConstantSpeed) {
  TurnManeuver maneuver;
  maneuver.speed = 2.0;
  const TurnLayout layout = LayOut(maneuver);
  const BezierCurve curve = CurveThrough(ControlPoints(maneuver, layout, ReferenceCar(), 2.0));
  const ManeuverRun drive = SimulateManeuver(maneuver, layout, ReferenceCar(), curve);
  EXPECT_EQ(drive.samples.front().s, 0.0);
  double s = 0.0;
  for (std::size_t i = 1; i < drive.samples.size(); ++i) {
    const ManeuverSample& sample = drive.samples[i];
    EXPECT_NEAR(sample.u, 0.002 * static_cast<double>(i), Tolerance(kRounding));
    s += (curve.At(sample.u) - curve.At(drive.samples[i - 1].u)).norm();
    EXPECT_NEAR(sample.s, s, Tolerance(100.0 * kRounding));
    EXPECT_NEAR(sample.time, s / 2.0, Tolerance(100.0 * kRounding));
  }
  EXPECT_EQ(drive.length, drive.samples.back().s);
  EXPECT_EQ(drive.duration, drive.length / 2.0);
  // The samples are 0.2 m apart, and the radius of curvature is above 20 m. The chords are
  // therefore shorter than the curve by at most (0.2/20)^2/24 = 4e-6 of its length.
  EXPECT_LT(drive.length, curve.Length());
  EXPECT_NEAR(drive.length, curve.Length(), Tolerance(4e-6 * drive.length));
}

TEST(SimulateManeuver, TestPointIsTwoSamplesBeforeTheStation) {
  for (int n = 1; n <= 5; ++n) {
    const ManeuverRun drive = Drive(Literal(TurnSide::kLeft, PassingSide::kInner, 0.2, n), 3.0);
    // The indices of the published listing count from 1. The listing's value B_sum(m) is the
    // distance s of sample m + 1, and its test point is P(m - 1).
    std::size_t m = 1;
    while (drive.samples[m].s < n / 6.0 * drive.length - 2.0) {
      ++m;
    }
    EXPECT_EQ(drive.test_point, drive.samples[m - 2].pose.position());
    EXPECT_EQ(drive.test_distance, (drive.test_point - drive.test_corner).norm());
  }
}

TEST(SimulateManeuver, TestCornerIsTheListings) {
  const auto corner = [](TurnSide side, PassingSide passing_side) {
    const TurnManeuver maneuver = Literal(side, passing_side);
    const Vec2 lowest = LayOut(maneuver).obstacle.Corners()[2];
    return Vec2(Drive(maneuver, 0.0).test_corner - lowest);
  };
  ExpectNear(corner(TurnSide::kLeft, PassingSide::kInner), {0.0, 2.0}, kRounding);
  ExpectNear(corner(TurnSide::kLeft, PassingSide::kOuter), {2.0, 0.0}, kRounding);
  ExpectNear(corner(TurnSide::kRight, PassingSide::kInner), {0.0, 0.0}, kRounding);
  ExpectNear(corner(TurnSide::kRight, PassingSide::kOuter), {2.0, 2.0}, kRounding);
}

TEST(SimulateManeuver, AcceptsFromTheSafeDistanceOn) {
  // The limit of the test point's distance is SD + w_a/2, with w_a/2 = 0.8625 m, and the limit of
  // the footprint's clearance is SD. The test checks values just below and above both limits.
  const TurnManeuver base = Literal(TurnSide::kLeft, PassingSide::kOuter);
  const TurnLayout layout = LayOut(base);
  const BezierCurve curve = CurveThrough(ControlPoints(base, layout, ReferenceCar(), -3.0));
  const auto drive_with = [&](double safe_distance) {
    TurnManeuver maneuver = base;
    maneuver.safe_distance = safe_distance;
    return SimulateManeuver(maneuver, layout, ReferenceCar(), curve);
  };
  const ManeuverRun drive = drive_with(1.5);
  EXPECT_TRUE(drive_with(drive.test_distance - 0.8625 - kRounding).test_passed);
  EXPECT_FALSE(drive_with(drive.test_distance - 0.8625 + kRounding).test_passed);
  EXPECT_TRUE(drive_with(drive.clearance).keeps_clear);
  EXPECT_FALSE(drive_with(std::nextafter(drive.clearance, 2.0)).keeps_clear);
  EXPECT_TRUE(drive_with(1.0).ok());
}

TEST(SimulateManeuver, KnowsTheLimitsOfTheSteering) {
  const TurnManeuver maneuver;
  const TurnLayout layout = LayOut(maneuver);
  const BezierCurve curve = CurveThrough(ControlPoints(maneuver, layout, ReferenceCar(), 3.0));
  const ManeuverRun drive = SimulateManeuver(maneuver, layout, ReferenceCar(), curve);
  const auto steerable = [&](double limit, double rate) {
    VehicleParams car = ReferenceCar();
    car.steering_limit = limit;
    car.steering_rate = rate;
    return SimulateManeuver(maneuver, layout, car, curve).steerable;
  };
  EXPECT_TRUE(steerable(drive.steering_max, drive.steering_rate_max));
  EXPECT_FALSE(steerable(0.999 * drive.steering_max, drive.steering_rate_max));
  EXPECT_FALSE(steerable(drive.steering_max, 0.999 * drive.steering_rate_max));
  // The first two control points coincide, so the curve has no direction at its start.
  const BezierCurve stuck({{0.0, 0.0}, {0.0, 0.0}, {10.0, 1.0}, {20.0, 0.0}});
  EXPECT_FALSE(SimulateManeuver(maneuver, layout, ReferenceCar(), stuck).steerable);
}

TEST(SimulateManeuver, ClearanceIsThatOfTheCarOnItsRearAxle) {
  const TurnManeuver maneuver = Literal(TurnSide::kLeft, PassingSide::kInner, kPi / 12.0, 1);
  const TurnLayout layout = LayOut(maneuver);
  const BezierCurve curve = CurveThrough(ControlPoints(maneuver, layout, ReferenceCar(), 3.0));
  const World world{.obstacles = {{.footprint = layout.obstacle}}};
  const ManeuverRun drive = SimulateManeuver(maneuver, layout, ReferenceCar(), curve);
  double smallest = std::numeric_limits<double>::infinity();
  for (const ManeuverSample& sample : drive.samples) {
    smallest = std::min(smallest, Clearance(world, ReferenceCar(), sample.pose, 0.0).value());
  }
  EXPECT_EQ(drive.clearance, smallest);
  EXPECT_LT(drive.clearance,
            SimulateManeuver(maneuver, layout, CenteredCar(), curve).clearance - 0.05);
}

TEST(SimulateManeuver, DrivingThroughTheObstacleLeavesNoClearance) {
  const TurnManeuver maneuver;
  const TurnLayout layout = LayOut(maneuver);
  const BezierCurve through({{0.0, 0.0}, layout.obstacle.center.position()});
  const ManeuverRun drive = SimulateManeuver(maneuver, layout, ReferenceCar(), through);
  EXPECT_EQ(drive.clearance, 0.0);
  EXPECT_FALSE(drive.keeps_clear);
}

// --- The listing's search ----------------------------------------------------------------------

TEST(LiteralRrtStar, SpreadIsAsPrinted) {
  struct Row {
    TurnSide side;
    PassingSide passing_side;
    double median;
    double low;   // The 5 % quantile.
    double high;  // The 95 % quantile.
    double nearest;
  };
  const std::vector<Row> rows{{TurnSide::kLeft, PassingSide::kInner, 1.05, 0.38, 1.98, 20.7},
                              {TurnSide::kLeft, PassingSide::kOuter, -1.72, -2.67, -1.00, 41.9},
                              // A right turn exchanges the roles of inside and outside. The listing
                              // does not print the nearest distance, because rounding down moves
                              // the inner safe point of a right turn away.
                              {TurnSide::kRight, PassingSide::kInner, -1.72, -2.67, -1.00, 0.0},
                              {TurnSide::kRight, PassingSide::kOuter, 1.05, 0.38, 1.98, 0.0}};
  constexpr int kSeeds = 2000;
  for (const Row& row : rows) {
    const TurnManeuver maneuver = Literal(row.side, row.passing_side);
    const TurnLayout layout = LayOut(maneuver);
    std::vector<double> heights;
    double nearest = std::numeric_limits<double>::infinity();
    for (int seed = 0; seed < kSeeds; ++seed) {
      const LiteralTree tree = LiteralRrtStar(maneuver, layout, static_cast<std::uint64_t>(seed));
      heights.push_back(tree.final_y);
      nearest = std::min(nearest, tree.goal_distance);
    }
    // The published listing prints quantiles of 2000 other random draws. Among our n draws, the
    // rank of a printed quantile p has a standard deviation of sqrt(2 n p (1 - p)). The test allows
    // four standard deviations, and half a unit in the last printed digit.
    const auto expect_quantile = [&](double p, double printed) {
      const double spread = Tolerance(4.0 * std::sqrt(2.0 * kSeeds * p * (1.0 - p)));
      const double half = Printed(2);
      const auto below = std::count_if(heights.begin(), heights.end(),
                                       [&](double y) { return y < printed - half; });
      const auto up_to = std::count_if(heights.begin(), heights.end(),
                                       [&](double y) { return y <= printed + half; });
      EXPECT_LE(static_cast<double>(below), p * kSeeds + spread) << p;
      EXPECT_GE(static_cast<double>(up_to), p * kSeeds - spread) << p;
    };
    expect_quantile(0.5, row.median);
    expect_quantile(0.05, row.low);
    expect_quantile(0.95, row.high);
    // The printed smallest distance is that of 2000 draws. The smallest distance of 200 000 draws
    // is 20.55 m and 41.83 m.
    EXPECT_GE(nearest, row.nearest - Tolerance(Printed(1)));
    // Eleven steps of 1 m cannot reach a safe point.
    EXPECT_GE(nearest, layout.safe_point.norm() - 11.0 - Tolerance(kRounding));
  }
}

TEST(LiteralRrtStar, GrowsByStepsFromTheNearestNode) {
  Random random(7);
  std::size_t nodes = 0;
  for (int i = 0; i < 200; ++i) {
    TurnManeuver maneuver = RandomLiteral(random);
    maneuver.literal = {};
    SCOPED_TRACE(Describe(maneuver));
    const TurnLayout layout = LayOut(maneuver);
    const LiteralTree tree = LiteralRrtStar(maneuver, layout, static_cast<std::uint64_t>(i));
    const auto most = static_cast<std::size_t>(std::floor(0.5 * maneuver.straight()));
    ASSERT_LE(tree.nodes.size(), most + 1);
    nodes += tree.nodes.size();
    EXPECT_EQ(tree.nodes[0].position, Vec2(0.0, 0.0));
    const bool up =
        (maneuver.side == TurnSide::kLeft) == (maneuver.passing_side() == PassingSide::kInner);
    for (std::size_t k = 1; k < tree.nodes.size(); ++k) {
      const TreeNode& node = tree.nodes[k];
      // All samples lie on one side of the start, and so does the whole tree.
      EXPECT_GE(up ? node.position.y() : -node.position.y(), -Tolerance(kRounding));
      double nearest = std::numeric_limits<double>::infinity();
      double cheapest = std::numeric_limits<double>::infinity();
      for (std::size_t j = 0; j < k; ++j) {
        const double length = (tree.nodes[j].position - node.position).norm();
        nearest = std::min(nearest, length);
        if (length <= 10.0 &&
            Distance(tree.nodes[j].position, node.position, layout.obstacle) > 0.0) {
          cheapest = std::min(cheapest, tree.nodes[j].cost + length);
        }
      }
      EXPECT_LE(nearest, 1.0 + Tolerance(kRounding));
      // The parent of a node is the nearest node: the node nearest to the sample is also nearest to
      // all points on the line to the sample. Nodes may coincide.
      bool by_nearest = false;
      for (std::size_t j = 0; j < k; ++j) {
        const double length = (tree.nodes[j].position - node.position).norm();
        by_nearest = by_nearest || (length <= nearest + kRounding &&
                                    std::abs(node.cost - tree.nodes[j].cost - length) <= kRounding);
      }
      EXPECT_TRUE(by_nearest);
      ASSERT_LT(node.parent, k);
      const double by_parent =
          tree.nodes[node.parent].cost + (tree.nodes[node.parent].position - node.position).norm();
      EXPECT_LE(by_parent, node.cost + Tolerance(kRounding));
      EXPECT_NEAR(by_parent, std::min(cheapest, node.cost), Tolerance(kRounding));
    }
    for (const TreeNode& node : tree.nodes) {
      EXPECT_LE(tree.goal_distance, (node.position - layout.safe_point).norm());
    }
    EXPECT_EQ(tree.final_y, tree.nodes[tree.final_node].position.y());
  }
  EXPECT_GT(nodes, 200U * 15U);
}

TEST(LiteralRrtStar, CrossesNoSideOfTheObstacle) {
  const TurnManeuver maneuver;
  TurnLayout layout = LayOut(maneuver);
  const auto grow = [&](const OrientedBox& obstacle) {
    layout.obstacle = obstacle;
    std::size_t nodes = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      const LiteralTree tree = LiteralRrtStar(maneuver, layout, seed);
      nodes += tree.nodes.size();
      for (std::size_t k = 1; k < tree.nodes.size(); ++k) {
        const TreeNode& node = tree.nodes[k];
        EXPECT_GT(Distance(tree.nodes[node.parent].position, node.position, obstacle), 0.0);
      }
    }
    return nodes;
  };
  // A wall within reach of the tree blocks samples. A tiny obstacle at the same place blocks none.
  EXPECT_EQ(grow({{12.0, 6.5, 0.0}, 0.01, 0.01}), 200U * 12U);
  EXPECT_LT(grow({{12.0, 6.5, 0.3}, 18.0, 3.0}), 200U * 10U);
}

TEST(LiteralRrtStar, CountsALineWithinTheObstacleAsFree) {
  // All samples are inside this obstacle. The published listing treats a line inside an obstacle as
  // free (defect L13).
  const TurnManeuver maneuver;
  TurnLayout layout = LayOut(maneuver);
  layout.obstacle.length = layout.obstacle.width = 200.0;
  EXPECT_EQ(LiteralRrtStar(maneuver, layout, 1).nodes.size(), 12U);
}

TEST(LiteralRrtStar, SeedSaysEverything) {
  const TurnManeuver maneuver;
  const TurnLayout layout = LayOut(maneuver);
  const LiteralTree a = LiteralRrtStar(maneuver, layout, 4);
  const LiteralTree b = LiteralRrtStar(maneuver, layout, 4);
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (std::size_t k = 0; k < a.nodes.size(); ++k) {
    EXPECT_EQ(a.nodes[k].position, b.nodes[k].position);
  }
  EXPECT_NE(a.final_y, LiteralRrtStar(maneuver, layout, 5).final_y);
}

// --- In the world ------------------------------------------------------------------------------

TEST(ManeuverFrame, PutsTheArcWhereTheTurnBegins) {
  Random random(8);
  for (int i = 0; i < 50; ++i) {
    TurnManeuver maneuver = RandomLiteral(random);
    maneuver.literal = {};
    SCOPED_TRACE(Describe(maneuver));
    const Pose2 X_WA{random.Uniform(-50.0, 50.0), random.Uniform(-50.0, 50.0),
                     random.Uniform(-kPi, kPi)};
    const Pose2 X_WM = ManeuverFrame(maneuver, X_WA);
    EXPECT_EQ(X_WM.yaw, X_WA.yaw);
    const TurnLayout layout = LayOut(maneuver);
    ExpectNear(ToWorld(X_WM, layout.arc.front().position), X_WA.position(), kRounding);
  }
}

}  // namespace
}  // namespace trackbed
