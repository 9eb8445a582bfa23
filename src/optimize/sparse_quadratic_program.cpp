#include "trackbed/optimize/sparse_quadratic_program.h"

#include <algorithm>

#include "src/optimize/ipopt/ipopt.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

void CheckProgram(const SparseQuadraticProgram& program, const Eigen::VectorXd& start) {
  const Eigen::Index n = program.linear.size();
  const Eigen::Index m = program.lower.size();
  TRACKBED_REQUIRE(n > 0 && program.hessian.rows() == n && program.hessian.cols() == n &&
                       program.constraints.cols() == n && program.constraints.rows() == m &&
                       program.upper.size() == m && start.size() == n,
                   "Solve: H of {} x {}, G of {} x {}, {} and {} bounds, {} variables, a start of "
                   "{}; must agree",
                   program.hessian.rows(), program.hessian.cols(), program.constraints.rows(),
                   program.constraints.cols(), m, program.upper.size(), n, start.size());
  const bool finite = program.linear.allFinite() && program.lower.allFinite() &&
                      program.upper.allFinite() && start.allFinite() &&
                      program.hessian.coeffs().allFinite() &&
                      program.constraints.coeffs().allFinite();
  TRACKBED_REQUIRE(finite && (program.lower.array() < program.upper.array()).all(),
                   "Solve: a number is not finite, or a lower bound is not below the upper one");
}

}  // namespace

SparseQuadraticSolution Solve(const SparseQuadraticProgram& program, const Eigen::VectorXd& start,
                              InteriorSteps steps) {
  SparseQuadraticProgram packed = program;
  packed.hessian.makeCompressed();
  packed.constraints.makeCompressed();
  CheckProgram(packed, start);
  const IpoptResult found = SolveByIpopt(packed, start, steps);
  SparseQuadraticSolution solution{
      .x = found.x, .multipliers = found.multipliers, .iterations = found.iterations};
  const Eigen::VectorXd values = packed.constraints * solution.x;
  const double largest = std::max(
      {1.0, packed.lower.lpNorm<Eigen::Infinity>(), packed.upper.lpNorm<Eigen::Infinity>()});
  solution.violation =
      std::max({0.0, (packed.lower - values).maxCoeff(), (values - packed.upper).maxCoeff()});
  solution.ok = found.solved && solution.x.allFinite() && solution.violation <= 1e-7 * largest;
  return solution;
}

}  // namespace trackbed
