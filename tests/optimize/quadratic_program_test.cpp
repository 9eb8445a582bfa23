#include "trackbed/optimize/quadratic_program.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <random>

#include "tests/tolerance.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Returns a program with two variables: minimize (x - a)^2/2 + (y - b)^2/2 subject to x + y <=
/// sum.
QuadraticProgram Plane(double a, double b, double sum) {
  QuadraticProgram program;
  program.hessian.setIdentity(2, 2);
  program.linear.resize(2);
  program.linear << -a, -b;
  program.constraints.resize(1, 2);
  program.constraints << 1.0, 1.0;
  program.bounds.resize(1);
  program.bounds << sum;
  return program;
}

TEST(QuadraticProgram, WithoutAConstraintInTheWayIsTheSystemsSolution) {
  const QuadraticSolution solution = Solve(Plane(1.0, 2.0, 4.0));
  EXPECT_TRUE(solution.ok);
  EXPECT_EQ(solution.solves, 0);
  EXPECT_NEAR(solution.x[0], 1.0, Tolerance(1e-15));
  EXPECT_NEAR(solution.x[1], 2.0, Tolerance(1e-15));
}

TEST(QuadraticProgram, OnAConstraintIsTheProjection) {
  // The solution is the projection of (1, 2) onto x + y = 1. The sum 3 exceeds 1 by 2, so each
  // variable decreases by 1.
  const QuadraticSolution solution = Solve(Plane(1.0, 2.0, 1.0));
  EXPECT_TRUE(solution.ok);
  EXPECT_NEAR(solution.x[0], 0.0, Tolerance(1e-9));
  EXPECT_NEAR(solution.x[1], 1.0, Tolerance(1e-9));
}

TEST(QuadraticProgram, RandomOnesKeepTheKarushKuhnTuckerConditions) {
  // At the minimum of a convex program, the gradient H x + f is a linear combination of the active
  // constraint rows with factors <= 0. The test computes these factors by least squares. The solver
  // meets the constraints to 1e-9. The rows have a norm of at most 10, so the error of the gradient
  // is about 1e-7 of the largest eigenvalue of H.
  std::mt19937 random(71);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto fill = [&](auto&& matrix) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i) {
      matrix.data()[i] = uniform(random);
    }
  };
  int constrained = 0;
  for (int round = 0; round < 200; ++round) {
    SCOPED_TRACE(fmt::format("round {}", round));
    const int n = 2 + round % 19;
    QuadraticProgram program;
    QuadraticProgram::Matrix root(n, n);
    fill(root);
    program.hessian = root * root.transpose();
    program.hessian.diagonal().array() += 0.1;
    program.linear.resize(n);
    fill(program.linear);
    // The constraints are the box abs(x) <= 0.3 and n half spaces that contain the origin.
    program.constraints.setZero(3 * n, n);
    program.constraints.topRows(n).setIdentity();
    program.constraints.middleRows(n, n) = -program.constraints.topRows(n);
    for (int row = 2 * n; row < 3 * n; ++row) {
      for (int column = 0; column < n; ++column) {
        program.constraints(row, column) = uniform(random);
      }
    }
    program.bounds.setConstant(3 * n, 0.3);
    const QuadraticSolution solution = Solve(program);
    ASSERT_TRUE(solution.ok) << solution.violation;
    constrained += solution.solves > 0 ? 1 : 0;

    const Eigen::VectorXd gradient = program.hessian * solution.x + program.linear;
    const Eigen::VectorXd slack = program.bounds - program.constraints * solution.x;
    EXPECT_GE(slack.minCoeff(), -Tolerance(1e-9));
    std::vector<int> active;
    for (int i = 0; i < 3 * n; ++i) {
      if (slack[i] < 1e-7) {
        active.push_back(i);
      }
    }
    Eigen::MatrixXd rows(n, active.size());
    for (std::size_t i = 0; i < active.size(); ++i) {
      rows.col(static_cast<int>(i)) = program.constraints.row(active[i]).transpose();
    }
    Eigen::VectorXd residual = gradient;
    if (!active.empty()) {
      const Eigen::VectorXd multipliers =
          rows.completeOrthogonalDecomposition().solve(Eigen::VectorXd(-gradient));
      EXPECT_GE(multipliers.minCoeff(), -Tolerance(1e-6));
      residual += rows * multipliers;
    }
    EXPECT_LT(residual.norm(), Tolerance(1e-6));
  }
  EXPECT_GT(constrained, 100);
}

TEST(QuadraticProgram, SaysWhenConstraintsContradictEachOther) {
  QuadraticProgram program = Plane(0.0, 0.0, 1.0);
  program.constraints.resize(2, 2);
  program.constraints << 1.0, 1.0, -1.0, -1.0;
  program.bounds.resize(2);
  program.bounds << -1.0, -1.0;  // x + y <= -1 and x + y >= 1
  const QuadraticSolution solution = Solve(program);
  EXPECT_FALSE(solution.ok);
  EXPECT_GE(solution.violation, 1.0 - 1e-6);  // The point with the smallest violation is halfway
                                              // between the two bounds.
  EXPECT_TRUE(solution.x.allFinite());
}

TEST(QuadraticProgram, IsAFunctionOfItsInput) {
  const QuadraticProgram program = Plane(1.0, 2.0, 1.0);
  EXPECT_EQ(Solve(program).x, Solve(program).x);
}

TEST(QuadraticProgram, RefusesWhatIsNone) {
  QuadraticProgram flat = Plane(1.0, 2.0, 1.0);
  flat.hessian(1, 1) = 0.0;
  EXPECT_THROW(Solve(flat), InternalError);
  QuadraticProgram nan = Plane(1.0, 2.0, 1.0);
  nan.linear[0] = std::nan("");
  EXPECT_THROW(Solve(nan), InternalError);
  QuadraticProgram sizes = Plane(1.0, 2.0, 1.0);
  sizes.linear.resize(1);
  EXPECT_THROW(Solve(sizes), InternalError);
}

}  // namespace
}  // namespace trackbed
