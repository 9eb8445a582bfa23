#include "trackbed/planning/racing/minimum_time.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "tests/tolerance.h"
#include "tests/track/rings.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/optimize/search.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/racing/minimum_curvature.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/track/track_file.h"

// Tests minimum-time racing lines: against the closed form on a ring, against a family of lines
// optimized by another search on hairpins, and against random perturbations of the line.
namespace trackbed {
namespace {

using testing::HasSubstr;

// FindMinimumTime ends when the predicted gain of a step is less than this fraction of the lap
// time.
constexpr double kConvergenceTolerance = 5e-4;

/// Returns the limits of a point mass with a friction circle of 8 m/s^2, without drag.
LapLimits CircleOfFriction() {
  return {
      .diagram = GgvDiagram({.mass = 1000.0, .rolling_mass = 1000.0}, {EllipticSection(8, 8, 8)}),
      .options = {.speed = 60.0},
      .vehicle = {.wheelbase = 2.7}};
}

/// Returns the limits of the car of tests/data/limit_profile: a drive force of 7500 N, a power of
/// 270 kW, drag, and a g-g ellipse of 9 and 8 m/s^2.
LapLimits RacingCar() {
  LapLimits limits = CircleOfFriction();
  limits.diagram = GgvDiagram({.mass = 1200.0,
                               .rolling_mass = 1200.0,
                               .drive_force = 7500.0,
                               .drive_power = 270e3,
                               .drag = 0.75},
                              {EllipticSection(9, 9, 8)});
  limits.options.speed = 90.0;
  return limits;
}

/// Returns a counterclockwise track of two straights joined by half circles, with equal widths on
/// both sides.
Track Hairpins(double straight, double radius, double width) {
  constexpr double kSpacing = 4.0;
  const double lap = 2.0 * straight + 2.0 * kPi * radius;
  const int count = static_cast<int>(std::lround(lap / kSpacing));
  std::vector<TrackPoint> points;
  for (int i = 0; i < count; ++i) {
    const double s = lap * i / count;
    const bool back = s >= 0.5 * lap;
    const double along = back ? s - 0.5 * lap : s;
    Vec2 at{along - 0.5 * straight, -radius};
    if (along > straight) {
      const double angle = (along - straight) / radius;
      at = {0.5 * straight + radius * std::sin(angle), -radius * std::cos(angle)};
    }
    points.push_back({back ? Vec2(-at) : at, width, width});
  }
  return Track(std::move(points));
}

TEST(MinimumTime, OfARingIsItsInnerCircle) {
  // On a circle, v^2 = a r, so a lap takes 2 pi sqrt(r/a), and the smallest circle is the fastest.
  // The search starts from the line of least curvature, which is the largest circle.
  const Track track(RingPoints(50.0, 63, 4.0, 3.0));
  const MinimumTimeLine found = FindMinimumTime(track, 1.5, CircleOfFriction());
  ASSERT_EQ(found.refused, "");
  EXPECT_TRUE(found.improved);
  EXPECT_EQ(found.end, MinimumTimeEnd::kConverged);
  const double fastest = 2.0 * kPi * std::sqrt(48.5 / 8.0);
  EXPECT_NEAR(found.start_time, 2.0 * kPi * std::sqrt(52.5 / 8.0), Tolerance(1e-4 * fastest));
  EXPECT_NEAR(found.time, fastest, Tolerance(kConvergenceTolerance * fastest));
  // The lap time grows with the square root of the radius. A relative error of
  // kConvergenceTolerance in the time is a relative error of twice this size in the radius, which
  // is 5 cm.
  for (double s = 0.0; s < track.length(); s += 1.0) {
    EXPECT_NEAR(found.line.At(s).d, 1.5, Tolerance(2.0 * kConvergenceTolerance * 48.5));
  }
}

/// A family of lines through hairpins. A line follows the outer edge, with a bump to the inner edge
/// in each bend. The bump may have a dip in its middle, between two apexes.
class BumpLines {
 public:
  /// Number of parameters of a line: the position of the bump behind the middle of the bend [m],
  /// the half widths of the bump before and after this position [m], the flatness of the bump, and
  /// the depth of the dip [m].
  static constexpr std::size_t kNumbers = 5;

  BumpLines(const Track& track, double middle, double offset)
      : track_(track),
        basis_(track.length(), 2 * track.points().size()),
        middle_(middle),
        offset_(offset) {}

  [[nodiscard]] double LapTime(std::span<const double> x) const {
    const auto count = static_cast<Eigen::Index>(2 * basis_.count());
    SplineSamples samples;
    samples.values.resize(count, 1);
    for (Eigen::Index i = 0; i < count; ++i) {
      const double s = track_.length() * static_cast<double>(i) / static_cast<double>(count);
      const double away = std::remainder(s - middle_ - x[0], 0.5 * track_.length());
      const double share = std::abs(away) / (away < 0.0 ? x[1] : x[2]);
      const double d = offset_ * (2.0 * std::exp(-std::pow(share, x[3])) - 1.0) -
                       x[4] * std::exp(-4.0 * share * share);
      samples.t.push_back(s);
      samples.weights.push_back(1.0);
      samples.values(i, 0) = std::clamp(d, -offset_, offset_);
    }
    return trackbed::LapTime(track_, TrackLine(basis_, FitClosedSpline(basis_, samples, 4.0)),
                             RacingCar());
  }

 private:
  const Track& track_;
  ClosedSplineBasis basis_;
  double middle_;
  double offset_;
};

TEST(MinimumTime, OfHairpinsIsFasterThanLateAndEarlyApexes) {
  constexpr double kStraight = 100.0;
  constexpr double kBend = 18.0;
  constexpr double kBeside = 1.5;
  constexpr double kWidth = 5.0;
  const Track track = Hairpins(kStraight, kBend, kWidth);
  const BumpLines lines(track, kStraight + 0.5 * kPi * kBend, kWidth - kBeside);
  double fastest = 1e9;
  std::vector<double> best;
  for (const double shift : {-8.0, -4.0, 0.0, 4.0, 8.0}) {
    for (double width = 16.0; width <= 40.0; width += 4.0) {
      for (const double flatness : {2.0, 4.0}) {
        const std::vector<double> x{shift, width, width, flatness, 0.5};
        if (const double time = lines.LapTime(x); time < fastest) {
          fastest = time;
          best = x;
        }
      }
    }
  }
  // A simplex search improves the best of these 70 lines.
  const SearchResult family =
      Search({.lower = {-15.0, 8.0, 8.0, 1.5, 0.0},
              .upper = {15.0, 60.0, 60.0, 8.0, 3.0},
              .start = best,
              .objective = [&](std::span<const double> x) { return lines.LapTime(x); }},
             {.method = SearchMethod::kNelderMead, .evaluations = 200, .tolerance = 1e-4}, 1);
  ASSERT_TRUE(family.ok());
  const MinimumTimeLine found = FindMinimumTime(track, kBeside, RacingCar());
  ASSERT_EQ(found.refused, "");
  EXPECT_EQ(found.end, MinimumTimeEnd::kConverged);
  EXPECT_LT(found.time, family.value * (1.0 + kConvergenceTolerance));
  // The lower bound of the lap time considers only the motion in the direction of the straights.
  // From the apex of one bend to the apex of the other bend, the car moves in this direction by the
  // straight and by both inner edges. In this direction, the car starts and ends at rest, and
  // accelerates with at most 9 m/s^2.
  EXPECT_GT(found.time, 4.0 * std::sqrt((kStraight + 2.0 * (kBend - kWidth + kBeside)) / 9.0));
}

TEST(MinimumTime, CannotBeBetteredNearby) {
  constexpr double kBeside = 1.2;
  const Track track = Hairpins(40.0, 15.0, 4.0);
  const MinimumTimeLine found = FindMinimumTime(track, kBeside, RacingCar());
  ASSERT_EQ(found.refused, "");
  // The test adds bumps of random width and position to the line, and clips the sum to the bounds
  // at the knots of a spline.
  std::mt19937 random(17);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int trial = 0; trial < 60; ++trial) {
    const double middle = 0.5 * (unit(random) + 1.0) * track.length();
    const double width = 8.0 + 30.0 * std::abs(unit(random));
    const double height = 0.5 * unit(random);
    SplineSamples samples;
    const auto count = static_cast<Eigen::Index>(2 * track.points().size());
    samples.values.resize(count, 1);
    for (Eigen::Index i = 0; i < count; ++i) {
      const double s = track.length() * static_cast<double>(i) / static_cast<double>(count);
      const double away = std::remainder(s - middle, track.length()) / width;
      samples.t.push_back(s);
      samples.weights.push_back(1.0);
      samples.values(i, 0) = std::clamp(found.line.At(s).d + height * std::exp(-away * away),
                                        -4.0 + kBeside, 4.0 - kBeside);
    }
    const ClosedSplineBasis basis(track.length(), static_cast<std::size_t>(count));
    const TrackLine other(basis, FitClosedSpline(basis, samples, 4.0));
    EXPECT_GT(LapTime(track, other, RacingCar()), (1.0 - kConvergenceTolerance) * found.time)
        << trial;
  }
}

/// Two hairpins and a car whose steering rate limits the speed.
struct SteeredLap {
  Track track = Hairpins(60.0, 18.0, 4.0);
  LapLimits limits = CircleOfFriction();
};

TEST(MinimumTime, KnowsTheSteeringRate) {
  SteeredLap lap;
  const MinimumTimeLine free = FindMinimumTime(lap.track, 1.2, lap.limits);
  lap.limits.vehicle.steering_rate = 0.06;  // [rad/s]
  const MinimumTimeLine found = FindMinimumTime(lap.track, 1.2, lap.limits);
  ASSERT_EQ(found.refused + free.refused, "");
  EXPECT_TRUE(found.improved);
  EXPECT_LT(found.time, found.start_time);
  // With a limited steering rate, the lap takes longer than without the limit. With a limited
  // steering rate, the found line takes less time than the line that was optimized without the
  // limit.
  EXPECT_GT(found.time, free.time);
  EXPECT_LT(found.time, 0.99 * LapTime(lap.track, free.line, lap.limits));
}

TEST(MinimumTime, KnowsTheUndersteerOfTheTyres) {
  // With tyres, the car must steer by K v^2 kappa more, which is 0.07 rad at 8 m/s^2. With tyres,
  // the line found without them is slower, and the search finds a faster line.
  SteeredLap lap;
  lap.limits.vehicle.steering_rate = 0.06;  // [rad/s]
  const MinimumTimeLine rolling = FindMinimumTime(lap.track, 1.2, lap.limits);
  lap.limits.vehicle.mass = 1000.0;
  lap.limits.vehicle.yaw_inertia = 1500.0;
  lap.limits.vehicle.cg_to_rear = 1.35;
  lap.limits.vehicle.cornering_stiffness_front = 40e3;
  lap.limits.vehicle.cornering_stiffness_rear = 90e3;
  const MinimumTimeLine found = FindMinimumTime(lap.track, 1.2, lap.limits);
  ASSERT_EQ(found.refused + rolling.refused, "");
  EXPECT_TRUE(found.improved);
  EXPECT_GT(found.time, 1.01 * rolling.time);
  EXPECT_LT(found.time, LapTime(lap.track, rolling.line, lap.limits));
  EXPECT_EQ(found.end, MinimumTimeEnd::kConverged);
}

TEST(MinimumTime, KeepsTheCarsSmallestRadius) {
  SteeredLap lap;
  const double radius =
      MeasureLine(lap.track, FindMinimumCurvature(lap.track, 1.2).line).radius_min;
  // The minimum radius is 0.5 m larger than that of the line of least curvature.
  lap.limits.curvature_max = 1.0 / (radius + 0.5);
  const MinimumTimeLine found = FindMinimumTime(lap.track, 1.2, lap.limits);
  ASSERT_EQ(found.refused, "");
  // The optimizer enforces the radius at stations 2 m apart. FindMinimumTime rejects a line that
  // violates the radius by more than 1e-3 at stations 1 m apart. Between these stations, the radius
  // is hardly smaller.
  EXPECT_GT(MeasureLine(lap.track, found.line).radius_min, (radius + 0.5) * (1.0 - 2e-3));
}

TEST(MinimumTime, RefusesATrackThatIsTooTightForTheCar) {
  // The largest circle on this ring has a radius of 17.5 m. No quadratic program for the lap time
  // is solved, because it would have no solution.
  LapLimits limits = CircleOfFriction();
  limits.curvature_max = 1.0 / 20.0;
  const MinimumTimeLine found = FindMinimumTime(Track(RingPoints(15.0, 24, 4.0, 3.0)), 1.5, limits);
  EXPECT_THAT(found.refused,
              HasSubstr("the car turns on a radius of 20 m at least; the widest line found within "
                        "the margins bends on 17.5 m at s = "));
  EXPECT_EQ(found.iterations, 0);
  EXPECT_NEAR(found.sharpest, 1.0 / 17.5, Tolerance(1e-4));
}

TEST(MinimumTime, FindsTheLineWithTheWidestBends) {
  // Between two straights, a half circle of the center line with radius r leaves room for a half
  // circle of radius r + w that touches the outer edge in its whole bend, for w = half the width
  // less the distance to the edges. A closed line through both bends cannot have larger bends: it
  // lies within the convex curve that the outer edges bound, and turns by pi on each side.
  const Track track = Hairpins(60.0, 18.0, 4.0);
  const double beside = 1.2;
  LapLimits limits = CircleOfFriction();
  const double least = MeasureLine(track, FindMinimumCurvature(track, beside).line).radius_min;
  const double widest = 18.0 + 4.0 - beside;
  ASSERT_LT(least, widest);
  // The points of the track are 4 m apart, and its smoothing rounds the steps of the curvature, so
  // the outer edge is up to 3 % wider than the circle.
  limits.curvature_max = 1.0 / (1.04 * widest);
  const MinimumTimeLine found = FindMinimumTime(track, beside, limits);
  EXPECT_THAT(found.refused, HasSubstr("the widest line found within the margins bends on "));
  EXPECT_GT(1.0 / found.sharpest, least);
  EXPECT_NEAR(1.0 / found.sharpest, widest, Tolerance(0.04 * widest));
}

TEST(MinimumTime, IsAFunctionOfItsArguments) {
  const Track track = Hairpins(40.0, 15.0, 4.0);
  const MinimumTimeLine once = FindMinimumTime(track, 1.2, RacingCar(), 3);
  const MinimumTimeLine twice = FindMinimumTime(track, 1.2, RacingCar(), 3);
  EXPECT_EQ(once.line.coefficients(), twice.line.coefficients());
  EXPECT_EQ(once.time, twice.time);
}

TEST(MinimumTime, RefusesATrackThatIsTooNarrow) {
  const Track track(RingPoints(50.0, 63, 1.0, 1.0));
  EXPECT_THAT(FindMinimumTime(track, 1.4, RacingCar()).refused,
              HasSubstr("the track is 2 m wide at s = 0 m; the car and its margins need 2.8 m"));
}

/// Returns a request for laps of the reference car on hairpins, with a friction circle of 8 m/s^2.
PlanRequest LimitLaps(int laps) {
  PlanRequest request;
  request.vehicle = ReferenceCar();
  request.vehicle.steering_rate = 0.6;
  request.on_track = {std::make_shared<const Track>(Hairpins(60.0, 18.0, 4.0)), laps};
  request.start = request.on_track.track->At(0.0).pose;
  request.speed = {.speed = 30.0, .acceleration = 1.5, .deceleration = 2.0};
  request.limits = SpeedAtLimit{.diagram = CircleOfFriction().diagram, .options = {.share = 0.9}};
  return request;
}

/// Returns why a plan is refused.
template <typename Options>
std::string RefusalOf(const PlanRequest& request, const Options& options) {
  const Plan plan = MakePlan(request, options);
  EXPECT_EQ(plan.status, PlanStatus::kNoPath);
  return plan.reason;
}

TEST(MinimumTime, NamesTheMarginOfATrackThatIsTooNarrow) {
  PlanRequest request = LimitLaps(1);
  // The track is 8 m wide, the car 1.8 m: a margin of 3.1 m is the largest.
  request.vehicle.width = 1.8;
  for (const double margin : {3.2, 10.0}) {
    const auto names = HasSubstr("; plan.margin must be at most 3.09 m");
    EXPECT_THAT(RefusalOf(request, MinimumTimeOptions{.margin = margin}), names);
    EXPECT_THAT(RefusalOf(request, MinimumCurvatureOptions{.margin = margin}), names);
  }
  const Plan widest = MakePlan(request, MinimumCurvatureOptions{.margin = 3.09});
  EXPECT_TRUE(widest.ok()) << widest.reason;
  request.vehicle.width = 8.5;
  EXPECT_THAT(RefusalOf(request, MinimumTimeOptions{}), HasSubstr("; the car alone is 8.5 m wide"));
}

TEST(MinimumTime, NamesTheRemedyOfATrackThatIsTooTight) {
  // With a margin of 0, the widest bend has a radius of 21.1 m, and with a margin of 2 m, 19.1 m.
  PlanRequest request = LimitLaps(1);
  request.vehicle.width = 1.8;
  request.vehicle.steering_limit = SteeringForCurvature(request.vehicle, 1.0 / 20.2);
  EXPECT_THAT(RefusalOf(request, MinimumTimeOptions{.margin = 2.0}),
              HasSubstr("; plan.margin: 0 leaves room for a wide enough line, 2 does not"));
  request.vehicle.steering_limit = SteeringForCurvature(request.vehicle, 1.0 / 25.0);
  EXPECT_THAT(RefusalOf(request, MinimumTimeOptions{.margin = 2.0}),
              HasSubstr("; the track needs a car whose wheels turn by "));
}

TEST(MinimumTime, IsPlannedWithTheLapTimeThatItStates) {
  const PlanRequest request = LimitLaps(3);
  const Plan plan = MakePlan(request, MinimumTimeOptions{.margin = 0.5});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  const auto* own = plan.diagnostics.planner.GetIf<MinimumTimeDiagnostics>();
  ASSERT_NE(own, nullptr);
  EXPECT_EQ(own->end, "converged");
  EXPECT_LT(own->lap_time, own->minimum_curvature_lap_time);
  ASSERT_FALSE(plan.notes.empty());
  EXPECT_THAT(plan.notes.front(), HasSubstr("less than on the line of least curvature"));
  // The second lap starts and ends at racing speed. The plan uses clothoids and stations 0.5 m
  // apart, but the optimizer uses stations 1 m apart. The profile uses the smaller acceleration at
  // the two ends of each interval, so its error is proportional to the length of the intervals. The
  // acceleration of up to 10 m/s^2 changes by up to 1 m/s^2 over 1 m.
  ASSERT_EQ(plan.laps.lines.size(), 4U);
  const double second = plan.reference.speed.TimeAt(plan.laps.lines[2]) -
                        plan.reference.speed.TimeAt(plan.laps.lines[1]);
  EXPECT_NEAR(second, own->lap_time, Tolerance(0.01 * own->lap_time));
  // The path keeps the margin at every point of the track.
  const Track& track = *request.on_track.track;
  for (double s = plan.laps.lines[1]; s < plan.laps.lines[2]; s += 1.0) {
    const TrackPlace place = track.Locate(plan.reference.path.At(s).pose.position());
    const TrackEdges edges = track.EdgesAt(place.s);
    // The optimizer enforces the margin at stations 2 m apart. Between these stations, the line
    // deviates by at most d'' 2^2/8 = 0.034 m, because the second derivative d'' of its offset is
    // below 1/15 1/m.
    const double beside = 0.5 * request.vehicle.width + 0.5 - 0.034;
    EXPECT_LE(place.offset, edges.left - beside);
    EXPECT_GE(place.offset, edges.right + beside);
  }
}

TEST(MinimumTime, SaysThatItStoppedEarly) {
  const Plan plan = MakePlan(LimitLaps(1), MinimumTimeOptions{.margin = 0.5, .iterations = 1});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  ASSERT_FALSE(plan.notes.empty());
  EXPECT_THAT(plan.notes.front(), HasSubstr("stopped after 1 step, which gained"));
  EXPECT_EQ(plan.diagnostics.planner.GetIf<MinimumTimeDiagnostics>()->end, "iteration_limit");
}

TEST(MinimumTime, NeedsSpeedsAtTheLimit) {
  PlanRequest request = LimitLaps(1);
  request.limits.reset();
  const Plan plan = MakePlan(request, MinimumTimeOptions{});
  EXPECT_EQ(plan.status, PlanStatus::kNoPath);
  EXPECT_THAT(plan.reason, HasSubstr("needs speeds at the limit"));
}

struct RaceTrack {
  const char* name;
  const char* file;
  int iterations;  // few iterations, because an iteration takes a second per kilometer of track
  double gain;     // Minimum gain in lap time with this number of iterations.
};

class RaceTracks : public testing::TestWithParam<RaceTrack> {};
INSTANTIATE_TEST_SUITE_P(
    Racing, RaceTracks,
    testing::Values(RaceTrack{"Norisring", "tests/data/tracks/Norisring.csv", 3, 0.01},
                    RaceTrack{"Hockenheim", "tests/data/tracks/Hockenheim.csv", 1, 0.0},
                    RaceTrack{"Spielberg", "tests/data/tracks/Spielberg.csv", 1, 0.0},
                    RaceTrack{"Silverstone", "tests/data/tracks/Silverstone.csv", 1, 0.0},
                    RaceTrack{"kidney", "scenarios/tracks/kidney.csv", 40, 0.02}),
    [](const auto& test) { return std::string(test.param.name); });

TEST_P(RaceTracks, AreFasterThanTheLineOfLeastCurvature) {
  const RaceTrack& race = GetParam();
  const Track track = ReadTrack(std::filesystem::path(TRACKBED_SOURCE_DIR) / race.file);
  const MinimumTimeLine found = FindMinimumTime(track, 0.75, RacingCar(), race.iterations);
  ASSERT_EQ(found.refused, "");
  EXPECT_TRUE(found.improved);
  EXPECT_LT(found.time, (1.0 - race.gain) * found.start_time);
  EXPECT_EQ(found.time, LapTime(track, found.line, RacingCar()));
  for (double s = 0.0; s < track.length(); s += 1.0) {
    const TrackEdges edges = track.EdgesAt(s);
    // Between stations, at most 2.6 m apart, the line deviates by up to d'' 2.6^2/8 = 0.085 m,
    // because the second derivative d'' of its offset is below 1/10 1/m.
    EXPECT_LE(found.line.At(s).d, edges.left - 0.75 + Tolerance(0.085));
    EXPECT_GE(found.line.At(s).d, edges.right + 0.75 - Tolerance(0.085));
  }
  RecordProperty("gain", std::to_string(1.0 - found.time / found.start_time));
}

}  // namespace
}  // namespace trackbed
