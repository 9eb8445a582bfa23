#include "trackbed/world/wind.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/world/world.h"

namespace trackbed {
namespace {

TEST(WindAt, IsTheSameEverywhereWithoutGusts) {
  EXPECT_TRUE(IsCalm({}));
  EXPECT_EQ(WindAt(Wind{}, {1.0, 2.0}, 3.0), Vec2(0.0, 0.0));
  const World world{.wind = {.velocity = {3.0, -4.0}}};
  EXPECT_FALSE(IsCalm(world.wind));
  EXPECT_EQ(WindAt(world, {1.0, 2.0}, 3.0), Vec2(3.0, -4.0));
  EXPECT_EQ(WindAt(world, {-100.0, 2.0}, 50.0), Vec2(3.0, -4.0));
}

TEST(GustStrength, OfOneMinusCosineRisesToOneAtHalfTime) {
  const Gust gust{.velocity = {0.0, 10.0}, .from = 5.0, .duration = 4.0};
  EXPECT_EQ(GustStrength(gust, 4.999), 0.0);
  EXPECT_NEAR(GustStrength(gust, 5.0), 0.0, Tolerance(1e-15));
  EXPECT_NEAR(GustStrength(gust, 6.0), 0.5, Tolerance(1e-15));
  EXPECT_NEAR(GustStrength(gust, 7.0), 1.0, Tolerance(1e-15));
  EXPECT_NEAR(GustStrength(gust, 8.0), 0.5, Tolerance(1e-15));
  EXPECT_NEAR(GustStrength(gust, 9.0), 0.0, Tolerance(1e-15));
  EXPECT_EQ(GustStrength(gust, 9.001), 0.0);
}

TEST(GustStrength, OfAStepIsOneFromItsFirstMomentToItsLast) {
  Gust gust{.from = 5.0, .duration = 4.0, .shape = GustShape::kStep};
  EXPECT_EQ(GustStrength(gust, 4.999), 0.0);
  EXPECT_EQ(GustStrength(gust, 5.0), 1.0);
  EXPECT_EQ(GustStrength(gust, 9.0), 1.0);
  EXPECT_EQ(GustStrength(gust, 9.001), 0.0);
  gust.duration = {};
  EXPECT_EQ(GustStrength(gust, 1e6), 1.0);
}

TEST(WindAt, OfAGustIntegratesToHalfItsPeakTimesItsDuration) {
  const Wind wind{.gusts = {{.velocity = {0.0, 12.0}, .from = 1.0, .duration = 3.0}}};
  const int steps = 400;
  const double step = 5.0 / steps;
  Vec2 sum = Vec2::Zero();
  for (int i = 0; i < steps; ++i) {
    sum += step * WindAt(wind, {}, (i + 0.5) * step);
  }
  // The integral of the gust's wind speed V/2 (1 - cos(2 pi t/T)) over the gust's duration T is V
  // T/2. The midpoint rule is exact up to rounding, because the gust's duration is a whole number
  // of steps.
  EXPECT_NEAR(sum.y(), 0.5 * 12.0 * 3.0, Tolerance(1e-12));
  EXPECT_EQ(sum.x(), 0.0);
}

TEST(WindAt, GustsAddToTheWindAndToEachOther) {
  const Gust step{.velocity = {1.0, 2.0}, .shape = GustShape::kStep};
  const Wind wind{.velocity = {10.0, 0.0}, .gusts = {step, step}};
  EXPECT_EQ(WindAt(wind, {}, 1.0), Vec2(12.0, 4.0));
}

TEST(WindAt, AGustWithAnAreaBlowsOnlyThere) {
  // The gust's area is a stretch of a road to the north, 20 m long and 6 m wide.
  const Wind wind{.gusts = {{.velocity = {8.0, 0.0},
                             .shape = GustShape::kStep,
                             .area = OrientedBox{{0.0, 50.0, kPi / 2.0}, 20.0, 6.0}}}};
  EXPECT_EQ(WindAt(wind, {0.0, 41.0}, 0.0), Vec2(8.0, 0.0));
  EXPECT_EQ(WindAt(wind, {2.9, 59.0}, 0.0), Vec2(8.0, 0.0));
  EXPECT_EQ(WindAt(wind, {0.0, 39.0}, 0.0), Vec2(0.0, 0.0));
  EXPECT_EQ(WindAt(wind, {3.1, 50.0}, 0.0), Vec2(0.0, 0.0));
}

}  // namespace
}  // namespace trackbed
