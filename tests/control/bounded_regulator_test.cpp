#include "src/control/bounded_regulator.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/tolerance.h"
#include "trackbed/optimize/quadratic_program.h"

// The regulator with a bounded input, compared with the quadratic program that it solves.
namespace trackbed {
namespace bounded_regulator_test {

using Vector = ErrorModel::Vector;

constexpr int kSteps = 40;
constexpr double kMost = 1.0;

/// Offset, heading and steering angle of a car without slip: three integrators in a row.
struct Integrators {
  explicit Integrators(double speed = 1.0) {
    constexpr double kPeriod = 0.05;
    model.speed = speed;
    model.period = kPeriod;
    model.a = ErrorModel::Matrix::Identity(3, 3);
    model.a(0, 1) = speed * kPeriod;
    model.a(0, 2) = 0.5 * speed * kPeriod * kPeriod;
    model.a(1, 2) = kPeriod;
    model.b = Vector{{speed * std::pow(kPeriod, 3) / 6.0, 0.5 * kPeriod * kPeriod, kPeriod}};
    weights = {.cross_track = 1.0, .heading = 0.1, .steering_rate = 0.01};
    regulator = SolveRegulator(model, weights);
  }
  ErrorModel model;
  ErrorWeights weights;
  Regulator regulator;
};

/// A random deviation and random disturbances.
struct Case {
  explicit Case(std::mt19937& random) {
    std::normal_distribution<double> normal;
    start = Vector{{0.3 * normal(random), 0.3 * normal(random), 0.3 * normal(random)}};
    pushes.assign(kSteps, Vector::Zero(3));
    path_rates.assign(kSteps, 0.0);
    for (double& rate : path_rates) {
      rate = std::clamp(0.5 * normal(random), -kMost, kMost);
    }
    for (const int at : {5, 20, 30}) {
      pushes[static_cast<std::size_t>(at)] = Vector{{0.0, 0.0, 0.5 * normal(random)}};
    }
  }
  double Input(BoundedRegulator& bounded, const Integrators& loop, double most = kMost) const {
    bounded.Clear();
    for (std::size_t k = 0; k < pushes.size(); ++k) {
      bounded.Append(pushes[k], path_rates[k]);
    }
    return bounded.Input(loop.model, loop.regulator, start, most);
  }
  Vector start;
  std::vector<Vector> pushes;
  std::vector<double> path_rates;
};

/// States x = free + reach w, written out for all inputs: the quadratic program, without a Riccati
/// equation but for the cost beyond the last step.
QuadraticProgram WriteOut(const Integrators& loop, const Case& at) {
  QuadraticProgram program;
  program.hessian = loop.weights.steering_rate * Eigen::MatrixXd::Identity(kSteps, kSteps);
  program.linear =
      -loop.weights.steering_rate * Eigen::Map<const Eigen::VectorXd>(at.path_rates.data(), kSteps);
  Eigen::MatrixXd reach = Eigen::MatrixXd::Zero(3, kSteps);
  Eigen::VectorXd state = at.start;
  const Eigen::MatrixXd a = loop.model.a;
  for (int k = 0; k < kSteps; ++k) {
    reach = (a * reach).eval();
    reach.col(k) += loop.model.b;
    state = (a * state + at.pushes[static_cast<std::size_t>(k)]).eval();
    const Eigen::MatrixXd cost =
        k + 1 == kSteps ? Eigen::MatrixXd(loop.regulator.cost)
                        : Eigen::MatrixXd(StateCost(loop.model, loop.weights).asDiagonal());
    program.hessian += reach.transpose() * cost * reach;
    program.linear += reach.transpose() * cost * state;
  }
  program.constraints.setZero(2 * kSteps, kSteps);
  program.constraints.topRows(kSteps).setIdentity();
  program.constraints.bottomRows(kSteps) = -Eigen::MatrixXd::Identity(kSteps, kSteps);
  program.bounds.setConstant(2 * kSteps, kMost);
  return program;
}

/// Returns how much the cost of `inputs` exceeds a lower bound of the program's minimum, in units
/// of (R + b'Pb) kMost^2. The lower bound is the one of the gradient: H is positive semidefinite,
/// so the cost changes by at least gradient (w' - w), and w' is within the bounds.
double Gap(const Integrators& loop, const QuadraticProgram& program,
           const std::vector<double>& inputs) {
  const Eigen::VectorXd w =
      Eigen::Map<const Eigen::VectorXd>(inputs.data(), static_cast<long>(inputs.size()));
  const Eigen::VectorXd gradient = program.hessian * w + program.linear;
  const double half = gradient.dot(w) + kMost * gradient.lpNorm<1>();
  return 2.0 * half / (loop.regulator.input_cost * kMost * kMost);
}

TEST(BoundedRegulator, IsTheMinimumOfTheQuadraticProgram) {
  // The oracle is the program that is written out: the bound of its minimum by the gradient, and
  // its solution by SLSQP.
  std::mt19937 random(52);
  int bounded = 0;
  int differs = 0;
  int most_iterations = 0;
  for (int i = 0; i < 1000; ++i) {
    SCOPED_TRACE(i);
    const Integrators loop(i % 2 == 0 ? 1.0 : 5.0);
    const Case at(random);
    const QuadraticProgram program = WriteOut(loop, at);
    BoundedRegulator regulator;
    const double found = at.Input(regulator, loop);
    most_iterations = std::max(most_iterations, regulator.iterations());
    ASSERT_LT(regulator.iterations(), BoundedRegulator::kMaxIterations);
    // The terms of the sum cancel, so rounding errors are 1e-16 of their magnitudes, times 40.
    const double rounding = 1e-14 *
                            (program.hessian.lpNorm<1>() * kMost + program.linear.lpNorm<1>()) /
                            loop.regulator.input_cost;
    EXPECT_LT(Gap(loop, program, regulator.inputs()), BoundedRegulator::kGap + rounding);
    // Without bounds, the whole input is clipped.
    BoundedRegulator free;
    const double clipped = std::clamp(at.Input(free, loop, 1e6), -kMost, kMost);
    bounded += regulator.iterations() > 0;
    differs += std::abs(clipped - found) > 0.05 * kMost;
    if (i % 50 == 0) {
      const QuadraticSolution solution = Solve(program);
      ASSERT_TRUE(solution.ok);
      EXPECT_NEAR(found, solution.x[0], Tolerance(1e-4));
    }
  }
  EXPECT_GE(bounded, 500);  // the comparison is not vacuous
  EXPECT_GE(differs, 50);
  RecordProperty("iterations", most_iterations);
}

TEST(BoundedRegulator, IsTheRegulatorWithinItsBounds) {
  // Without disturbances and bounds, w = -K z; with a disturbance, the terms of LqrOptions are
  // added.
  const Integrators loop;
  std::mt19937 random(7);
  const Case at(random);
  const ErrorModel::Matrix closed = loop.model.a - loop.model.b * loop.regulator.gain;
  double expected = at.path_rates[0] - loop.regulator.gain.dot(at.start);
  Vector reach = loop.model.b;
  for (std::size_t k = 0; k < at.pushes.size(); ++k) {
    const Vector push = at.pushes[k] + at.path_rates[k] * loop.model.b;
    expected -= reach.dot(loop.regulator.cost * push) / loop.regulator.input_cost;
    reach = (closed * reach).eval();
  }
  BoundedRegulator regulator;
  EXPECT_NEAR(at.Input(regulator, loop, 1e3), expected, Tolerance(1e-13));
  EXPECT_EQ(regulator.iterations(), 0);
  BoundedRegulator blind;
  EXPECT_NEAR(blind.Input(loop.model, loop.regulator, at.start, 1e3),
              -loop.regulator.gain.dot(at.start), Tolerance(1e-14));
}

}  // namespace bounded_regulator_test
}  // namespace trackbed
