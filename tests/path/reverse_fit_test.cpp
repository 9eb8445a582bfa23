#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/core/table.h"
#include "trackbed/path/fit_path.h"

// Tests the fit of paths with reverse pieces: the legs that follow from directions of motion and
// headings, cusps, noise while the car stands at a cusp, and contradictions.
namespace trackbed {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// Samples of a path with cusps, at most `spacing` apart on each leg. The cusps are samples. The
/// direction at a cusp is the direction in which the car arrives there.
PathPoints SamplesOf(const Path& path, double spacing) {
  PathPoints given;
  for (const Stations& leg : SplitIntoLegs(path)) {
    const int direction = path.At(0.5 * (leg.from + leg.to)).direction;
    const double count = std::ceil((leg.to - leg.from) / spacing);
    for (double i = leg.from == 0.0 ? 0.0 : 1.0; i <= count; i += 1.0) {
      const Pose2 pose = path.At(std::lerp(leg.from, leg.to, i / count)).pose;
      given.points.push_back(pose.position());
      given.yaw.push_back(pose.yaw);
      given.direction.push_back(direction);
    }
  }
  return given;
}

/// A three-point turn: forward to the left, backward to the right, forward to the left.
Path ThreePointTurn() {
  return Path({3.0, -2.0, 0.4}, {{.length = 4.0, .curvature = 0.15},
                                 {.length = 5.0, .curvature = -0.15, .direction = -1},
                                 {.length = 6.0, .curvature = 0.12}});
}

std::vector<double> CuspsOf(const Path& path) {
  std::vector<double> cusps;
  for (const Stations& leg : SplitIntoLegs(path)) {
    cusps.push_back(leg.from);
  }
  cusps.erase(cusps.begin());
  return cusps;
}

/// Compares two paths at 101 equal shares of their lengths.
void ExpectEqualPaths(const Path& path, const Path& expected, double tolerance) {
  ASSERT_NEAR(path.length(), expected.length(), tolerance);
  for (int i = 0; i <= 100; ++i) {
    const double s = expected.length() * (i + 0.5) / 101.0;
    const PathPoint own = path.At(s);
    const PathPoint other = expected.At(s);
    EXPECT_EQ(own.direction, other.direction) << s;
    EXPECT_LE((own.pose.position() - other.pose.position()).norm(), tolerance) << s;
    EXPECT_LE(std::abs(AngleDifference(own.pose.yaw, other.pose.yaw)), tolerance) << s;
  }
}

// Legs that are arcs are fitted to 1e-9 m. A heading error of 1e-9 m/6.7 m, with the smallest
// radius of 6.7 m, turns the later legs, 11 m long. Ten times this error covers two cusps and the
// errors of the lengths.
constexpr double kExact = 1e-8;

TEST(FitReversePath, FindsTheLegsFromAnyEvidence) {
  const Path path = ThreePointTurn();
  const PathPoints all = SamplesOf(path, 0.3);
  PathPoints arrival = all;
  arrival.yaw.clear();
  PathPoints departure = arrival;
  std::rotate(departure.direction.begin(), departure.direction.begin() + 1,
              departure.direction.end());
  departure.direction.back() = departure.direction.end()[-2];
  PathPoints standing = arrival;
  for (std::size_t i = 0; i + 1 < standing.direction.size(); ++i) {
    if (arrival.direction[i] != arrival.direction[i + 1]) {
      standing.direction[i] = 0;
    }
  }
  PathPoints headings = all;
  headings.direction.clear();
  for (const PathPoints& given : {all, arrival, departure, standing, headings}) {
    const FittedPath fitted = FitPath(given, {});
    ASSERT_TRUE(fitted.reversals.empty());
    ExpectEqualPaths(fitted.path, path, Tolerance(kExact));
    const std::vector<double> cusps = CuspsOf(fitted.path);
    ASSERT_EQ(cusps.size(), 2U);
    EXPECT_NEAR(cusps[0], 4.0, Tolerance(kExact));
    EXPECT_NEAR(cusps[1], 9.0, Tolerance(kExact));
    EXPECT_LE(fitted.deviation, Tolerance(kExact));
  }
}

TEST(FitReversePath, KeepsTheDeviationOverNoisyLegs) {
  // Three arcs with noise of 2 mm. The first leg cannot end with the heading of the second one. If
  // the later legs were turned by the difference, they would be up to 0.15 m beside their points.
  const Table table =
      ReadCsv(std::filesystem::path(TRACKBED_SOURCE_DIR) / "tests/data/noisy_legs.csv");
  const std::vector<double> x = table.Column("x_m");
  const std::vector<double> y = table.Column("y_m");
  PathPoints given;
  for (std::size_t i = 0; i < x.size(); ++i) {
    given.points.emplace_back(x[i], y[i]);
    given.direction.push_back(table.Column("direction")[i] > 0.0 ? 1 : -1);
  }
  const FittedPath fitted = FitPath(given, {.max_deviation = 0.02});
  EXPECT_EQ(CuspsOf(fitted.path).size(), 2U);
  EXPECT_LE(fitted.deviation, 0.02 * (1.0 + 1e-6));
  const Vec2 end = fitted.path.At(fitted.path.length()).pose.position();
  EXPECT_LE((end - given.points.back()).norm(), Tolerance(1e-7));
}

TEST(FitReversePath, DrivesAWholePathInReverse) {
  const Path path({0.0, 0.0, 1.0}, {{.length = 12.0, .curvature = 0.08, .direction = -1}});
  PathPoints given = SamplesOf(path, 0.5);
  given.direction.clear();
  const FittedPath fitted = FitPath(given, {});
  ExpectEqualPaths(fitted.path, path, Tolerance(kExact));
  EXPECT_LE(fitted.heading_difference, Tolerance(kExact));
  // The headings are wrong by half a turn, and the directions say that the car only drives forward.
  given.direction.assign(given.points.size(), 1);
  try {
    FitPath(given, {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("the heading of point 1 at (0, 0), 1 rad"),
                                    HasSubstr("drives forwards there"), HasSubstr("directions")));
  }
}

TEST(FitReversePath, RepeatsTheCusp) {
  PathPoints given;
  const Path path = ThreePointTurn();
  const PathPoints once = SamplesOf(path, 0.3);
  for (std::size_t i = 0; i < once.points.size(); ++i) {
    const bool is_cusp = i + 1 < once.points.size() && once.direction[i] != once.direction[i + 1];
    for (int k = 0; k < (is_cusp ? 3 : 1); ++k) {
      given.points.push_back(once.points[i]);
      given.direction.push_back(once.direction[i + (k == 2 ? 1 : 0)]);
    }
  }
  const FittedPath fitted = FitPath(given, {});
  ExpectEqualPaths(fitted.path, path, Tolerance(kExact));
  EXPECT_EQ(fitted.repeated, 4U);
  EXPECT_EQ(fitted.stations.size(), given.points.size());
}

// A file with positions alone does not say in which direction the car moves.
TEST(FitReversePath, NeedsEvidence) {
  PathPoints given = SamplesOf(ThreePointTurn(), 0.3);
  given.yaw.clear();
  given.direction.clear();
  EXPECT_EQ(FitPath(given, {}).reversals.size(), 2U);
  given.direction.assign(given.points.size(), 1);
  EXPECT_EQ(FitPath(given, {}).reversals.size(), 2U);
}

/// A random path of legs with curvatures that are linear in the station.
Path RandomPath(std::mt19937& random) {
  const auto between = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  std::vector<Segment> segments;
  int direction = between(0.0, 1.0) < 0.5 ? 1 : -1;
  const int legs = std::uniform_int_distribution<int>(2, 5)(random);
  for (int i = 0; i < legs; ++i, direction = -direction) {
    Segment segment{
        .length = between(1.5, 8.0), .curvature = between(-0.15, 0.15), .direction = direction};
    segment.sharpness = (between(-0.15, 0.15) - segment.curvature) / segment.length;
    segments.push_back(segment);
  }
  return Path({between(-50.0, 50.0), between(-50.0, 50.0), between(-3.0, 3.0)}, segments);
}

// A recorder logs the car at rest at the cusps, with 20 samples and noise of 3 mm, which is far
// below max_deviation. While the car is at rest, the signs of its speeds are random.
TEST(FitReversePath, StandsAtItsCusps) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 0.003);
  for (int run = 0; run < 60; ++run) {
    SCOPED_TRACE(run);
    const Path path = RandomPath(random);
    const PathPoints once = SamplesOf(path, 0.2);
    PathPoints given;
    for (std::size_t i = 0; i < once.points.size(); ++i) {
      const bool is_cusp = i + 1 < once.points.size() && once.direction[i] != once.direction[i + 1];
      for (int k = 0; k < (is_cusp ? 20 : 1); ++k) {
        given.points.push_back(once.points[i] + Vec2(noise(random), noise(random)));
        given.yaw.push_back(once.yaw[i]);
        given.direction.push_back(k == 0 ? once.direction[i] : 0);
      }
    }
    if (run % 3 == 0) {
      given.yaw.clear();
    } else if (run % 3 == 1) {
      given.direction.clear();
    }
    const FittedPath fitted = FitPath(given, {});
    ASSERT_TRUE(fitted.reversals.empty());
    EXPECT_LE(fitted.deviation, Tolerance(0.05));
    const std::vector<double> cusps = CuspsOf(fitted.path);
    const std::vector<double> expected = CuspsOf(path);
    ASSERT_EQ(cusps.size(), expected.size());
    for (std::size_t i = 0; i < cusps.size(); ++i) {
      // The fitted path deviates from the cusp by at most 0.05 m, and the samples there by up to 4
      // standard deviations.
      EXPECT_LE(
          (fitted.path.At(cusps[i]).pose.position() - path.At(expected[i]).pose.position()).norm(),
          Tolerance(0.05 + 0.012));
      EXPECT_EQ(fitted.path.At(cusps[i] + 0.1).direction, path.At(expected[i] + 0.1).direction);
    }
  }
}

// The car changes its direction between two samples, up to half of the spacing beyond them.
TEST(FitReversePath, TurnsBetweenSamples) {
  std::mt19937 random(11);
  for (int run = 0; run < 60; ++run) {
    SCOPED_TRACE(run);
    const Path path = RandomPath(random);
    const double spacing = 0.4;
    PathPoints given;
    for (double s = 0.0; s < path.length() + spacing; s += spacing) {
      const PathPoint at = path.At(std::min(s, path.length() - 1e-9));
      given.points.push_back(at.pose.position());
      given.yaw.push_back(at.pose.yaw);
      given.direction.push_back(at.direction);
    }
    if (run % 3 == 0) {
      given.yaw.clear();
    } else if (run % 3 == 1) {
      given.direction.clear();
    }
    const FittedPath fitted = FitPath(given, {});
    ASSERT_TRUE(fitted.reversals.empty());
    EXPECT_LE(fitted.deviation, Tolerance(0.05));
    EXPECT_EQ(CuspsOf(fitted.path).size(), CuspsOf(path).size());
  }
}

/// Samples of a plan as in plan.csv, with headings and curvatures. The curvature at a cusp is the
/// curvature of the leg that ends there.
PathPoints PlanSamples(const Path& path) {
  PathPoints given = SamplesOf(path, 0.1);
  for (const Stations& leg : SplitIntoLegs(path)) {
    const double count = std::ceil((leg.to - leg.from) / 0.1);
    for (double i = leg.from == 0.0 ? 0.0 : 1.0; i <= count; i += 1.0) {
      const double s = std::lerp(leg.from, leg.to, i / count);
      given.curvature.push_back(path.At(i == count ? s - 1e-12 : s).curvature);
    }
  }
  return given;
}

// Arcs and lines whose curvatures jump between the samples, as in plans of Reeds-Shepp curves. The
// tolerance is the one that FindsTheLegsFromAnyEvidence derives.
TEST(FitReversePath, ReadsAPlanAgain) {
  std::mt19937 random(3);
  const auto between = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  for (int run = 0; run < 100; ++run) {
    SCOPED_TRACE(run);
    std::vector<Segment> segments;
    for (int i = 0; i < 6; ++i) {
      const double side = i % 3 == 1 ? 0.0 : between(0.0, 1.0) < 0.5 ? 0.18 : -0.18;
      segments.push_back(
          {.length = between(0.5, 6.0), .curvature = side, .direction = i < 2 || i > 4 ? 1 : -1});
    }
    const Path path({between(-1e3, 1e3), between(-1e3, 1e3), between(-3.0, 3.0)}, segments);
    const FittedPath fitted = FitPath(PlanSamples(path), {});
    ExpectEqualPaths(fitted.path, path, Tolerance(kExact));
    EXPECT_EQ(fitted.smoothing_length, 0.0);
    EXPECT_LE(fitted.path.segments().size(), segments.size());
  }
}

// Each leg has a curvature that is linear in the station. The path between two samples is exact,
// because both samples have the exact heading and curvature.
TEST(FitReversePath, FollowsCurvaturesThatChange) {
  std::mt19937 random(5);
  for (int run = 0; run < 50; ++run) {
    SCOPED_TRACE(run);
    const Path path = RandomPath(random);
    const FittedPath fitted = FitPath(PlanSamples(path), {});
    EXPECT_EQ(fitted.smoothing_length, 0.0);
    ExpectEqualPaths(fitted.path, path, Tolerance(kExact));
  }
}

TEST(FitReversePath, DoesNotFollowCurvaturesOfAnotherPath) {
  PathPoints given = PlanSamples(ThreePointTurn());
  for (double& curvature : given.curvature) {
    curvature = -curvature;
  }
  const FittedPath fitted = FitPath(given, {});
  EXPECT_GT(fitted.smoothing_length, 0.0);
  ExpectEqualPaths(fitted.path, ThreePointTurn(), Tolerance(kExact));
}

TEST(FitReversePath, SaysWhatIsWrong) {
  const PathPoints given = SamplesOf(ThreePointTurn(), 0.3);
  const auto error = [](PathPoints points, const PathFitOptions& options) -> std::string {
    try {
      FitPath(std::move(points), options);
      return "";
    } catch (const InputError& problem) {
      return problem.what();
    }
  };
  EXPECT_THAT(error(given, {.closed = true}),
              HasSubstr("closed: a path with changes of direction cannot be closed"));
  PathPoints one = given;
  one.yaw[5] += kPi;
  EXPECT_THAT(error(one, {}), HasSubstr("the heading of point 6 at"));
  EXPECT_THROW(FitPath({.points = {{0.0, 0.0}, {1.0, 0.0}}, .direction = {1}}, {}),
               PreconditionError);
  PathPoints no_yaw = given;
  no_yaw.yaw.clear();
  try {
    AtRearAxle(no_yaw, 1.0);
    FAIL();
  } catch (const InputError& problem) {
    EXPECT_THAT(problem.what(), AllOf(HasSubstr("ahead"), HasSubstr("needs headings")));
  }
}

TEST(FitReversePath, JoinsPolylines) {
  PathPoints given = SamplesOf(ThreePointTurn(), 0.3);
  const FittedPath fitted = FitPath(given, {.fit = PathFit::kPolyline});
  ASSERT_TRUE(fitted.reversals.empty());
  EXPECT_EQ(CuspsOf(fitted.path).size(), 2U);
  // Arcs that replace the corners stay within 1 mm of the corners.
  EXPECT_LE(fitted.deviation, Tolerance(1e-3));
  // The heading of a chord 0.3 m long differs from the headings of its arc by up to 0.15 m/6.7 m.
  EXPECT_LE(fitted.heading_difference, Tolerance(0.15 * 0.15 + 1e-3));
}

}  // namespace
}  // namespace trackbed
