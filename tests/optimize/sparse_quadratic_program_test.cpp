#include "trackbed/optimize/sparse_quadratic_program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include "tests/tolerance.h"
#include "trackbed/core/error.h"
#include "trackbed/optimize/quadratic_program.h"

namespace trackbed {
namespace {

/// Returns a program that minimizes |x - c|^2/2 within a box. The variables are independent.
SparseQuadraticProgram Nearest(const Eigen::VectorXd& c, double lower, double upper) {
  const Eigen::Index n = c.size();
  SparseQuadraticProgram program;
  program.hessian.resize(n, n);
  program.hessian.setIdentity();
  program.linear = -c;
  program.constraints = program.hessian;
  program.lower = Eigen::VectorXd::Constant(n, lower);
  program.upper = Eigen::VectorXd::Constant(n, upper);
  return program;
}

TEST(SparseQuadraticProgram, CutsToABox) {
  const Eigen::VectorXd c = Eigen::VectorXd::LinSpaced(2001, -10.0, 10.0);
  const SparseQuadraticSolution solution =
      Solve(Nearest(c, -3.0, 4.0), Eigen::VectorXd::Zero(c.size()));
  ASSERT_TRUE(solution.ok);
  EXPECT_GT(solution.iterations, 0);
  for (Eigen::Index i = 0; i < c.size(); ++i) {
    // IPOPT stops at a complementarity (slack times multiplier) of 1e-9. If the multiplier of a
    // bound is near 0, x has an error of up to sqrt(1e-9) = 3e-5.
    EXPECT_NEAR(solution.x[i], std::clamp(c[i], -3.0, 4.0), Tolerance(1e-4)) << c[i];
  }
  EXPECT_LE(solution.violation, 1e-7);
}

TEST(SparseQuadraticProgram, HasMultipliersAndMayPredictItsSteps) {
  // The optimality condition is x - c + lambda = 0. The multiplier lambda is c minus the bound at
  // an active bound, and 0 at an inactive bound.
  const Eigen::VectorXd c = Eigen::VectorXd::LinSpaced(201, -10.0, 10.0);
  for (const InteriorSteps steps :
       {InteriorSteps::kLineSearch, InteriorSteps::kPredictorCorrector}) {
    const SparseQuadraticSolution solution =
        Solve(Nearest(c, -3.0, 4.0), Eigen::VectorXd::Zero(c.size()), steps);
    ASSERT_TRUE(solution.ok);
    for (Eigen::Index i = 0; i < c.size(); ++i) {
      // The tolerance is derived in CutsToABox.
      const double expected = std::clamp(c[i], -3.0, 4.0);
      EXPECT_NEAR(solution.x[i], expected, Tolerance(1e-4)) << c[i];
      EXPECT_NEAR(solution.multipliers[i], c[i] - expected, Tolerance(1e-4)) << c[i];
    }
  }
}

TEST(SparseQuadraticProgram, EqualsTheDenseSolver) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const auto fill = [&](Eigen::MatrixXd matrix) {
    return Eigen::MatrixXd(matrix.unaryExpr([&](double) { return normal(random); }));
  };
  for (int trial = 0; trial < 10; ++trial) {
    constexpr int kVariables = 12;
    constexpr int kRows = 20;
    const Eigen::MatrixXd root = fill(Eigen::MatrixXd(kVariables, kVariables));
    const Eigen::MatrixXd hessian =
        root.transpose() * root + Eigen::MatrixXd::Identity(kVariables, kVariables);
    const Eigen::VectorXd linear = 5.0 * fill(Eigen::MatrixXd(kVariables, 1));
    const Eigen::MatrixXd rows = fill(Eigen::MatrixXd(kRows, kVariables));
    const Eigen::VectorXd upper = fill(Eigen::MatrixXd(kRows, 1)).cwiseAbs();
    const Eigen::VectorXd lower = -2.0 * upper;

    QuadraticProgram dense;
    dense.hessian = hessian;
    dense.linear = linear;
    dense.constraints.resize(2 * kRows, kVariables);
    dense.constraints << rows, -rows;
    dense.bounds.resize(2 * kRows);
    dense.bounds << upper, -lower;
    const QuadraticSolution expected = Solve(dense);
    ASSERT_TRUE(expected.ok);

    const SparseQuadraticProgram program{hessian.sparseView(), linear, rows.sparseView(), lower,
                                         upper};
    const SparseQuadraticSolution solution = Solve(program, Eigen::VectorXd::Zero(kVariables));
    ASSERT_TRUE(solution.ok);
    const auto value = [&](const Eigen::VectorXd& x) {
      return 0.5 * x.dot(hessian * x) + linear.dot(x);
    };
    // Both objective values are within 1e-7 of the minimum: the complementarity is 1e-9 for each of
    // 40 bounds, and a violation of 1e-9 times multipliers of about 10 adds 1e-8. All eigenvalues
    // of the Hessian are at least 1, so x is within sqrt(2 x 1e-7) = 4.5e-4 of the minimum point.
    EXPECT_NEAR(value(solution.x), value(expected.x), Tolerance(1e-7));
    EXPECT_LT((solution.x - expected.x).norm(), Tolerance(5e-4));
  }
}

TEST(SparseQuadraticProgram, TakesAHessianThatIsSingular) {
  // The objective (x + y - 3)^2/2 depends only on the sum of the two variables.
  SparseQuadraticProgram program = Nearest(Eigen::Vector2d(3.0, 3.0), 0.0, 10.0);
  Eigen::Matrix2d ones = Eigen::Matrix2d::Ones();
  program.hessian = ones.sparseView();
  const SparseQuadraticSolution solution = Solve(program, Eigen::Vector2d(0.0, 0.0));
  ASSERT_TRUE(solution.ok);
  EXPECT_NEAR(solution.x.sum(), 3.0, Tolerance(1e-6));
}

TEST(SparseQuadraticProgram, SaysThatBoundsCannotBeMet) {
  // The constraints are infeasible: x must be at most 1 and at least 2.
  SparseQuadraticProgram program = Nearest(Eigen::VectorXd::Zero(1), 2.0, 3.0);
  Eigen::MatrixXd rows = Eigen::MatrixXd::Ones(2, 1);
  program.constraints = rows.sparseView();
  program.lower = Eigen::Vector2d(2.0, 0.0);
  program.upper = Eigen::Vector2d(3.0, 1.0);
  const SparseQuadraticSolution solution = Solve(program, Eigen::VectorXd::Zero(1));
  EXPECT_FALSE(solution.ok);
  EXPECT_GT(solution.violation, 0.3);
}

TEST(SparseQuadraticProgram, IsAFunctionOfItsArguments) {
  const Eigen::VectorXd c = Eigen::VectorXd::LinSpaced(300, -10.0, 10.0);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(c.size());
  EXPECT_EQ(Solve(Nearest(c, -3.0, 4.0), zero).x, Solve(Nearest(c, -3.0, 4.0), zero).x);
}

TEST(SparseQuadraticProgram, TakesNoOptionsFromTheCurrentFolder) {
  // By default, IPOPT reads options from ipopt.opt in the current folder. If Solve read this file,
  // IPOPT would do no iterations and return the start.
  namespace fs = std::filesystem;
  const fs::path before = fs::current_path();
  const fs::path folder = fs::path(testing::TempDir()) / "ipopt_options";
  fs::create_directories(folder);
  std::ofstream(folder / "ipopt.opt") << "max_iter 0\n";
  fs::current_path(folder);
  const Eigen::VectorXd c = Eigen::VectorXd::LinSpaced(20, -10.0, 10.0);
  const SparseQuadraticSolution solution =
      Solve(Nearest(c, -3.0, 4.0), Eigen::VectorXd::Zero(c.size()));
  fs::current_path(before);
  fs::remove_all(folder);
  EXPECT_TRUE(solution.ok);
}

TEST(SparseQuadraticProgram, RefusesWhatIsNoProgram) {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(2);
  SparseQuadraticProgram program = Nearest(zero, -1.0, 1.0);
  EXPECT_THROW(Solve(program, Eigen::VectorXd::Zero(3)), PreconditionError);
  program.upper[1] = -1.0;
  EXPECT_THROW(Solve(program, zero), PreconditionError);
  program = Nearest(zero, -1.0, 1.0);
  program.linear[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Solve(program, zero), PreconditionError);
}

}  // namespace
}  // namespace trackbed
