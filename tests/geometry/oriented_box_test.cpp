#include "trackbed/geometry/oriented_box.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"

namespace trackbed {
namespace {

TEST(OrientedBox, CornersGoRoundCounterClockwise) {
  const OrientedBox box{{1.0, 2.0, std::acos(-1.0) / 2.0}, 4.0, 2.0};
  const auto corners = box.Corners();
  // Turned to the north: its front left corner lies north-west of the middle.
  EXPECT_NEAR(corners[0].x(), 0.0, Tolerance(1e-12));
  EXPECT_NEAR(corners[0].y(), 4.0, Tolerance(1e-12));
  double area = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    area += 0.5 * Cross(corners[i], corners[(i + 1) % 4]);
  }
  EXPECT_NEAR(area, 8.0, Tolerance(1e-12));
}

TEST(Distance, IsThatOfTheNearestSidesOrCorners) {
  const OrientedBox a{{0.0, 0.0, 0.0}, 2.0, 2.0};
  EXPECT_NEAR(Distance(a, {{5.0, 0.0, 0.0}, 2.0, 2.0}), 3.0, Tolerance(1e-12));
  EXPECT_NEAR(Distance(a, {{4.0, 5.0, 0.0}, 2.0, 2.0}), std::hypot(2.0, 3.0), Tolerance(1e-12));
  // A diamond points its corner at the side: 5 - 1 - sqrt(2).
  EXPECT_NEAR(Distance(a, {{5.0, 0.0, std::acos(-1.0) / 4.0}, 2.0, 2.0}), 4.0 - std::sqrt(2.0),
              Tolerance(1e-12));
}

TEST(Distance, IsZeroForOverlapTouchAndContainment) {
  const OrientedBox a{{0.0, 0.0, 0.3}, 4.0, 2.0};
  EXPECT_EQ(Distance(a, {{1.0, 0.5, 1.0}, 4.0, 2.0}), 0.0);
  EXPECT_EQ(Distance(a, {{0.0, 0.0, 0.0}, 0.1, 0.1}), 0.0);
  EXPECT_EQ(Distance({{0.0, 0.0, 0.0}, 0.1, 0.1}, a), 0.0);
  // A cross: no corner of either lies in the other.
  EXPECT_EQ(Distance({{0.0, 0.0, 0.0}, 10.0, 0.1}, {{0.0, 0.0, 1.5}, 10.0, 0.1}), 0.0);
  EXPECT_EQ(Distance({{0.0, 0.0, 0.0}, 2.0, 2.0}, {{2.0, 0.0, 0.0}, 2.0, 2.0}), 0.0);
}

/// Distance by sampling both outlines.
double BySampling(const OrientedBox& a, const OrientedBox& b) {
  constexpr int kSamples = 200;
  double nearest = std::numeric_limits<double>::infinity();
  const auto ca = a.Corners();
  const auto cb = b.Corners();
  for (std::size_t i = 0; i < 4; ++i) {
    for (int u = 0; u < kSamples; ++u) {
      const Vec2 p = ca[i] + (ca[(i + 1) % 4] - ca[i]) * u / kSamples;
      for (std::size_t j = 0; j < 4; ++j) {
        const Vec2 along = cb[(j + 1) % 4] - cb[j];
        const double t = std::clamp((p - cb[j]).dot(along) / along.squaredNorm(), 0.0, 1.0);
        nearest = std::min(nearest, (p - cb[j] - t * along).norm());
      }
    }
  }
  return nearest;
}

TEST(Distance, AgreesWithSampledOutlines) {
  Random random(7);
  int apart = 0;
  for (int i = 0; i < 200; ++i) {
    const OrientedBox a{{0.0, 0.0, random.Uniform(-3.0, 3.0)}, 4.0, 2.0};
    const OrientedBox b{
        {random.Uniform(-8.0, 8.0), random.Uniform(-8.0, 8.0), random.Uniform(-3.0, 3.0)},
        random.Uniform(0.5, 5.0),
        random.Uniform(0.5, 5.0)};
    const double exact = Distance(a, b);
    EXPECT_EQ(exact, Distance(b, a));
    if (exact > 0.0) {
      ++apart;
      // Sampling can only be too far, by at most half a step of the longer side: 4/200/2.
      EXPECT_NEAR(BySampling(a, b), exact, Tolerance(0.01));
    }
  }
  EXPECT_GT(apart, 50);
}

}  // namespace
}  // namespace trackbed
