#include "src/vehicle/brush_axle.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/tolerance.h"

namespace trackbed {
namespace {

constexpr double kStiffness = 80e3;     // [N/rad]
constexpr double kFrictionForce = 6e3;  // [N]

TEST(BrushAxle, HasFialasForceAtItsSlip) {
  // The lateral force at the slip angle a is F = C a - (C a)^2/(3 mu F_z) + (C a)^3/(27 (mu F_z)^2)
  // (Fiala 1954, as in Pacejka 2012, eq. (3.12)).
  for (const double lateral : {1.0, -600.0, 3000.0, -5600.0}) {
    SCOPED_TRACE(lateral);
    const AxleOperation axle = BrushAxleAt(kStiffness, kFrictionForce, {.lateral = lateral});
    const double linear = kStiffness * std::abs(axle.slip);
    const double force = linear - linear * linear / (3.0 * kFrictionForce) +
                         std::pow(linear, 3) / (27.0 * kFrictionForce * kFrictionForce);
    EXPECT_NEAR(std::copysign(force, axle.slip), lateral, Tolerance(1e-9));
  }
}

TEST(BrushAxle, HasTheSlopeOfItsForceBesideABrakingForce) {
  // Central differences over 2 x 0.1 N of 6 kN have relative errors of (0.1/6000)^2 = 3e-10 times
  // the third derivative of the slip. This derivative grows as (1 - F/(mu F_z))^(-8/3), which is
  // about 460 at F = 0.9 mu F_z. The tolerance of 1e-6 also covers the rounding of the slips by
  // 1e-17 rad, while the difference between two slips is 1e-6 rad.
  constexpr double kStep = 0.1;
  for (const double longitudinal : {0.0, -3000.0, 4500.0}) {
    for (const double lateral : {0.5, 1500.0, -3000.0}) {
      SCOPED_TRACE(fmt::format("{} N along, {} N across", longitudinal, lateral));
      const auto at = [&](double force) {
        return BrushAxleAt(kStiffness, kFrictionForce,
                           {.longitudinal = longitudinal, .lateral = force});
      };
      const double slope = 2.0 * kStep / (at(lateral + kStep).slip - at(lateral - kStep).slip);
      EXPECT_NEAR(at(lateral).stiffness, slope, Tolerance(1e-6) * slope);
    }
  }
}

TEST(BrushAxle, IsLinearWithoutForceAndKeepsSomeStiffnessWhereItSlides) {
  const AxleOperation idle = BrushAxleAt(kStiffness, kFrictionForce, {});
  EXPECT_EQ(idle.slip, 0.0);
  EXPECT_EQ(idle.stiffness, kStiffness);
  // The lateral force is limited to 0.95 of the friction force, where (1 - q)^2 = 0.05^(2/3).
  const AxleOperation slides = BrushAxleAt(kStiffness, kFrictionForce, {.lateral = 2e4});
  EXPECT_NEAR(slides.stiffness, kStiffness * std::pow(0.05, 2.0 / 3.0), Tolerance(1e-6));
  EXPECT_EQ(slides.slip, BrushAxleAt(kStiffness, kFrictionForce, {.lateral = 1e4}).slip);
}

}  // namespace
}  // namespace trackbed
