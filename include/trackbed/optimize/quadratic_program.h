#pragma once

#include <Eigen/Core>

/// Solves convex quadratic programs of a few dozen variables, for controllers:
///   minimize x^T H x/2 + f^T x  subject to  G x <= h
namespace trackbed {

/// A quadratic program. Maximum sizes of the quadratic program; because the sizes are limited, only
/// NLopt allocates heap memory.
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
  Bounds bounds;     ///< Vector h, the upper bounds of G x.
};

struct QuadraticSolution {
  bool ok = false;  ///< Whether the solution meets all constraints.
  QuadraticProgram::Vector x;
  /// Largest element of G x - h at the solution; 0 if all constraints are met.
  double violation = 0.0;
  /// Number of calls of SLSQP; 0 if the unconstrained minimum meets the constraints.
  int solves = 0;
};

/// Solves a quadratic program. If no constraint is active, a Cholesky decomposition yields the
/// solution. If constraints are active, NLopt's SLSQP solves the program with only a subset of the
/// constraints; violated constraints are added to the subset until no constraint is violated. The
/// variables are transformed so that H becomes the identity matrix, which SLSQP uses as its initial
/// Hessian. Because the initial Hessian is exact, the first step of SLSQP reaches the solution from
/// any start point.
///
/// Guarantees: the constraints are met to the absolute `tolerance`, and the same quadratic program
/// always has a bit-identical solution. If no point meets all constraints, `ok` is false, and x is
/// the evaluated point with the smallest violation of the constraints. Throws InternalError unless
/// H is positive definite, the sizes agree and all numbers are finite. With 20 variables, the
/// solution takes about 10 us without active constraints, and 0.1 to 1 ms with active constraints.
QuadraticSolution Solve(const QuadraticProgram& program, double tolerance = 1e-9);

}  // namespace trackbed
