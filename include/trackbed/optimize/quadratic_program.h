#pragma once

#include <Eigen/Core>

/// Convex quadratic programs of a few dozen variables, for controllers:
///   minimize x^T H x/2 + f^T x  subject to  G x <= h
namespace trackbed {

/// Sizes are bounded, so that only NLopt allocates heap memory.
struct QuadraticProgram {
  static constexpr int kMaxVariables = 40;
  static constexpr int kMaxConstraints = 4 * kMaxVariables;
  using Matrix =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxVariables, kMaxVariables>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxVariables, 1>;
  using Rows =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxConstraints, kMaxVariables>;
  using Bounds = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxConstraints, 1>;

  Matrix hessian;    ///< H, symmetric positive definite
  Vector linear;     ///< f
  Rows constraints;  ///< G, any number of rows
  Bounds bounds;     ///< h
};

struct QuadraticSolution {
  bool ok = false;  ///< the constraints are met
  QuadraticProgram::Vector x;
  double violation = 0.0;  ///< largest G x - h, 0 if met
  int solves = 0;          ///< by SLSQP; 0: the unconstrained minimum meets the constraints
};

/// Solves by Cholesky decomposition if no constraint is active; otherwise with NLopt's SLSQP on an
/// active set of constraints, extended until none is violated. SLSQP works in variables in which H
/// is the identity, its initial Hessian: its first step is the solution, from any start.
///
/// Guarantees: constraints met to `tolerance`, absolute; the same program gives the same bits. Not
/// ok if they are infeasible; x is then the least-violating point that was evaluated. InternalError
/// unless H is positive definite, the sizes agree and all numbers are finite. Cost: 20 variables
/// take about 10 us without active constraints, 0.1 to 1 ms with them.
QuadraticSolution Solve(const QuadraticProgram& program, double tolerance = 1e-9);

}  // namespace trackbed
