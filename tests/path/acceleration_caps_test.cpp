#include "trackbed/path/acceleration_caps.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "trackbed/core/error.h"

// Tests speed profiles on roads with sections of reduced grip, against closed forms and against
// profiles computed on a fine grid for random roads.
namespace trackbed {
namespace acceleration_caps_test {

constexpr double kRounding = 1e-12;
constexpr SpeedLimits kLimits{.speed = 10.0, .acceleration = 1.0, .deceleration = 1.5};

TEST(AccelerationCaps, MakeTheCarBrakeBeforeIce) {
  // The last 30 m of the road are ice with a maximum deceleration of 0.49 m/s^2. The largest speed
  // at the edge of the ice is v with v^2 = 2 x 0.49 x 30. Before the ice, the car brakes at 1.5
  // m/s^2.
  const SpeedProfile profile =
      StopAtEnd(150.0, 10.0, kLimits, {}, {{.from = 120.0, .to = 150.0, .deceleration = 0.49}});
  const double edge_squared = 2.0 * 0.49 * 30.0;
  const double brakes_from = 120.0 - (100.0 - edge_squared) / 3.0;
  EXPECT_NEAR(profile.SpeedAt(120.0), std::sqrt(edge_squared), Tolerance(kRounding));
  EXPECT_NEAR(profile.AccelerationAt(130.0), -0.49, Tolerance(kRounding));
  EXPECT_NEAR(profile.AccelerationAt(119.0), -1.5, Tolerance(kRounding));
  EXPECT_EQ(profile.SpeedAt(brakes_from - 0.01), 10.0);
  EXPECT_LT(profile.SpeedAt(brakes_from + 0.01), 10.0);
}

TEST(AccelerationCaps, LimitTheAccelerationWhereTheyApply) {
  const SpeedProfile profile =
      StopAtEnd(200.0, 0.0, kLimits, {}, {{.from = 10.0, .to = 20.0, .acceleration = 0.25}});
  EXPECT_NEAR(profile.SpeedAt(10.0), std::sqrt(20.0), Tolerance(kRounding));
  // At 20 m, v^2 = 20 + 2 x 0.25 x 10 = 25 m^2/s^2.
  EXPECT_NEAR(profile.SpeedAt(20.0), 5.0, Tolerance(kRounding));
  EXPECT_NEAR(profile.AccelerationAt(21.0), 1.0, Tolerance(kRounding));
}

TEST(AccelerationCaps, OfACarThatStartsTooFastHoldOnTheIceBehind) {
  // Braking at 1.5 m/s^2 before the ice is not sufficient. The car therefore brakes harder on the
  // dry road, but not on the ice.
  const SpeedProfile profile =
      StopAtEnd(50.0, 10.0, kLimits, {}, {{.from = 20.0, .to = 50.0, .deceleration = 0.5}});
  EXPECT_NEAR(profile.AccelerationAt(10.0), -(100.0 - 30.0) / 40.0, Tolerance(kRounding));
  EXPECT_NEAR(profile.AccelerationAt(40.0), -0.5, Tolerance(kRounding));
}

TEST(AccelerationCaps, ChangeNothingWhereThereAreNone) {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const double length = random.Uniform(1.0, 200.0);
    const double from = random.Uniform(0.0, length);
    const std::vector<SpeedCap> caps{{from, from + random.Uniform(0.0, 30.0), 4.0}};
    const double start = random.Uniform(0.0, 15.0);
    const SpeedProfile plain = StopAtEnd(length, start, kLimits, caps);
    const SpeedProfile wide = StopAtEnd(length, start, kLimits, caps, {{0.0, length, 5.0, 9.0}});
    ASSERT_EQ(plain.knots().size(), wide.knots().size());
    for (std::size_t k = 0; k < plain.knots().size(); ++k) {
      EXPECT_EQ(plain.knots()[k].s, wide.knots()[k].s);
      EXPECT_EQ(plain.knots()[k].speed, wide.knots()[k].speed);
    }
  }
}

struct Road {
  double length = 0.0;
  std::vector<SpeedCap> caps{};
  std::vector<AccelerationCap> sections{};

  [[nodiscard]] SpeedLimits At(double s) const {
    SpeedLimits limits = kLimits;
    for (const SpeedCap& cap : caps) {
      limits.speed =
          cap.from <= s && s <= cap.to ? std::min(limits.speed, cap.speed) : limits.speed;
    }
    for (const AccelerationCap& section : sections) {
      if (section.from <= s && s <= section.to) {
        limits.acceleration = std::min(limits.acceleration, section.acceleration);
        limits.deceleration = std::min(limits.deceleration, section.deceleration);
      }
    }
    return limits;
  }
};

/// Returns a random road. All its stations are multiples of 0.5 m, so the points of the grid
/// include them.
Road RandomRoad(Random& random) {
  const auto station = [&](double most) {
    return 0.5 * random.Below(static_cast<int>(2.0 * most));
  };
  Road road{.length = 20.0 + station(200.0)};
  for (int i = random.Below(4); i > 0; --i) {
    const double from = station(road.length);
    road.caps.push_back({from, from + 0.5 + station(40.0), random.Uniform(1.0, 9.0)});
  }
  for (int i = random.Below(5); i > 0; --i) {
    const double from = station(road.length);
    road.sections.push_back(
        {from, from + 0.5 + station(60.0), random.Uniform(0.1, 2.0), random.Uniform(0.1, 2.0)});
  }
  return road;
}

/// Returns the squares of the largest possible speeds at grid points 0.05 m apart, computed by one
/// pass in each direction.
std::vector<double> SquaresOnGrid(const Road& road, double start_speed) {
  constexpr double kStep = 0.05;
  const auto count = static_cast<std::size_t>(std::lround(road.length / kStep));
  std::vector<double> squares(count + 1, start_speed * start_speed);
  const auto middle = [&](std::size_t i) { return (static_cast<double>(i) + 0.5) * kStep; };
  for (std::size_t i = 0; i < count; ++i) {
    const SpeedLimits limits = road.At(middle(i));
    const double speed = i + 1 < count ? std::min(limits.speed, road.At(middle(i + 1)).speed) : 0.0;
    squares[i + 1] = std::min(speed * speed, squares[i] + 2.0 * limits.acceleration * kStep);
  }
  for (std::size_t i = count; i-- > 0;) {
    squares[i] =
        std::min(squares[i], squares[i + 1] + 2.0 * road.At(middle(i)).deceleration * kStep);
  }
  return squares;
}

TEST(AccelerationCaps, GiveTheFastestProfileWithinThem) {
  Random random(6);
  int compared = 0;
  for (int i = 0; i < 300; ++i) {
    const Road road = RandomRoad(random);
    const double start = random.Below(2) == 0 ? 0.0 : random.Uniform(0.0, 3.0);
    const std::vector<double> squares = SquaresOnGrid(road, start);
    if (squares[0] < start * start) {
      continue;  // The start speed is too high for the limits.
    }
    SCOPED_TRACE(fmt::format("road {}, {} m, from {} m/s", i, road.length, start));
    const SpeedProfile profile = StopAtEnd(road.length, start, kLimits, road.caps, road.sections);
    for (std::size_t k = 0; k < squares.size(); ++k) {
      const double speed = profile.SpeedAt(0.05 * static_cast<double>(k));
      // The limits are constant between the points of the grid. Only rounding errors remain, from a
      // few thousand sums of squares below 100 m^2/s^2.
      ASSERT_NEAR(speed * speed, squares[k], Tolerance(1e-9)) << "point " << k;
    }
    ++compared;
  }
  EXPECT_GT(compared, 200);
}

TEST(AccelerationCaps, HoldOnPathsOfAnyLength) {
  // This path is shorter than the shortest interval of a speed profile.
  EXPECT_EQ(StopAtEnd(1e-10, 0.0, kLimits, {}, {{0.0, 1.0, 1.0, 1.0}}).SpeedAt(1e-10), 0.0);
  EXPECT_EQ(StopAtEnd(1e-10, 0.0, kLimits).SpeedAt(1e-10), 0.0);
}

TEST(AccelerationCaps, MustBePositive) {
  EXPECT_THROW(StopAtEnd(10.0, 0.0, kLimits, {}, {{0.0, 5.0, 0.0, 1.0}}), PreconditionError);
  EXPECT_THROW(StopAtEnd(10.0, 0.0, kLimits, {}, {{0.0, 5.0, 1.0, -1.0}}), PreconditionError);
  EXPECT_THROW(StopAtEnd(10.0, 0.0, kLimits, {}, {{NAN, 5.0, 1.0, 1.0}}), PreconditionError);
}

}  // namespace acceleration_caps_test
}  // namespace trackbed
