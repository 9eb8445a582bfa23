#include "src/drive/slip_control.h"

#include <gtest/gtest.h>

#include "tests/tolerance.h"

namespace trackbed {
namespace {

VehicleState SlippingCar(double front_left, double speed) {
  VehicleState state;
  state.speed = speed;
  state.wheels.emplace();
  (*state.wheels)[0].slip_ratio = front_left;
  return state;
}

TEST(SlipControl, EasesOffWhereAWheelLocksOrSpins) {
  for (const double sign : {1.0, -1.0}) {
    EXPECT_EQ(EaseForSlip(sign * 4.0, SlippingCar(sign * 0.14, 20.0)), sign * 4.0);
    EXPECT_NEAR(EaseForSlip(sign * 4.0, SlippingCar(sign * 0.25, 20.0)), sign * 2.0,
                Tolerance(1e-12));
    EXPECT_EQ(EaseForSlip(sign * 4.0, SlippingCar(sign * 0.9, -20.0)), 0.0);
    // If a wheel slips in the opposite direction, the command reduces that slip and is not limited.
    EXPECT_EQ(EaseForSlip(-sign * 4.0, SlippingCar(sign * 0.9, 20.0)), -sign * 4.0);
  }
}

TEST(SlipControl, LeavesSlowCarsAndThoseWithoutWheelsAlone) {
  EXPECT_EQ(EaseForSlip(-4.0, SlippingCar(-1.0, 1.9)), -4.0);
  VehicleState kinematic;
  kinematic.speed = 20.0;
  EXPECT_EQ(EaseForSlip(-4.0, kinematic), -4.0);
}

}  // namespace
}  // namespace trackbed
