#include <IpStdCInterface.h>

#include <memory>
#include <mutex>
#include <string>
#include <type_traits>

#include "src/optimize/ipopt/ipopt.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using ConstVectorMap = Eigen::Map<const Eigen::VectorXd>;
using VectorMap = Eigen::Map<Eigen::VectorXd>;

/// The program and an iteration count, for the callbacks.
struct Context {
  const SparseQuadraticProgram& program;
  Sparse lower_triangle;
  int iterations = 0;
};

Context& ContextOf(UserDataPtr data) {
  return *static_cast<Context*>(data);
}

/// Places of the entries of a matrix if they are asked for, else their values.
void FillEntries(const Sparse& matrix, Index* rows, Index* columns, Number* values) {
  Eigen::Index entry = 0;
  for (Eigen::Index outer = 0; outer < matrix.outerSize(); ++outer) {
    for (Sparse::InnerIterator at(matrix, outer); at; ++at, ++entry) {
      if (values == nullptr) {
        rows[entry] = static_cast<Index>(at.row());
        columns[entry] = static_cast<Index>(at.col());
      } else {
        values[entry] = at.value();
      }
    }
  }
}

Bool Objective(Index n, Number* x, Bool /*new_x*/, Number* value, UserDataPtr data) {
  const SparseQuadraticProgram& program = ContextOf(data).program;
  const ConstVectorMap at(x, n);
  *value = 0.5 * at.dot(program.hessian * at) + program.linear.dot(at);
  return TRUE;
}

Bool Gradient(Index n, Number* x, Bool /*new_x*/, Number* gradient, UserDataPtr data) {
  const SparseQuadraticProgram& program = ContextOf(data).program;
  VectorMap(gradient, n) = program.hessian * ConstVectorMap(x, n) + program.linear;
  return TRUE;
}

Bool Constraints(Index n, Number* x, Bool /*new_x*/, Index m, Number* values, UserDataPtr data) {
  VectorMap(values, m) = ContextOf(data).program.constraints * ConstVectorMap(x, n);
  return TRUE;
}

Bool Jacobian(Index /*n*/, Number* /*x*/, Bool /*new_x*/, Index /*m*/, Index /*entries*/,
              Index* rows, Index* columns, Number* values, UserDataPtr data) {
  FillEntries(ContextOf(data).program.constraints, rows, columns, values);
  return TRUE;
}

Bool Hessian(Index /*n*/, Number* /*x*/, Bool /*new_x*/, Number factor, Index /*m*/,
             Number* /*lambda*/, Bool /*new_lambda*/, Index entries, Index* rows, Index* columns,
             Number* values, UserDataPtr data) {
  FillEntries(ContextOf(data).lower_triangle, rows, columns, values);
  if (values != nullptr) {
    VectorMap(values, entries) *= factor;
  }
  return TRUE;
}

Bool CountIteration(Index /*mode*/, Index iteration, Number /*objective*/, Number /*primal*/,
                    Number /*dual*/, Number /*mu*/, Number /*step*/, Number /*regularization*/,
                    Number /*alpha_dual*/, Number /*alpha_primal*/, Index /*trials*/,
                    UserDataPtr data) {
  ContextOf(data).iterations = static_cast<int>(iteration);
  return TRUE;
}

void SetOptions(IpoptProblem problem, InteriorSteps steps) {
  // The interface takes texts that it may change, and does not.
  const auto set_text = [&](std::string name, const std::string& value) {
    std::string own = value;
    TRACKBED_CHECK(AddIpoptStrOption(problem, name.data(), own.data()) == TRUE, "{}", name);
  };
  const auto set_integer = [&](std::string name, int value) {
    TRACKBED_CHECK(AddIpoptIntOption(problem, name.data(), value) == TRUE, "{}", name);
  };
  set_text("option_file_name", "");  // else it reads ipopt.opt from the current folder
  set_text("hessian_constant", "yes");
  set_text("jac_d_constant", "yes");
  if (steps == InteriorSteps::kPredictorCorrector) {
    set_text("mehrotra_algorithm", "yes");
  } else {
    set_text("mu_strategy", "adaptive");
  }
  set_text("sb", "yes");  // no banner
  set_integer("print_level", 0);
  set_integer("max_iter", steps == InteriorSteps::kPredictorCorrector ? 80 : 200);
  const auto set_number = [&](std::string name, double value) {
    TRACKBED_CHECK(AddIpoptNumOption(problem, name.data(), value) == TRUE, "{}", name);
  };
  set_number("tol", 1e-9);
  set_number("bound_relax_factor", 0.0);
}

}  // namespace

IpoptResult SolveByIpopt(const SparseQuadraticProgram& program, const Eigen::VectorXd& start,
                         InteriorSteps steps) {
  // MUMPS, IPOPT's linear solver in Debian, keeps state of its own: two solutions at a time crash.
  static std::mutex one_at_a_time;
  const std::lock_guard<std::mutex> lock(one_at_a_time);
  const auto n = static_cast<Index>(program.linear.size());
  const auto m = static_cast<Index>(program.lower.size());
  Context context{.program = program,
                  .lower_triangle = program.hessian.triangularView<Eigen::Lower>()};
  constexpr double kUnbounded = 2e19;
  Eigen::VectorXd x_lower = Eigen::VectorXd::Constant(n, -kUnbounded);
  Eigen::VectorXd x_upper = Eigen::VectorXd::Constant(n, kUnbounded);
  Eigen::VectorXd lower = program.lower;
  Eigen::VectorXd upper = program.upper;
  const std::unique_ptr<std::remove_pointer_t<IpoptProblem>, void (*)(IpoptProblem)> problem(
      CreateIpoptProblem(n, x_lower.data(), x_upper.data(), m, lower.data(), upper.data(),
                         static_cast<Index>(program.constraints.nonZeros()),
                         static_cast<Index>(context.lower_triangle.nonZeros()), 0, Objective,
                         Constraints, Gradient, Jacobian, Hessian),
      FreeIpoptProblem);
  TRACKBED_CHECK(problem != nullptr, "IPOPT refuses a program of {} variables", n);
  SetOptions(problem.get(), steps);
  SetIntermediateCallback(problem.get(), CountIteration);
  IpoptResult result{.x = start, .multipliers = Eigen::VectorXd::Zero(m)};
  const ApplicationReturnStatus status =
      IpoptSolve(problem.get(), result.x.data(), nullptr, nullptr, result.multipliers.data(),
                 nullptr, nullptr, &context);
  result.solved = status == Solve_Succeeded || status == Solved_To_Acceptable_Level;
  result.iterations = context.iterations;
  return result;
}

}  // namespace trackbed
