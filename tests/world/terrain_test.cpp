#include "trackbed/world/terrain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/tolerance.h"
#include "trackbed/core/error.h"
#include "trackbed/world/road.h"

namespace trackbed {
namespace {

// Rounding error of a few hundred operations on numbers below 100.
constexpr double kTerrainRounding = 1e-11;

Terrain::Size FourByThree() {
  return {.low = {-64.0, 32.0}, .columns = 4, .rows = 3, .base = 2.0};
}

std::vector<double> CoarseHeights(const Terrain::Size& size) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> height(0.0, 5.0);
  std::vector<double> heights(static_cast<std::size_t>(size.CoarseColumns() * size.CoarseRows()));
  for (double& one : heights) {
    one = height(random);
  }
  return heights;
}

/// Returns a terrain with a hump that covers parts of two blocks. The hump's height and slope are 0
/// at the outer borders of these blocks.
Terrain WithHump() {
  const Terrain::Size size = FourByThree();
  Terrain terrain(size, CoarseHeights(size));
  const auto hump = [](const Vec2& p, double) {
    const double r = (p - Vec2(0.0, 80.0)).norm() / 14.0;
    return r < 1.0 ? std::pow(std::cos(0.5 * 3.14159 * r), 4) : 0.0;
  };
  terrain.Refine(1, 1, hump);
  terrain.Refine(2, 1, hump);
  terrain.Refine(0, 0, hump);  // The hump is zero in this block.
  return terrain;
}

TEST(Terrain, IsLevelAroundItsRectangle) {
  const Terrain terrain = WithHump();
  for (const Vec2& p :
       {Vec2(-65.0, 60.0), Vec2(65.0, 60.0), Vec2(0.0, 31.0), Vec2(0.0, 129.0), Vec2(1e30, 0.0),
        Vec2(std::nan(""), 60.0), Vec2(0.0, std::numeric_limits<double>::infinity())}) {
    EXPECT_EQ(terrain.At(p).height, 2.0);
    EXPECT_EQ(terrain.At(p).slope, Vec2(0.0, 0.0));
  }
  // At the border of the rectangle, the height and the slope match those of the level ground
  // outside.
  EXPECT_NEAR(terrain.At({-64.0, 60.0}).height, 2.0, Tolerance(kTerrainRounding));
  EXPECT_NEAR(terrain.At({64.0, 60.0}).slope.norm(), 0.0, Tolerance(kTerrainRounding));
  EXPECT_TRUE(terrain.IsRefined(1, 1) && terrain.IsRefined(2, 1));
  EXPECT_FALSE(terrain.IsRefined(0, 0) || terrain.IsRefined(0, 1));
}

TEST(Terrain, HasNoStepsAndNoKinksAtTheBordersOfBlocksAndCells) {
  const Terrain terrain = WithHump();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> along(-64.0, 64.0);
  for (int i = 0; i < 2000; ++i) {
    // The points lie on both sides of the border of a block, of a coarse cell or of a fine cell.
    const double cell = i % 3 == 0 ? 32.0 : i % 3 == 1 ? 8.0 : 0.5;
    const double line = cell * std::round(along(random) / cell);
    const double other = along(random);
    constexpr double kSide = 1e-9;
    for (const auto& [a, b] :
         {std::pair(Vec2(line - kSide, 80.0 + 0.5 * other), Vec2(line + kSide, 80.0 + 0.5 * other)),
          std::pair(Vec2(other, 96.0 + line - kSide), Vec2(other, 96.0 + line + kSide))}) {
      const Terrain::Point one = terrain.At(a);
      const Terrain::Point two = terrain.At(b);
      // The points of a pair are 2 kSide apart. The slope is below 2, so the heights differ by less
      // than 4 kSide. The second derivatives are below 2 1/m, so the slopes differ by less than 4
      // kSide.
      EXPECT_NEAR(one.height, two.height, Tolerance(4.0 * kSide + kTerrainRounding));
      EXPECT_NEAR((one.slope - two.slope).norm(), 0.0, Tolerance(4.0 * kSide + kTerrainRounding));
    }
  }
}

TEST(Terrain, HasTheSlopeOfItsHeight) {
  const Terrain terrain = WithHump();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> x(-70.0, 70.0);
  std::uniform_real_distribution<double> y(25.0, 135.0);
  for (int i = 0; i < 2000; ++i) {
    const Vec2 p(x(random), y(random));
    constexpr double kStep = 1e-5;
    const Vec2 slope(
        (terrain.At(p + Vec2(kStep, 0)).height - terrain.At(p - Vec2(kStep, 0)).height),
        (terrain.At(p + Vec2(0, kStep)).height - terrain.At(p - Vec2(0, kStep)).height));
    // At the border between two cells, the second derivative jumps by at most 5 1/m. Half of this
    // jump times kStep is an error of 2.5e-5 in the slope of a central difference.
    EXPECT_NEAR((terrain.At(p).slope - slope / (2.0 * kStep)).norm(), 0.0, Tolerance(5e-5));
  }
}

TEST(Terrain, IsExactForQuadraticDifferences) {
  const Terrain::Size size = FourByThree();
  const auto count = static_cast<std::size_t>(size.CoarseColumns() * size.CoarseRows());
  Terrain terrain(size, std::vector<double>(count, size.base));
  const auto quadratic = [](const Vec2& p) {
    return 0.3 - 0.02 * p.x() + 0.05 * p.y() + 0.01 * p.x() * p.x() - 0.004 * p.x() * p.y() +
           0.002 * p.y() * p.y();
  };
  terrain.Refine(2, 1, [&](const Vec2& p, double coarse) {
    EXPECT_NEAR(coarse, size.base, kTerrainRounding);
    return quadratic(p);
  });
  std::mt19937 random(11);
  std::uniform_real_distribution<double> in(0.0, 32.0);
  for (int i = 0; i < 1000; ++i) {
    const Vec2 p(in(random), 64.0 + in(random));
    EXPECT_NEAR(terrain.At(p).height, size.base + quadratic(p), Tolerance(kTerrainRounding));
    EXPECT_NEAR(terrain.At(p).slope.x(), -0.02 + 0.02 * p.x() - 0.004 * p.y(),
                Tolerance(kTerrainRounding));
  }
}

TEST(Terrain, NeedsAHeightForEachCornerOfItsCells) {
  EXPECT_THROW(Terrain(FourByThree(), std::vector<double>(3)), InternalError);
}

TEST(Ground, OfATerrainIsThatAlone) {
  Ground ground;
  ground.terrain = std::make_shared<const Terrain>(WithHump());
  EXPECT_FALSE(IsFlat(ground) || IsPlane(ground));
  const Vec2 p(3.0, 81.0);
  EXPECT_EQ(GroundHeight(ground, p), ground.terrain->At(p).height);
  EXPECT_EQ(GroundSlope(ground, p), ground.terrain->At(p).slope);
}

}  // namespace
}  // namespace trackbed
