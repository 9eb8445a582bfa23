#include "trackbed/world/road.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/world/world.h"

namespace trackbed {
namespace {

// Rounding error of a few operations on numbers below 100.
constexpr double kRounding = 1e-13;

const Bump kBump{.area = {{10.0, 0.0, 0.0}, 4.0, 6.0}, .height = 0.1, .edge = 0.5};
const Superelevation kStretch{
    .area = {{0.0, 0.0, 0.0}, 60.0, 8.0}, .slope = 0.05, .transition_length = 10.0};

/// Returns ground with a grade, two bumps and two side slopes. One bump and one side slope are
/// rotated.
Ground Hilly() {
  Ground ground;
  ground.grade = {0.03, -0.02};
  ground.bumps = {kBump, {.area = {{-20.0, 9.0, 0.7}, 6.0, 3.0}, .height = 0.3, .edge = 9.0}};
  ground.side_slopes = {
      kStretch,
      {.area = {{5.0, -40.0, -2.0}, 30.0, 10.0}, .slope = -0.1, .transition_length = 99.0}};
  return ground;
}

TEST(RoadFactor, IsThatOfTheLastPatchOnThePoint) {
  World world{.friction = 0.9};
  EXPECT_EQ(RoadFactor(world, {3.0, 4.0}), 0.9);
  world.friction_patches = {{{{0.0, 0.0, 0.0}, 20.0, 4.0}, 0.5},
                            {{{5.0, 0.0, 0.0}, 4.0, 8.0}, 0.1}};
  EXPECT_EQ(RoadFactor(world, {-9.0, 1.9}), 0.5);
  EXPECT_EQ(RoadFactor(world, {5.0, 0.0}), 0.1);   // The point is in both patches.
  EXPECT_EQ(RoadFactor(world, {5.0, 3.9}), 0.1);   // The point is only in the second patch.
  EXPECT_EQ(RoadFactor(world, {-9.0, 2.1}), 0.9);  // The point is in neither patch.
  EXPECT_EQ(RoadFactor(world, {10.0, 2.0}), 0.5);  // A patch includes its border.
  std::swap(world.friction_patches[0], world.friction_patches[1]);
  EXPECT_EQ(RoadFactor(world, {5.0, 0.0}), 0.5);
}

TEST(RoadFactor, PatchesLieAlongTheirYaw) {
  // A road to the north with split friction: its left half is slippery.
  const World world{.friction_patches = {{{{-1.0, 50.0, kPi / 2.0}, 100.0, 2.0}, 0.2}}};
  EXPECT_EQ(RoadFactor(world, {-0.1, 99.0}), 0.2);
  EXPECT_EQ(RoadFactor(world, {-1.9, 1.0}), 0.2);
  EXPECT_EQ(RoadFactor(world, {0.1, 50.0}), 1.0);
  EXPECT_EQ(RoadFactor(world, {-1.0, 101.0}), 1.0);
}

TEST(GroundHeight, OfAGradeIsRiseOverRun) {
  Ground ground;
  EXPECT_TRUE(IsFlat(ground));
  EXPECT_EQ(GroundHeight(ground, {5.0, 6.0}), 0.0);
  ground.grade = {0.1, -0.05};
  EXPECT_FALSE(IsFlat(ground));
  EXPECT_NEAR(GroundHeight(ground, {30.0, 20.0}), 3.0 - 1.0, Tolerance(kRounding));
  const Eigen::Vector3d expected(-0.1, 0.05, 1.0);
  EXPECT_NEAR((GroundNormal(ground, {30.0, 20.0}) - expected / expected.norm()).norm(), 0.0,
              Tolerance(kRounding));
}

TEST(GroundHeight, OfABumpIsACosineSquaredAlongTheWay) {
  const Ground ground{.bumps = {kBump}};
  for (int i = 0; i <= 40; ++i) {
    const double x = 8.0 + 0.1 * i;
    // The bump's profile is cos^2(pi u/L) = (1 + cos(2 pi u/L))/2, where u is the distance from the
    // middle of the bump and L is its length.
    const double expected = 0.1 * 0.5 * (1.0 + std::cos(2.0 * kPi * (x - 10.0) / 4.0));
    for (const double y : {-2.5, 0.0, 2.4}) {
      EXPECT_NEAR(GroundHeight(ground, {x, y}), expected, Tolerance(kRounding)) << x << ", " << y;
    }
    // Halfway down the side of the bump, the height is half of the bump's height.
    EXPECT_NEAR(GroundHeight(ground, {x, 2.75}), 0.5 * expected, Tolerance(kRounding)) << x;
    EXPECT_EQ(GroundHeight(ground, {x, -3.0}), 0.0);
  }
  EXPECT_EQ(GroundHeight(ground, {7.9, 0.0}), 0.0);
  EXPECT_EQ(GroundHeight(ground, {12.1, 0.0}), 0.0);
}

TEST(GroundHeight, OfASideSlopeRisesFromItsLowerEdgeAndComesDownBehindTheOther) {
  for (const double sign : {1.0, -1.0}) {
    Superelevation stretch = kStretch;
    stretch.slope *= sign;
    const Ground ground{.side_slopes = {stretch}};
    const auto height = [&](double x, double left) {
      return GroundHeight(ground, {x, sign * left});
    };
    EXPECT_NEAR(height(0.0, -4.0), 0.0, Tolerance(kRounding));
    EXPECT_NEAR(height(0.0, -1.0), 0.05 * 3.0, Tolerance(kRounding));
    EXPECT_NEAR(height(19.0, 4.0), 0.05 * 8.0, Tolerance(kRounding));
    EXPECT_NEAR(height(0.0, 8.0), 0.5 * 0.05 * 8.0, Tolerance(kRounding));  // Halfway down the
                                                                            // falling side, the
                                                                            // height is half of the
                                                                            // full height 0.05 x 8
                                                                            // m.
    EXPECT_EQ(height(0.0, 12.0), 0.0);
    EXPECT_EQ(height(0.0, -4.1), 0.0);
    EXPECT_NEAR(height(25.0, 0.0), 0.5 * 0.05 * 4.0, Tolerance(kRounding));  // Halfway through the
                                                                             // transition, the
                                                                             // slope is half of the
                                                                             // full slope.
    EXPECT_EQ(height(-30.0, 0.0), 0.0);
  }
}

TEST(GroundHeight, WhereFeaturesMeetTheHighestCounts) {
  Bump higher = kBump;
  higher.height = 0.2;
  for (const auto& bumps : {std::vector{kBump, higher}, std::vector{higher, kBump}}) {
    EXPECT_NEAR(GroundHeight(Ground{.bumps = bumps}, {10.0, 0.0}), 0.2, Tolerance(kRounding));
  }
  EXPECT_NEAR(GroundHeight(Ground{.grade = {0.1, 0.0}, .bumps = {kBump}}, {10.0, 0.0}), 1.0 + 0.1,
              Tolerance(kRounding));
}

TEST(GroundHeight, OfRandomPointsIsWithinWhatFeaturesRise) {
  const Ground ground = Hilly();
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const Vec2 p(random.Uniform(-60.0, 60.0), random.Uniform(-60.0, 60.0));
    double highest = 0.0;
    const auto look = [&](const auto& features) {
      for (const auto& feature : features) {
        const double rise = Rise(feature, p);
        EXPECT_GE(rise, 0.0);
        if (!Contains(Extent(feature), p)) {
          EXPECT_EQ(rise, 0.0) << p.transpose();
        }
        highest = std::max(highest, rise);
      }
    };
    look(ground.bumps);
    look(ground.side_slopes);
    EXPECT_NEAR(GroundHeight(ground, p), ground.grade.dot(p) + highest, Tolerance(kRounding));
  }
}

TEST(GroundSlope, IsThatOfFiniteDifferences) {
  const Ground ground = Hilly();
  Random random(2);
  const double step = 1e-5;
  // The third derivative of the height on the sides of the bumps is below 10 1/m^2, so central
  // differences have an error below 10 step^2/6 = 2e-10. Rounding of heights below 10 m adds an
  // error of 1e-15/step = 1e-10. The tolerance of 1e-9 exceeds the sum of both.
  const double tolerance = Tolerance(1e-9);
  int on_features = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vec2 p(random.Uniform(-40.0, 40.0), random.Uniform(-60.0, 20.0));
    const auto difference = [&](const Vec2& way) {
      return (GroundHeight(ground, p + step * way) - GroundHeight(ground, p - step * way)) /
             (2.0 * step);
    };
    const Vec2 expected(difference(Vec2::UnitX()), difference(Vec2::UnitY()));
    const Vec2 slope = GroundSlope(ground, p);
    on_features += slope == ground.grade ? 0 : 1;
    EXPECT_NEAR((slope - expected).norm(), 0.0, tolerance) << p.transpose();
    // The normal is perpendicular to both tangents of the ground.
    const Eigen::Vector3d normal = GroundNormal(ground, p);
    EXPECT_NEAR(normal.norm(), 1.0, Tolerance(kRounding));
    EXPECT_GT(normal.z(), 0.0);
    EXPECT_NEAR(normal.dot(Eigen::Vector3d(1.0, 0.0, slope.x())), 0.0, Tolerance(kRounding));
    EXPECT_NEAR(normal.dot(Eigen::Vector3d(0.0, 1.0, slope.y())), 0.0, Tolerance(kRounding));
  }
  EXPECT_GT(on_features, 500);
}

TEST(GroundHeight, TurnsWithItsFeatures) {
  const Pose2 turn{3.0, -7.0, 1.1};
  Bump turned = kBump;
  turned.area.center = Compose(turn, kBump.area.center);
  Superelevation turned_stretch = kStretch;
  turned_stretch.area.center = Compose(turn, kStretch.area.center);
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    const Vec2 p(random.Uniform(-30.0, 30.0), random.Uniform(-12.0, 12.0));
    EXPECT_NEAR(Rise(turned, ToWorld(turn, p)), Rise(kBump, p), Tolerance(kRounding));
    EXPECT_NEAR(Rise(turned_stretch, ToWorld(turn, p)), Rise(kStretch, p), Tolerance(kRounding));
  }
}

}  // namespace
}  // namespace trackbed
