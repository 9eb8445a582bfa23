#include "trackbed/planning/curves/drivable_curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/planning/poses.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/planning/common/curvature_steps.h"
#include "trackbed/planning/curves/dubins.h"
#include "trackbed/planning/curves/reeds_shepp.h"

namespace trackbed {
namespace {

CurveDrive Drive(double speed) {
  return {.speed = speed, .min_speed = 0.3, .radius = 1.1 * ReferenceCar().min_turning_radius()};
}

std::vector<Segment> Pieces(const Pose2& from, const Pose2& to, const ShortestCurve& word,
                            const CurveDrive& drive) {
  return DrivablePieces(ReferenceCar(), from, to, word, drive);
}

Pose2 End(const Pose2& from, const std::vector<Segment>& pieces) {
  const Path path(from, pieces);
  return path.At(path.length()).pose;
}

/// Returns the lowest speed at a step of curvature; 0 if the car must stop at a step.
double SlowestStep(const std::vector<Segment>& pieces, const CurveDrive& drive) {
  const StepSpeeds steps = PlanSteps(ReferenceCar(), pieces, drive.min_speed);
  double slowest = steps.stops.empty() ? drive.speed : 0.0;
  for (const SpeedCap& cap : steps.caps) {
    slowest = std::min(slowest, cap.speed);
  }
  return slowest;
}

TEST(DrivablePieces, TurnOnArcsFourTimesAsLongAsTheirRamps) {
  const double speed = 3.0;
  // The turns lead to the left or to the right. The smallest turns are only rounding errors.
  for (const double phi : {3e-12, 1e-9, 1e-6, -1e-3, 0.05}) {
    SCOPED_TRACE(phi);
    const Pose2 goal{40.0, 0.0, phi};
    const CurveDrive drive = Drive(speed);
    const std::vector<Segment> pieces = Pieces({}, goal, Dubins({}, goal, drive.radius), drive);
    EXPECT_LE(Apart(End({}, pieces), goal), Tolerance(1e-9));
    EXPECT_EQ(SlowestStep(pieces, drive), speed);
    // A turn by the angle phi on two steering ramps has the curvature kappa = sqrt(omega phi/(4 L
    // v)). The wider arc between the ramps adds less than a tenth to this turn. The last turn of
    // the curve has this sign of the curvature.
    const double sharpest = (pieces.end() - 2)->curvature;
    const double expected = std::copysign(
        std::sqrt(ReferenceCar().steering_rate * std::abs(phi) / (4.0 * 2.7 * speed)), phi);
    EXPECT_NEAR(sharpest, expected, 0.1 * std::abs(expected));
  }
}

TEST(DrivablePieces, AreTheWordWhereItsArcsHaveRoom) {
  Random random(3);
  const CurveDrive drive = Drive(3.0);
  int unchanged = 0;
  for (int i = 0; i < 2000; ++i) {
    const Pose2 goal = RandomPose(random, 40.0);
    const ShortestCurve word = Dubins({}, goal, drive.radius);
    const bool has_room =
        HasRoomForRamps(ReferenceCar(), word.radius * word.pieces[0].sweep, drive) &&
        HasRoomForRamps(ReferenceCar(), word.radius * word.pieces[2].sweep, drive);
    if (has_room) {
      EXPECT_EQ(Pieces({}, goal, word, drive), ToSegments(word));
      ++unchanged;
    }
  }
  EXPECT_GT(unchanged, 500);
}

TEST(DrivablePieces, MeetTheirEndAndAreNeverSlower) {
  Random random(4);
  int changed = 0;
  for (int i = 0; i < 3000; ++i) {
    const Pose2 from = RandomPose(random, 30.0);
    const Pose2 goal = RandomPose(random, 30.0);
    const CurveDrive drive = Drive(random.Uniform(0.5, 8.0));
    for (const ShortestCurve& word : ReedsSheppWords(from, goal, drive.radius)) {
      const std::vector<Segment> pieces = Pieces(from, goal, word, drive);
      const std::vector<Segment> shortest = ToSegments(word);
      // The tolerance allows for rounding in sums of a few dozen meters, with segments that turn by
      // up to 2 pi.
      ASSERT_LE(Apart(End(from, pieces), goal), Tolerance(1e-9));
      if (pieces != shortest) {
        ASSERT_GE(SlowestStep(pieces, drive), SlowestStep(shortest, drive) - Tolerance(1e-9));
        ++changed;
      }
    }
  }
  EXPECT_GT(changed, 1000);
}

TEST(DrivablePieces, LeaveRoomForTheStepBesideThem) {
  // The next leg begins with a sharp arc. The curve must end with a straight that has room for the
  // steering ramp of this arc.
  const Pose2 goal{30.0, 0.0, 1e-7};
  CurveDrive drive = Drive(3.0);
  drive.after = {1.0 / drive.radius, 1};
  std::vector<Segment> pieces = Pieces({}, goal, Dubins({}, goal, drive.radius), drive);
  EXPECT_LE(Apart(End({}, pieces), goal), Tolerance(1e-9));
  const std::vector<Segment> bend{{.length = 10.0, .curvature = drive.after.curvature}};
  AppendPieces(pieces, bend);
  EXPECT_NEAR(SlowestStep(pieces, drive), StepSpeed(ReferenceCar(), 0.0, 1.0 / drive.radius),
              Tolerance(1e-9));
}

TEST(DrivablePieces, KeepTheWordWhereNothingElseFits) {
  // The curve must turn by 0.2 rad within about 1 m. Even at 0.3 m/s, a gentler arc would have to
  // be 1 m long.
  const Pose2 goal{1.12, 0.112, 0.2};
  const CurveDrive drive = Drive(3.0);
  const ShortestCurve word = Dubins({}, goal, drive.radius);
  EXPECT_EQ(Pieces({}, goal, word, drive), ToSegments(word));
}

TEST(AppendPieces, UnitesNeighborsOfOneCurvature) {
  std::vector<Segment> path{{.length = 2.0}};
  AppendPieces(path, {{.length = 3.0}, {.length = 1.0, .curvature = 0.1}});
  AppendPieces(path, {{.length = 1.0, .curvature = 0.1}, {.length = 1.0, .direction = -1}});
  const std::vector<Segment> expected{
      {.length = 5.0}, {.length = 2.0, .curvature = 0.1}, {.length = 1.0, .direction = -1}};
  EXPECT_EQ(path, expected);
  EXPECT_EQ(LastBend(path).direction, -1);
}

}  // namespace
}  // namespace trackbed
