#include "trackbed/optimize/smooth_program.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/tolerance.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// The point of the unit circle that is nearest to (2, 1), with x at most `most`.
SmoothProgram NearestOnCircle(double most) {
  SmoothProgram program;
  program.lower = Eigen::Vector2d(-3.0, -3.0);
  program.upper = Eigen::Vector2d(3.0, 3.0);
  program.start = Eigen::Vector2d(-0.5, 0.3);
  program.equal_count = 1;
  program.at_most_0_count = 1;
  program.evaluate = [most](const Eigen::VectorXd& x, SmoothValues& values) {
    const Eigen::Vector2d apart = x - Eigen::Vector2d(2.0, 1.0);
    values.objective = apart.squaredNorm();
    values.gradient = 2.0 * apart;
    values.equal[0] = x.squaredNorm() - 1.0;
    values.equal_rows.row(0) = 2.0 * x.transpose();
    values.at_most_0[0] = x[0] - most;
    values.at_most_0_rows(0, 0) = 1.0;
  };
  return program;
}

// The objective is quadratic along the circle: x is exact to the root of the tolerance of f.
const double kRootOfTolerance = Tolerance(1e-5);

TEST(SmoothProgram, IsSolvedUnderAnEquality) {
  const SmoothSolution found = Minimize(NearestOnCircle(3.0), 100, 1e-10);
  ASSERT_TRUE(found.ok);
  EXPECT_LE((found.x - Eigen::Vector2d(2.0, 1.0) / std::sqrt(5.0)).norm(), kRootOfTolerance);
  EXPECT_LE(std::abs(found.x.norm() - 1.0), Tolerance(1e-9));
}

TEST(SmoothProgram, IsSolvedAtAnActiveInequality) {
  const SmoothSolution found = Minimize(NearestOnCircle(0.6), 100, 1e-10);
  ASSERT_TRUE(found.ok);
  EXPECT_LE((found.x - Eigen::Vector2d(0.6, 0.8)).norm(), Tolerance(1e-8));
}

TEST(SmoothProgram, ReturnsThePointOfLeastViolationIfThereIsNoSolution) {
  // x <= -2 is 1 away from the circle.
  const SmoothSolution found = Minimize(NearestOnCircle(-2.0), 100, 1e-10);
  EXPECT_FALSE(found.ok);
  EXPECT_GT(found.violation, 0.1);
  EXPECT_EQ(found.x.size(), 2);
}

TEST(SmoothProgram, StaysWithinTheBudget) {
  const SmoothSolution found = Minimize(NearestOnCircle(3.0), 3, 1e-10);
  EXPECT_LE(found.evaluations, 3);
  EXPECT_GE(found.evaluations, 1);
}

TEST(SmoothProgram, RefusesBoundsThatAreNone) {
  SmoothProgram program = NearestOnCircle(1.0);
  program.lower[0] = 4.0;
  EXPECT_THROW(Minimize(program, 10), InternalError);
  program.lower[0] = -HUGE_VAL;
  EXPECT_THROW(Minimize(program, 10), InternalError);
}

}  // namespace
}  // namespace trackbed
