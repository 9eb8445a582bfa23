#include "trackbed/control/lqr.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/control/loop.h"
#include "tests/tolerance.h"

namespace trackbed {
namespace {

/// A lane change with curvature ramps that the wheels can follow, then a long arc.
Path Ramps(double curvature) {
  return {{},
          {{.length = 20.0},
           {.length = 15.0, .sharpness = curvature / 15.0},
           {.length = 20.0, .curvature = curvature},
           {.length = 30.0, .curvature = curvature, .sharpness = -2.0 * curvature / 30.0},
           {.length = 200.0, .curvature = -curvature}}};
}

TEST(Lqr, SettlesOnACircleWithoutErrorAtAnySpeed) {
  // The feed-forward of lqr includes understeer, because lqr's model is the linear single-track
  // car. The remaining error comes from linearizing the tangent of the steering angle and the
  // path's curvature. The error is about the offset times the square of an angle below 0.1 rad, so
  // the error vanishes together with the offset.
  for (const double speed : {3.0, 10.0, 20.0}) {
    SCOPED_TRACE(speed);
    LoopSetup setup;
    setup.vehicle = ReferenceCarWithTyres();
    setup.path = Ramps(4.0 / std::max(speed * speed, 40.0));
    setup.speed = speed;
    setup.duration = 200.0 / speed;
    const std::vector<LoopRow> rows = Loop(LqrOptions{}, setup);
    EXPECT_LT(LargestOffset(rows, rows.size() * 9 / 10), 1e-3);
  }
}

TEST(Lqr, SeesRampsComing) {
  // With preview the car stays nearer to the path than without.
  LoopSetup setup;
  setup.vehicle = ReferenceCarWithTyres();
  setup.path = Ramps(0.01);
  setup.speed = 20.0;
  setup.duration = 8.0;
  const double seeing = LargestOffset(Loop(LqrOptions{}, setup));
  const double blind = LargestOffset(Loop(LqrOptions{.preview = 0.0}, setup));
  EXPECT_LT(seeing, 0.02);
  EXPECT_GT(blind, 2.0 * seeing);
}

TEST(Lqr, ApproachesFromFarAtAnAngle) {
  // From up to 20 m beside the path, the car does not circle or oscillate persistently. lqr limits
  // the approach angle to 0.6 rad; the limited steering rate adds less than 0.2 rad.
  for (const double offset : {1.0, 3.0, 20.0}) {
    SCOPED_TRACE(offset);
    LoopSetup setup;
    setup.path = Path({}, {{300.0, 0.0, 1}});
    setup.start = {0.0, offset, 0.0};
    setup.duration = 60.0;
    const std::vector<LoopRow> rows = Loop(LqrOptions{}, setup);
    double steepest = 0.0;
    for (const LoopRow& row : rows) {
      steepest = std::max(steepest, std::abs(row.tracking.heading_error));
    }
    EXPECT_LT(steepest, 0.8);
    EXPECT_LT(LargestOffset(rows, rows.size() * 9 / 10), 0.05);
  }
}

TEST(Lqr, WeightsTradeOffsetForCalm) {
  LoopSetup setup;
  setup.path = Path({}, {{100.0, 0.0, 1}});
  setup.start = {0.0, 0.3, 0.0};
  const auto rows_with = [&](double weight) {
    return Loop(LqrOptions{.cross_track = weight}, setup);
  };
  const auto area = [](const std::vector<LoopRow>& rows) {
    double sum = 0.0;
    for (const LoopRow& row : rows) {
      sum += std::abs(row.tracking.cross_track);
    }
    return sum;
  };
  EXPECT_LT(area(rows_with(1.0)), area(rows_with(0.01)));
}

}  // namespace
}  // namespace trackbed
