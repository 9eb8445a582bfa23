#include "trackbed/optimize/quadratic_program.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <nlopt.hpp>
#include <vector>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

using Vector = QuadraticProgram::Vector;
using Rows = QuadraticProgram::Rows;
using Bounds = QuadraticProgram::Bounds;
using ConstVectorMap = Eigen::Map<const Eigen::VectorXd>;

/// Least-distance problem: minimize |y|^2/2 + linear^T y subject to rows y <= bounds, with the
/// matrix `rows`.
struct LeastDistance {
  Vector linear;
  Rows rows;
  Bounds bounds;
};

double Objective(unsigned n, const double* y, double* gradient, void* data) {
  const auto& problem = *static_cast<const LeastDistance*>(data);
  const ConstVectorMap at(y, n);
  if (gradient != nullptr) {
    Eigen::Map<Eigen::VectorXd>(gradient, n) = at + problem.linear;
  }
  return 0.5 * at.squaredNorm() + problem.linear.dot(at);
}

void Constraints(unsigned m, double* values, unsigned n, const double* y, double* gradient,
                 void* data) {
  const auto& problem = *static_cast<const LeastDistance*>(data);
  Eigen::Map<Eigen::VectorXd>(values, m) = problem.rows * ConstVectorMap(y, n) - problem.bounds;
  if (gradient != nullptr) {
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<RowMajor>(gradient, m, n) = problem.rows;
  }
}

Vector SolveBySlsqp(LeastDistance& problem, const Vector& start, double tolerance) {
  const auto n = static_cast<unsigned>(problem.linear.size());
  nlopt::opt search(nlopt::LD_SLSQP, n);
  search.set_min_objective(Objective, &problem);
  search.add_inequality_mconstraint(
      Constraints, &problem,
      std::vector<double>(static_cast<std::size_t>(problem.bounds.size()), 0.1 * tolerance));
  search.set_xtol_abs(0.1 * tolerance);
  constexpr int kMaxEvaluations = 100;
  search.set_maxeval(kMaxEvaluations);
  std::vector<double> y(start.data(), start.data() + start.size());
  try {
    double value = 0.0;
    search.optimize(y, value);
  } catch (const nlopt::roundoff_limited&) {
    // Ignore the exception roundoff_limited: the solution is as accurate as rounding errors permit.
  } catch (const std::runtime_error&) {
    // Ignore the exception, which means that the constraints contradict each other. The caller of
    // the solver checks whether the solution violates a constraint.
  }
  return ConstVectorMap(y.data(), n);
}

void Check(const QuadraticProgram& program) {
  const auto n = program.linear.size();
  TRACKBED_CHECK(n > 0 && program.hessian.rows() == n && program.hessian.cols() == n &&
                     program.constraints.rows() == program.bounds.size() &&
                     (program.bounds.size() == 0 || program.constraints.cols() == n),
                 "a program of {} variables and {} bounds with matrices of other sizes", n,
                 program.bounds.size());
  TRACKBED_CHECK(program.hessian.allFinite() && program.linear.allFinite() &&
                     program.constraints.allFinite() && program.bounds.allFinite(),
                 "a program with a number that is not finite");
}

}  // namespace

QuadraticSolution Solve(const QuadraticProgram& program, double tolerance) {
  Check(program);
  const Eigen::LLT<QuadraticProgram::Matrix> cholesky(program.hessian);
  TRACKBED_CHECK(cholesky.info() == Eigen::Success, "the Hessian is not positive definite");
  QuadraticSolution solution;
  solution.x = -cholesky.solve(program.linear);
  const auto m = program.bounds.size();

  // Substitute y = L^T x into the quadratic program, where L is the Cholesky factor of the Hessian.
  LeastDistance problem;
  problem.linear = cholesky.matrixL().solve(program.linear);
  Vector y = -problem.linear;
  std::array<bool, QuadraticProgram::kMaxConstraints> taken{};
  QuadraticSolution best;
  for (;;) {
    const Bounds excess = program.constraints * solution.x - program.bounds;
    solution.violation = m == 0 ? 0.0 : std::max(0.0, excess.maxCoeff());
    solution.ok = solution.violation <= tolerance;
    if (solution.ok) {
      return solution;
    }
    if (best.x.size() == 0 || solution.violation < best.violation) {
      best = solution;
    }
    bool more = false;
    Eigen::Index count = 0;
    for (Eigen::Index i = 0; i < m; ++i) {
      bool& row = taken[static_cast<std::size_t>(i)];
      more = more || (!row && excess[i] > tolerance);
      row = row || excess[i] > tolerance;
      count += row ? 1 : 0;
    }
    if (!more) {
      best.solves = solution.solves;
      return best;
    }
    problem.rows.resize(count, program.linear.size());
    problem.bounds.resize(count);
    for (Eigen::Index i = 0, k = 0; i < m; ++i) {
      if (taken[static_cast<std::size_t>(i)]) {
        problem.rows.row(k) = program.constraints.row(i);
        problem.bounds[k++] = program.bounds[i];
      }
    }
    // With y = L^T x, the constraints G x <= b become (G L^-T) y <= b.
    problem.rows = cholesky.matrixL().solve(problem.rows.transpose()).transpose().eval();
    y = SolveBySlsqp(problem, y, tolerance);
    solution.x = cholesky.matrixU().solve(y);
    ++solution.solves;
  }
}

}  // namespace trackbed
