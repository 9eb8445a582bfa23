#pragma once

#include <Eigen/Core>

/// Convex quadratic programs of a few dozen variables, for controllers:
///   minimize x^T H x/2 + f^T x  subject to  G x <= h
namespace trackbed {

/// A quadratic program. The sizes of the program are bounded, so that only NLopt allocates heap
/// memory.
struct QuadraticProgram {
  static constexpr int kMaxVariables = 40;
  static constexpr int kMaxConstraints = 4 * kMaxVariables;
  using Matrix =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxVariables, kMaxVariables>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxVariables, 1>;
  using Rows =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxConstraints, kMaxVariables>;
  using Bounds = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxConstraints, 1>;

  Matrix hessian;    ///< Matrix H of the objective, symmetric positive definite.
  Vector linear;     ///< Vector f of the objective.
  Rows constraints;  ///< Matrix G of the constraints, with any number of rows.
  Bounds bounds;     ///< Vector h of the constraints.
};

struct QuadraticSolution {
  bool ok = false;  ///< Whether the constraints are met.
  QuadraticProgram::Vector x;
  double violation = 0.0;  ///< Largest element of G x - h; 0 if all constraints are met.
  /// Number of SLSQP runs. The number is 0 if the unconstrained minimum meets the constraints.
  int solves = 0;
};

/// Solves a quadratic program. If no constraint is active, the solution is found by Cholesky
/// decomposition. Otherwise NLopt's SLSQP solves for an active set of constraints, which is
/// extended until no constraint is violated. The variables are transformed so that H becomes the
/// identity, which is the initial Hessian of SLSQP. The first step of SLSQP therefore reaches the
/// solution, from any start.
///
/// Guarantees: the constraints are met to the absolute `tolerance`, and the same quadratic program
/// always gives bit-identical results. If the constraints are infeasible, the solution is not ok,
/// and x is the evaluated point with the smallest violation. InternalError unless H is positive
/// definite, the sizes agree and all numbers are finite. Cost for 20 variables: about 10 us without
/// active constraints, 0.1 to 1 ms with active constraints.
QuadraticSolution Solve(const QuadraticProgram& program, double tolerance = 1e-9);

}  // namespace trackbed
