#include "trackbed/planning/racing/minimum_curvature.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <random>

#include "tests/tolerance.h"
#include "tests/track/rings.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/table.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/track/track_file.h"

namespace trackbed {
namespace {

using testing::HasSubstr;

TEST(MinimumCurvature, OfARingIsItsOuterCircle) {
  // For a closed curve that goes around once, the integral of kappa^2 is at least (2 pi)^2/length.
  // The line of least curvature on a ring is therefore the longest circle within the margin.
  const Track track(RingPoints(50.0, 63, 4.0, 3.0));
  const MinimumCurvatureLine found = FindMinimumCurvature(track, 1.5);
  ASSERT_EQ(found.refused, "");
  const LineFindings line = MeasureLine(track, found.line);
  // Between the points of the track, the edges deviate from circles by up to 2e-4 m. IPOPT meets
  // its bounds to 1e-7 m.
  EXPECT_NEAR(line.curvature_square, 2.0 * kPi / 52.5, Tolerance(2.0 * kPi / 52.5 * 1e-5));
  for (double s = 0.0; s < track.length(); s += 1.0) {
    EXPECT_NEAR(found.line.At(s).d, -2.5, Tolerance(2e-3));
  }
}

/// Returns an elliptic track with a radius of curvature of 30 m at its ends. On this track, a
/// racing line has clearly less curvature than the center line.
Track Ellipse() {
  return Track(EllipsePoints(120.0, 60.0, 114, 5.0, 5.0));
}

TEST(MinimumCurvature, KeepsItsBounds) {
  const Track track = Ellipse();
  const MinimumCurvatureLine found = FindMinimumCurvature(track, 1.2);
  ASSERT_EQ(found.refused, "");
  double largest = 0.0;
  for (double s = 0.0; s < track.length(); s += 0.5) {
    const double d = found.line.At(s).d;
    const TrackEdges edges = track.EdgesAt(s);
    // The optimizer enforces the bounds at points 2.5 m apart. Between these points, the line
    // deviates by at most d'' 2.5^2/8 = 0.026 m, because the second derivative d'' of its offset is
    // below 1/30 1/m.
    EXPECT_LE(d, edges.left - 1.2 + Tolerance(0.03));
    EXPECT_GE(d, edges.right + 1.2 - Tolerance(0.03));
    largest = std::max(largest, std::abs(d));
  }
  EXPECT_GT(largest, 3.7);  // the line uses the full width
}

TEST(MinimumCurvature, CannotBeBetteredNearby) {
  const Track track = Ellipse();
  constexpr double kBeside = 1.2;
  const MinimumCurvatureLine found = FindMinimumCurvature(track, kBeside);
  ASSERT_EQ(found.refused, "");
  const double best = MeasureLine(track, found.line).curvature_square;
  EXPECT_LT(best, 0.9 * MeasureLine(track, TrackLine()).curvature_square);
  // The test adds bumps of random width and position to the line, and clips the sum to the bounds
  // at the knots of a spline.
  std::mt19937 random(13);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int trial = 0; trial < 50; ++trial) {
    const double middle = 0.5 * (unit(random) + 1.0) * track.length();
    const double width = 20.0 + 60.0 * std::abs(unit(random));
    const double height = 0.3 * unit(random);
    SplineSamples samples;
    const auto count = static_cast<Eigen::Index>(2 * track.points().size());
    samples.values.resize(count, 1);
    for (Eigen::Index i = 0; i < count; ++i) {
      const double s = track.length() * static_cast<double>(i) / static_cast<double>(count);
      const double away = std::remainder(s - middle, track.length()) / width;
      const TrackEdges edges = track.EdgesAt(s);
      samples.t.push_back(s);
      samples.weights.push_back(1.0);
      samples.values(i, 0) = std::clamp(found.line.At(s).d + height * std::exp(-away * away),
                                        edges.right + kBeside, edges.left - kBeside);
    }
    const ClosedSplineBasis basis(track.length(), static_cast<std::size_t>(count));
    const TrackLine other(basis, FitClosedSpline(basis, samples, 5.0));
    // The optimizer stops when a step changes the integral by less than 1e-6 of it. The spline of
    // the optimizer has fewer knots than the spline of the test.
    EXPECT_GT(MeasureLine(track, other).curvature_square, (1.0 - 1e-3) * best) << trial;
  }
}

TEST(MinimumCurvature, RefusesATrackThatIsTooNarrow) {
  const Track track(RingPoints(50.0, 63, 1.0, 1.0));
  EXPECT_THAT(FindMinimumCurvature(track, 1.4).refused,
              HasSubstr("the track is 2 m wide at s = 0 m; the car and its margins need 2.8 m"));
}

TEST(MinimumCurvature, IsPlannedAndFeasible) {
  PlanRequest request;
  request.vehicle = ReferenceCar();
  request.on_track = {std::make_shared<const Track>(Ellipse()), 2};
  request.start = request.on_track.track->At(0.0).pose;
  request.speed = {.speed = 8.0, .acceleration = 1.5, .deceleration = 2.0};
  const Plan plan = MakePlan(request, MinimumCurvatureOptions{.margin = 0.5});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  EXPECT_TRUE(FindExcesses(plan, request).empty());
  const auto* own = plan.diagnostics.planner.GetIf<MinimumCurvatureDiagnostics>();
  ASSERT_NE(own, nullptr);
  EXPECT_LT(own->plan.lap.curvature_square, 0.9 * own->center_curvature_square);
  EXPECT_GT(own->plan.lap.radius_min, 32.0);
  // The second lap follows the racing line. The path of the first lap follows the racing line
  // except at the start. At the start, the path moves from the center line to the racing line, 3.6
  // m outside, within 3 s (24 m). On the outside, a bend of radius 30 m is longer by at most 24 x
  // 3.6/30 = 2.9 m.
  ASSERT_EQ(plan.laps.lines.size(), 3U);
  EXPECT_NEAR(plan.laps.lines[2] - plan.laps.lines[1], own->plan.lap.length, Tolerance(1e-3));
  EXPECT_NEAR(plan.laps.lines[1] - plan.laps.lines[0], own->plan.lap.length, 24.0 * 3.6 / 30.0);

  request.vehicle.width = 9.5;
  const Plan wide = MakePlan(request, MinimumCurvatureOptions{.margin = 0.5});
  EXPECT_EQ(wide.status, PlanStatus::kNoPath);
}

/// Returns the integral of the squared curvature of a closed line through points. The line is
/// evaluated as the center line of a track with little smoothing.
double CurvatureSquare(const std::vector<Vec2>& line) {
  std::vector<TrackPoint> points;
  for (const Vec2& point : line) {
    points.push_back({point, 1.0, 1.0});
  }
  return MeasureLine(Track(points, 1.0), TrackLine()).curvature_square;
}

class TumTracks : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Racing, TumTracks,
                         testing::Values("Norisring", "Hockenheim", "Spielberg", "Silverstone"),
                         [](const auto& test) { return std::string(test.param); });

// Compares our lines with the racing lines of TUM's database, which also minimize curvature. At the
// tightest places of all tracks (1 to 10 % of their points), TUM's lines are 0.72 to 0.77 m from
// the edges. This test therefore uses 0.75 m. Both lines are sampled 5 m apart and evaluated in the
// same way.
TEST_P(TumTracks, HaveNoMoreCurvatureThanTumsRacingLines) {
  const std::filesystem::path folder =
      std::filesystem::path(TRACKBED_SOURCE_DIR) / "tests/data/tracks";
  const std::string name = GetParam();
  const Track track = ReadTrack(folder / (name + ".csv"));
  const CsvExcerpt racing_line =
      ReadCsvExcerpt(folder / (name + "_raceline.csv"), {"# x_m", "y_m"});
  std::vector<Vec2> theirs;
  for (std::size_t row = 0; row < racing_line.table.rows(); ++row) {
    theirs.emplace_back(racing_line.table.at(row, 0), racing_line.table.at(row, 1));
  }
  const MinimumCurvatureLine found = FindMinimumCurvature(track, 0.75);
  ASSERT_EQ(found.refused, "");
  std::vector<Vec2> ours;
  for (std::size_t i = 0; i < theirs.size(); ++i) {
    const double s = track.length() * static_cast<double>(i) / static_cast<double>(theirs.size());
    ours.push_back(ToWorld(track.At(s).pose, {0.0, found.line.At(s).d}));
  }
  const double ratio = CurvatureSquare(ours) / CurvatureSquare(theirs);
  RecordProperty("ratio", std::to_string(ratio));
  EXPECT_LT(ratio, 1.01);
  EXPECT_GT(ratio, 0.9);  // a line with less than 0.9 of this curvature would leave the track
}

}  // namespace
}  // namespace trackbed
