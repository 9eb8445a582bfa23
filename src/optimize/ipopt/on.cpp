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

/// Data for the callbacks of IPOPT: the quadratic program and the iteration count.
struct Context {
  const SparseQuadraticProgram& program;
  Sparse lower_triangle;
  int iterations = 0;
};

/// Deduces IPOPT's number types from the type of a callback, because the names of these types
/// differ between versions of IPOPT. IPOPT 3.14 deprecates the names Index, Number and Bool. IPOPT
/// 3.11 lacks the names ipindex and ipnumber.
template <typename Callback>
struct TypesOf;
template <typename BoolType, typename IndexType, typename NumberType>
struct TypesOf<BoolType (*)(IndexType, NumberType*, BoolType, NumberType*, UserDataPtr)> {
  using Bool = BoolType;
  using Index = IndexType;
  using Number = NumberType;
};
using IpBool = TypesOf<Eval_F_CB>::Bool;
using IpIndex = TypesOf<Eval_F_CB>::Index;
using IpNumber = TypesOf<Eval_F_CB>::Number;

Context& ContextOf(UserDataPtr data) {
  return *static_cast<Context*>(data);
}

/// Writes the entries of a sparse matrix to the arrays of IPOPT: the row and column indices if
/// `values` is null, otherwise the values.
void FillEntries(const Sparse& matrix, IpIndex* rows, IpIndex* columns, IpNumber* values) {
  Eigen::Index entry = 0;
  for (Eigen::Index outer = 0; outer < matrix.outerSize(); ++outer) {
    for (Sparse::InnerIterator at(matrix, outer); at; ++at, ++entry) {
      if (values == nullptr) {
        rows[entry] = static_cast<IpIndex>(at.row());
        columns[entry] = static_cast<IpIndex>(at.col());
      } else {
        values[entry] = at.value();
      }
    }
  }
}

IpBool Objective(IpIndex n, IpNumber* x, IpBool /*new_x*/, IpNumber* value, UserDataPtr data) {
  const SparseQuadraticProgram& program = ContextOf(data).program;
  const ConstVectorMap at(x, n);
  *value = 0.5 * at.dot(program.hessian * at) + program.linear.dot(at);
  return TRUE;
}

IpBool Gradient(IpIndex n, IpNumber* x, IpBool /*new_x*/, IpNumber* gradient, UserDataPtr data) {
  const SparseQuadraticProgram& program = ContextOf(data).program;
  VectorMap(gradient, n) = program.hessian * ConstVectorMap(x, n) + program.linear;
  return TRUE;
}

IpBool Constraints(IpIndex n, IpNumber* x, IpBool /*new_x*/, IpIndex m, IpNumber* values,
                   UserDataPtr data) {
  VectorMap(values, m) = ContextOf(data).program.constraints * ConstVectorMap(x, n);
  return TRUE;
}

IpBool Jacobian(IpIndex /*n*/, IpNumber* /*x*/, IpBool /*new_x*/, IpIndex /*m*/,
                IpIndex /*entries*/, IpIndex* rows, IpIndex* columns, IpNumber* values,
                UserDataPtr data) {
  FillEntries(ContextOf(data).program.constraints, rows, columns, values);
  return TRUE;
}

IpBool Hessian(IpIndex /*n*/, IpNumber* /*x*/, IpBool /*new_x*/, IpNumber factor, IpIndex /*m*/,
               IpNumber* /*lambda*/, IpBool /*new_lambda*/, IpIndex entries, IpIndex* rows,
               IpIndex* columns, IpNumber* values, UserDataPtr data) {
  FillEntries(ContextOf(data).lower_triangle, rows, columns, values);
  if (values != nullptr) {
    VectorMap(values, entries) *= factor;
  }
  return TRUE;
}

IpBool CountIteration(IpIndex /*mode*/, IpIndex iteration, IpNumber /*objective*/,
                      IpNumber /*primal*/, IpNumber /*dual*/, IpNumber /*mu*/, IpNumber /*step*/,
                      IpNumber /*regularization*/, IpNumber /*alpha_dual*/,
                      IpNumber /*alpha_primal*/, IpIndex /*trials*/, UserDataPtr data) {
  ContextOf(data).iterations = static_cast<int>(iteration);
  return TRUE;
}

void SetOptions(IpoptProblem problem, InteriorSteps steps) {
  // The C interface of IPOPT requires non-const texts but does not change these texts.
  const auto set_text = [&](std::string name, const std::string& value) {
    std::string own = value;
    TRACKBED_CHECK(AddIpoptStrOption(problem, name.data(), own.data()) == TRUE, "{}", name);
  };
  const auto set_integer = [&](std::string name, int value) {
    TRACKBED_CHECK(AddIpoptIntOption(problem, name.data(), value) == TRUE, "{}", name);
  };
  // Set the name of the options file to an empty text, so that IPOPT does not read the file
  // ipopt.opt in the current folder.
  set_text("option_file_name", "");
  set_text("hessian_constant", "yes");
  set_text("jac_d_constant", "yes");
  if (steps == InteriorSteps::kPredictorCorrector) {
    set_text("mehrotra_algorithm", "yes");
  } else {
    set_text("mu_strategy", "adaptive");
  }
  set_text("sb", "yes");  // keeps IPOPT from printing its banner
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
  // Solve only one program at a time: MUMPS, the linear solver of IPOPT in Debian, has global state
  // and would crash if several threads used it.
  static std::mutex one_at_a_time;
  const std::lock_guard<std::mutex> lock(one_at_a_time);
  const auto n = static_cast<IpIndex>(program.linear.size());
  const auto m = static_cast<IpIndex>(program.lower.size());
  Context context{.program = program,
                  .lower_triangle = program.hessian.triangularView<Eigen::Lower>()};
  constexpr double kUnbounded = 2e19;
  Eigen::VectorXd x_lower = Eigen::VectorXd::Constant(n, -kUnbounded);
  Eigen::VectorXd x_upper = Eigen::VectorXd::Constant(n, kUnbounded);
  Eigen::VectorXd lower = program.lower;
  Eigen::VectorXd upper = program.upper;
  const std::unique_ptr<std::remove_pointer_t<IpoptProblem>, void (*)(IpoptProblem)> problem(
      CreateIpoptProblem(n, x_lower.data(), x_upper.data(), m, lower.data(), upper.data(),
                         static_cast<IpIndex>(program.constraints.nonZeros()),
                         static_cast<IpIndex>(context.lower_triangle.nonZeros()), 0, Objective,
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
