#include "trackbed/vehicle/steering_faults.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

std::vector<double> Wander(std::size_t count) {
  Random random(17);
  std::vector<double> angles;
  for (std::size_t i = 0; i < count; ++i) {
    angles.push_back(random.Uniform(-0.4, 0.4));
  }
  return angles;
}

std::vector<double> PassAll(const SteeringFaults& faults, const std::vector<double>& wanted,
                            double start = 0.0) {
  FaultySteering steering(faults, 0.002, start);
  std::vector<double> given;
  for (const double angle : wanted) {
    given.push_back(steering.Pass(angle));
  }
  return given;
}

TEST(FaultySteering, WithoutFaultsGivesWhatIsWanted) {
  const std::vector<double> wanted = Wander(200);
  EXPECT_EQ(PassAll({}, wanted), wanted);
}

TEST(FaultySteering, TurnsByItsFactor) {
  const std::vector<double> wanted = Wander(200);
  const std::vector<double> given = PassAll({.factor = 0.9}, wanted);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_EQ(given[i], 0.9 * wanted[i]);
  }
}

TEST(FaultySteering, ShiftsByTheDelay) {
  const std::vector<double> wanted = Wander(200);
  // 33 ms are 16.5 timesteps, which are rounded up to 17. 0.4 ms are less than half a timestep,
  // which are rounded to 0.
  const std::vector<std::pair<double, std::size_t>> cases{{0.1, 50}, {0.033, 17}, {0.0004, 0}};
  for (const auto& [delay, steps] : cases) {
    const std::vector<double> given = PassAll({.delay = delay}, wanted, 0.25);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      EXPECT_EQ(given[i], i < steps ? 0.25 : wanted[i - steps]) << delay << " " << i;
    }
  }
}

/// Backlash has a closed form for a rising, falling and rising input: half of the play is lost at
/// first, and all of it at every reversal.
TEST(FaultySteering, HasThePlayOfItsDeadBand) {
  constexpr double kBand = 0.03;
  std::vector<double> wanted;
  for (const double to : {0.2, -0.2, 0.2}) {
    const double from = wanted.empty() ? 0.0 : wanted.back();
    for (int i = 1; i <= 100; ++i) {
      wanted.push_back(std::lerp(from, to, i / 100.0));
    }
  }
  const std::vector<double> given = PassAll({.backlash = kBand}, wanted);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const double up = wanted[i] - 0.5 * kBand;
    const double down = wanted[i] + 0.5 * kBand;
    const double expected = i < 100   ? std::max(0.0, up)
                            : i < 200 ? std::min(0.2 - 0.5 * kBand, down)
                                      : std::max(-0.2 + 0.5 * kBand, up);
    EXPECT_NEAR(given[i], expected, Tolerance(1e-15)) << i;
  }
}

TEST(FaultySteering, StaysWithinTheDeadBand) {
  std::vector<double> wanted = Wander(200);
  for (double& angle : wanted) {
    angle = 0.1 + 0.02 * angle;  // varies by at most 8 mrad
  }
  for (const double given : PassAll({.backlash = 0.017}, wanted, 0.1)) {
    EXPECT_EQ(given, 0.1);
  }
}

TEST(FaultySteering, RefusesFaultsAndAnglesThatAreNoNumbers) {
  const double nan = std::nan("");
  EXPECT_THROW(FaultySteering({.delay = nan}, 0.01, 0.0), PreconditionError);
  EXPECT_THROW(FaultySteering({.delay = 1e9}, 0.01, 0.0), PreconditionError);
  EXPECT_THROW(FaultySteering({.factor = nan}, 0.01, 0.0), PreconditionError);
  EXPECT_THROW(FaultySteering({.backlash = nan}, 0.01, 0.0), PreconditionError);
  EXPECT_THROW(FaultySteering({}, 0.01, 0.0).Pass(nan), PreconditionError);
}

TEST(FaultySteering, TakesItsFaultsInOrder) {
  // The backlash is that of the road wheels, so it acts on the angle after all other faults, such
  // as the factor.
  const std::vector<double> wanted{0.1, 0.1, 0.0, 0.0};
  const std::vector<double> given =
      PassAll({.factor = 2.0, .delay = 0.002, .backlash = 0.1}, wanted);
  const std::vector<double> expected{0.0, 0.15, 0.15, 0.05};
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_NEAR(given[i], expected[i], Tolerance(1e-15)) << i;
  }
}

}  // namespace
}  // namespace trackbed
