#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

/// Solves sparse convex quadratic programs with thousands of variables:
///   minimize x^T H x/2 + f^T x  subject to  lower <= G x <= upper
namespace trackbed {

struct SparseQuadraticProgram {
  /// Matrix H of the objective, symmetric positive semidefinite, with both triangles stored.
  Eigen::SparseMatrix<double> hessian;
  Eigen::VectorXd linear;                   ///< Vector f of the objective.
  Eigen::SparseMatrix<double> constraints;  ///< Matrix G of the constraints.
  Eigen::VectorXd lower;                    ///< Lower bounds, finite.
  Eigen::VectorXd upper;                    ///< Upper bounds of G x, finite, above `lower`.
};

struct SparseQuadraticSolution {
  /// Whether the quadratic program was solved and the solution meets the constraints.
  bool ok = false;
  Eigen::VectorXd x;
  /// Lagrange multipliers of the constraints, positive at an upper bound and negative at a lower
  /// bound.
  Eigen::VectorXd multipliers;
  /// Largest amount by which an element of G x exceeds its bounds; 0 if all bounds are met.
  double violation = 0.0;
  int iterations = 0;  ///< Number of iterations of the interior-point method.
};

/// The strategy by which the interior-point method chooses its steps.
enum class InteriorSteps {
  /// The interior-point method uses an adaptive barrier parameter and a filter line search.
  kLineSearch,
  /// Mehrotra's predictor-corrector method, which needs 20 iterations instead of 40 to 60, but may
  /// not converge.
  kPredictorCorrector,
};

/// Solves a quadratic program, starting from `start`, by IPOPT's interior-point method (Waechter
/// and Biegler 2006) with MUMPS.
///
/// Guarantees: the constraints are met with a tolerance of 1e-7 times the largest bound. On one
/// machine, the same quadratic program always has a bit-identical solution. In the solution, `ok`
/// is false if no point meets all constraints, or if 200 iterations (80 with kPredictorCorrector)
/// do not solve the program. Throws PreconditionError unless the sizes agree, all numbers are
/// finite and lower < upper. Throws RunError in a build without IPOPT (TRACKBED_IPOPT=OFF). A
/// quadratic program with 1000 variables, a band matrix of width 12 and 2000 constraints takes 0.1
/// s.
SparseQuadraticSolution Solve(const SparseQuadraticProgram& program, const Eigen::VectorXd& start,
                              InteriorSteps steps = InteriorSteps::kLineSearch);

}  // namespace trackbed
