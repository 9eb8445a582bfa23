#include "trackbed/optimize/smooth_program.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlopt.hpp>
#include <vector>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Evaluates a nonlinear program for NLopt's callbacks, each point once, and keeps the best point.
class Evaluations {
 public:
  Evaluations(const SmoothProgram& program, double tolerance)
      : program_(program), tolerance_(tolerance), x_(program.start.size()) {
    best_.violation = std::numeric_limits<double>::infinity();
    best_.objective = std::numeric_limits<double>::infinity();
  }

  const SmoothValues& At(const double* x) {
    const Eigen::Index n = x_.size();
    const Eigen::Map<const Eigen::VectorXd> at(x, n);
    if (best_.evaluations > 0 && at == x_) {
      return values_;
    }
    x_ = at;
    values_.objective = 0.0;
    values_.gradient = Eigen::VectorXd::Zero(n);
    values_.equal = Eigen::VectorXd::Zero(program_.equal_count);
    values_.equal_rows = SmoothValues::Rows::Zero(program_.equal_count, n);
    values_.at_most_0 = Eigen::VectorXd::Zero(program_.at_most_0_count);
    values_.at_most_0_rows = SmoothValues::Rows::Zero(program_.at_most_0_count, n);
    program_.evaluate(x_, values_);
    ++best_.evaluations;
    Keep();
    return values_;
  }

  [[nodiscard]] const SmoothSolution& best() const { return best_; }

 private:
  void Keep() {
    double violation = 0.0;
    for (const double c : values_.equal) {
      violation = std::max(violation, std::abs(c));
    }
    for (const double d : values_.at_most_0) {
      violation = std::max(violation, d);
    }
    const bool is_finite = std::isfinite(values_.objective) && values_.equal.allFinite() &&
                           values_.at_most_0.allFinite();
    const bool ok = is_finite && violation <= tolerance_;
    const bool is_better = ok ? !best_.ok || values_.objective < best_.objective
                              : is_finite && !best_.ok && violation < best_.violation;
    if (is_better) {
      best_.ok = ok;
      best_.x = x_;
      best_.objective = values_.objective;
      best_.violation = violation;
    }
  }

  const SmoothProgram& program_;
  double tolerance_;
  Eigen::VectorXd x_;
  SmoothValues values_;
  SmoothSolution best_;
};

void CopyRows(const Eigen::VectorXd& from, const SmoothValues::Rows& rows, double* values,
              double* gradients) {
  std::copy(from.begin(), from.end(), values);
  if (gradients != nullptr) {
    std::copy_n(rows.data(), rows.size(), gradients);
  }
}

double ObjectiveOf(unsigned /*n*/, const double* x, double* gradient, void* data) {
  const SmoothValues& values = static_cast<Evaluations*>(data)->At(x);
  if (gradient != nullptr) {
    std::copy(values.gradient.begin(), values.gradient.end(), gradient);
  }
  return values.objective;
}

void EqualOf(unsigned /*m*/, double* result, unsigned /*n*/, const double* x, double* gradient,
             void* data) {
  const SmoothValues& values = static_cast<Evaluations*>(data)->At(x);
  CopyRows(values.equal, values.equal_rows, result, gradient);
}

void AtMost0Of(unsigned /*m*/, double* result, unsigned /*n*/, const double* x, double* gradient,
               void* data) {
  const SmoothValues& values = static_cast<Evaluations*>(data)->At(x);
  CopyRows(values.at_most_0, values.at_most_0_rows, result, gradient);
}

std::vector<double> Filled(Eigen::Index count, double value) {
  return std::vector<double>(static_cast<std::size_t>(count), value);
}

}  // namespace

SmoothSolution Minimize(const SmoothProgram& program, int evaluations, double tolerance) {
  const Eigen::Index n = program.start.size();
  TRACKBED_CHECK(n > 0 && program.lower.size() == n && program.upper.size() == n,
                 "{} variables, {} lower and {} upper bounds", n, program.lower.size(),
                 program.upper.size());
  TRACKBED_CHECK(program.lower.allFinite() && program.upper.allFinite() &&
                     program.start.allFinite() &&
                     (program.lower.array() <= program.upper.array()).all(),
                 "a bound or the start is not finite, or a lower bound is above the upper one");
  Evaluations seen(program, tolerance);
  nlopt::opt search(nlopt::LD_SLSQP, static_cast<unsigned>(n));
  search.set_lower_bounds({program.lower.begin(), program.lower.end()});
  search.set_upper_bounds({program.upper.begin(), program.upper.end()});
  search.set_min_objective(ObjectiveOf, &seen);
  if (program.equal_count > 0) {
    search.add_equality_mconstraint(EqualOf, &seen, Filled(program.equal_count, tolerance));
  }
  if (program.at_most_0_count > 0) {
    search.add_inequality_mconstraint(AtMost0Of, &seen, Filled(program.at_most_0_count, tolerance));
  }
  search.set_maxeval(evaluations);
  search.set_xtol_abs(tolerance);
  const Eigen::VectorXd start = program.start.cwiseMax(program.lower).cwiseMin(program.upper);
  std::vector<double> x(start.begin(), start.end());
  try {
    double value = 0.0;
    search.optimize(x, value);
  } catch (const nlopt::roundoff_limited&) {
    // Rounding errors prevent further progress of NLopt; return the best point so far.
  } catch (const std::runtime_error&) {
    // NLopt's least-squares solver failed; return the best point so far.
  }
  return seen.best();
}

}  // namespace trackbed
