#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

/// Sparse convex quadratic programs with thousands of variables:
///   minimize x^T H x/2 + f^T x  subject to  lower <= G x <= upper
namespace trackbed {

struct SparseQuadraticProgram {
  /// Matrix H of the objective, symmetric positive semidefinite, with both triangles stored.
  Eigen::SparseMatrix<double> hessian;
  Eigen::VectorXd linear;                   ///< Vector f of the objective.
  Eigen::SparseMatrix<double> constraints;  ///< Matrix G of the constraints.
  Eigen::VectorXd lower;                    ///< Lower bounds, finite.
  Eigen::VectorXd upper;                    ///< Upper bounds, finite, above `lower`.
};

struct SparseQuadraticSolution {
  bool ok = false;  ///< Whether the program is solved and the constraints are met.
  Eigen::VectorXd x;
  /// Multipliers of the constraints: positive at an upper bound, negative at a lower bound.
  Eigen::VectorXd multipliers;
  double violation = 0.0;  ///< Largest distance of G x beyond its bounds; 0 if all bounds are met.
  int iterations = 0;      ///< Number of iterations of the interior-point method.
};

/// How the interior-point method chooses its steps.
enum class InteriorSteps {
  /// Line search: an adaptive barrier parameter and a filter line search.
  kLineSearch,
  /// Mehrotra's predictor-corrector: 20 iterations instead of 40 to 60, but may not converge.
  kPredictorCorrector,
};

/// Solves a program, starting from `start`, by IPOPT's interior-point method (Waechter and Biegler
/// 2006) with MUMPS.
///
/// Guarantees: the constraints are met to 1e-7 of the largest bound. On one machine, the same
/// quadratic program always gives bit-identical results. The solution is not ok if the constraints
/// are infeasible, or if the program is not solved in 200 iterations (80 with kPredictorCorrector).
/// PreconditionError unless the sizes agree, all numbers are finite and lower < upper. RunError in
/// a build without IPOPT (TRACKBED_IPOPT=OFF). Cost: 0.1 s for 1000 variables in a band matrix of
/// width 12 and 2000 constraints.
SparseQuadraticSolution Solve(const SparseQuadraticProgram& program, const Eigen::VectorXd& start,
                              InteriorSteps steps = InteriorSteps::kLineSearch);

}  // namespace trackbed
