#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

/// Convex quadratic programs of thousands of variables of which few appear together:
///   minimize x^T H x/2 + f^T x  subject to  lower <= G x <= upper
namespace trackbed {

struct SparseQuadraticProgram {
  Eigen::SparseMatrix<double> hessian;      ///< H, symmetric positive semidefinite, both triangles
  Eigen::VectorXd linear;                   ///< f
  Eigen::SparseMatrix<double> constraints;  ///< G
  Eigen::VectorXd lower;                    ///< finite
  Eigen::VectorXd upper;                    ///< finite, above `lower`
};

struct SparseQuadraticSolution {
  bool ok = false;  ///< solved, and the constraints are met
  Eigen::VectorXd x;
  Eigen::VectorXd multipliers;  ///< of the constraints: above 0 at an upper bound, below at a lower
  double violation = 0.0;       ///< largest by which G x is outside of its bounds, 0 if met
  int iterations = 0;           ///< of the interior-point method
};

/// How the interior-point method chooses its steps.
enum class InteriorSteps {
  kLineSearch,          ///< with an adaptive barrier parameter and a filter line search
  kPredictorCorrector,  ///< Mehrotra's: 20 instead of 40 to 60, but not sure to converge
};

/// Solves from `start` by IPOPT's interior-point method (Waechter and Biegler 2006) with MUMPS.
///
/// Guarantees: constraints kept to 1e-7 of the largest bound; the same program gives the same bits
/// on one machine. Not ok if they are infeasible or 200 iterations do not suffice, 80 with
/// predicted steps. PreconditionError unless the sizes agree, all numbers are finite and lower <
/// upper. RunError in a build without IPOPT (TRACKBED_IPOPT=OFF). Cost: 1000 variables in bands of
/// 12, 2000 constraints: 0.1 s.
SparseQuadraticSolution Solve(const SparseQuadraticProgram& program, const Eigen::VectorXd& start,
                              InteriorSteps steps = InteriorSteps::kLineSearch);

}  // namespace trackbed
