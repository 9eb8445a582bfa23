#include "trackbed/optimize/search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <nlopt.hpp>

#include "trackbed/core/error.h"

// Minimizes functions with NLopt under bounds and inequality constraints. Methods that support
// constraints (isres, cobyla, slsqp) receive the constraints. For an infeasible point, all other
// methods receive an objective value of at least 1e100, which grows with the violation. DIRECT
// receives infinity for an infeasible point. The class Evaluator stores the values at the last
// point, counts evaluations and computes gradients by central differences. Evaluator also keeps the
// best point: the point with the smallest violation and, among points with equal violation, the
// smallest objective.

namespace trackbed {
namespace {

/// Smallest objective value that a method without support for constraints receives for an
/// infeasible point.
constexpr double kInfeasibleCost = 1e100;

/// Specifies how constraints are passed to a search method.
enum class Handling {
  kNative,  ///< The search method itself supports constraints.
  /// The search method only compares objective values. Infeasible points receive worse values than
  /// all feasible points.
  kRanked,
  /// The search method receives infinity for infeasible points and estimates a value from
  /// neighboring points.
  kHidden,
};

Handling ConstraintHandling(nlopt::algorithm algorithm) {
  switch (algorithm) {
    case nlopt::GN_ISRES:
    case nlopt::LN_COBYLA:
    case nlopt::LD_SLSQP:
      return Handling::kNative;
    case nlopt::GN_ORIG_DIRECT_L:
      return Handling::kHidden;
    default:
      return Handling::kRanked;
  }
}

nlopt::algorithm NloptAlgorithm(SearchMethod method) {
  switch (method) {
    case SearchMethod::kIsres:
      return nlopt::GN_ISRES;
    case SearchMethod::kEsch:
      return nlopt::GN_ESCH;
    case SearchMethod::kCrs2:
      return nlopt::GN_CRS2_LM;
    case SearchMethod::kDirect:
      return nlopt::GN_ORIG_DIRECT_L;
    case SearchMethod::kCobyla:
      return nlopt::LN_COBYLA;
    case SearchMethod::kNelderMead:
      return nlopt::LN_NELDERMEAD;
    case SearchMethod::kSlsqp:
      return nlopt::LD_SLSQP;
  }
  throw InternalError("no such search");
}

/// Evaluates points for NLopt's callbacks, counts evaluations and keeps the best point.
class Evaluator {
 public:
  Evaluator(const SearchProblem& problem, const SearchOptions& options, int budget,
            Handling handling)
      : problem_(problem),
        options_(options),
        budget_(budget),
        handling_(handling),
        point_(problem.lower.size()),
        constraints_(problem.constraint_count),
        next_record_(options.population) {
    result_.violation = std::numeric_limits<double>::infinity();
    result_.value = std::numeric_limits<double>::infinity();
  }

  /// Returns the objective value for the search method, and computes the gradient if requested.
  double Objective(const double* x, double* gradient) {
    Evaluate(x);
    const double seen = MethodValue();
    if (gradient != nullptr) {
      Differentiate(x);
      std::copy(gradient_.begin(), gradient_.end(), gradient);
    }
    return seen;
  }

  void Constraints(const double* x, double* values, double* gradient) {
    Evaluate(x);
    std::copy(constraints_.begin(), constraints_.end(), values);
    if (gradient != nullptr) {
      Differentiate(x);
      std::copy(jacobian_.begin(), jacobian_.end(), gradient);
    }
  }

  [[nodiscard]] const SearchResult& best() const { return result_; }

  SearchResult Take() {
    if (result_.history.empty() || result_.history.back().evaluations != result_.evaluations) {
      Record();
    }
    return std::move(result_);
  }

  std::exception_ptr failure;  // exception thrown by the objective or a constraint

 private:
  void Evaluate(const double* x) {
    if (evaluated_ && std::equal(point_.begin(), point_.end(), x)) {
      // Skip a point that is already evaluated, because NLopt requests the objective and the
      // constraints of a point one after the other.
      return;
    }
    if (result_.evaluations >= budget_) {
      throw nlopt::forced_stop();
    }
    evaluated_ = false;
    std::copy_n(x, point_.size(), point_.begin());
    if (!failure) {
      try {
        value_ = problem_.objective(point_);
        if (!constraints_.empty()) {
          problem_.constraints(point_, constraints_);
        }
      } catch (...) {
        failure = std::current_exception();
        // The algorithm DIRECT in NLopt 2.7.1 reads uninitialized memory if it is stopped during
        // its first points. If the objective or a constraint throws an exception, DIRECT continues
        // to its end, but objective and constraints are no longer called.
        if (options_.method != SearchMethod::kDirect) {
          throw nlopt::forced_stop();
        }
      }
    }
    if (failure) {
      value_ = std::numeric_limits<double>::quiet_NaN();
    }
    evaluated_ = true;
    ++result_.evaluations;
    violation_ = 0.0;
    bool finite = std::isfinite(value_);
    for (const double c : constraints_) {
      finite = finite && std::isfinite(c);
      violation_ = std::max(violation_, c);
    }
    violation_ = violation_ <= options_.feasible ? 0.0 : violation_;
    if (!finite) {
      violation_ = std::numeric_limits<double>::infinity();
    }
    KeepIfBest();
    if (result_.evaluations == next_record_) {
      Record();
      next_record_ += options_.population;
    }
  }

  void KeepIfBest() {
    if (!std::isfinite(violation_)) {
      return;
    }
    const bool better = violation_ < result_.violation ||
                        (violation_ == result_.violation && value_ < result_.value);
    if (better) {
      result_.status = violation_ == 0.0 ? SearchStatus::kFound : SearchStatus::kInfeasible;
      result_.x = point_;
      result_.value = value_;
      result_.violation = violation_;
    }
  }

  void Record() {
    if (result_.status != SearchStatus::kNotFinite) {
      result_.history.push_back({result_.evaluations, result_.value, result_.violation, result_.x});
    }
  }

  /// Returns the objective value that the search method receives. MethodValue never returns NaN,
  /// because NLopt must be able to compare the values.
  [[nodiscard]] double MethodValue() const {
    if (handling_ == Handling::kHidden && violation_ > 0.0) {
      return std::numeric_limits<double>::infinity();
    }
    if (!std::isfinite(violation_)) {
      return 3.0 * kInfeasibleCost;
    }
    if (handling_ == Handling::kRanked && violation_ > 0.0) {
      return kInfeasibleCost * (1.0 + violation_ / (1.0 + violation_));
    }
    return value_;
  }

  /// Computes the gradients of the objective and of the constraints (row by row) by central
  /// differences. At the bounds of the variables, the differences are one-sided. The gradients are
  /// cached, because NLopt requests the gradients of the objective and of the constraints one after
  /// the other.
  void Differentiate(const double* x) {
    if (differentiated_at_.size() == point_.size() &&
        std::equal(differentiated_at_.begin(), differentiated_at_.end(), x)) {
      return;
    }
    // Step of the central differences, as a fraction of the variable's range. The cube root of the
    // relative rounding error is the best step for finite differences, because it balances the
    // rounding error and the truncation error of a central difference.
    constexpr double kStep = 6e-6;
    const std::size_t n = point_.size();
    std::vector<double> at(x, x + n);
    std::vector<double> ahead(constraints_.size());
    gradient_.assign(n, 0.0);
    jacobian_.assign(n * constraints_.size(), 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      const double step = kStep * (problem_.upper[i] - problem_.lower[i]);
      const double high = std::min(x[i] + step, problem_.upper[i]);
      const double low = std::max(x[i] - step, problem_.lower[i]);
      if (!(high > low)) {
        continue;
      }
      at[i] = high;
      Evaluate(at.data());
      const double seen_ahead = MethodValue();
      std::copy(constraints_.begin(), constraints_.end(), ahead.begin());
      at[i] = low;
      Evaluate(at.data());
      at[i] = x[i];
      gradient_[i] = (seen_ahead - MethodValue()) / (high - low);
      for (std::size_t row = 0; row < constraints_.size(); ++row) {
        jacobian_[row * n + i] = (ahead[row] - constraints_[row]) / (high - low);
      }
    }
    differentiated_at_.assign(x, x + n);
  }

  const SearchProblem& problem_;
  const SearchOptions& options_;
  int budget_;
  Handling handling_;
  bool evaluated_ = false;
  std::vector<double> point_;  // last point that was evaluated
  double value_ = 0.0;
  double violation_ = 0.0;
  std::vector<double> constraints_;
  std::vector<double> differentiated_at_;
  // Gradient, at the point `differentiated_at_`, of the objective value that the search method
  // receives.
  std::vector<double> gradient_;
  std::vector<double> jacobian_;
  int next_record_;
  SearchResult result_;
};

double ObjectiveCallback(unsigned /*n*/, const double* x, double* gradient, void* evaluator) {
  return static_cast<Evaluator*>(evaluator)->Objective(x, gradient);
}

void ConstraintsCallback(unsigned /*m*/, double* values, unsigned /*n*/, const double* x,
                         double* gradient, void* evaluator) {
  static_cast<Evaluator*>(evaluator)->Constraints(x, values, gradient);
}

void CheckProblem(const SearchProblem& problem, const SearchOptions& options) {
  const std::size_t n = problem.lower.size();
  TRACKBED_CHECK(n > 0 && problem.upper.size() == n, "{} lower and {} upper bounds", n,
                 problem.upper.size());
  TRACKBED_CHECK(problem.start.empty() || problem.start.size() == n, "{} variables, a start of {}",
                 n, problem.start.size());
  for (std::size_t i = 0; i < n; ++i) {
    TRACKBED_CHECK(std::isfinite(problem.lower[i]) && std::isfinite(problem.upper[i]) &&
                       problem.lower[i] <= problem.upper[i],
                   "bounds {} and {} of variable {}", problem.lower[i], problem.upper[i], i);
  }
  TRACKBED_CHECK(options.population > static_cast<int>(n) + 1 && options.evaluations >= 0 &&
                     options.tolerance >= 0.0 && options.feasible >= 0.0,
                 "population {}, evaluations {}, tolerance {}, feasible {}", options.population,
                 options.evaluations, options.tolerance, options.feasible);
}

struct Box {
  std::vector<double> lower;
  std::vector<double> upper;
};

/// Returns a smaller box for the next run of DIRECT, centered at x and clipped to the problem's
/// bounds. Before clipping, the volume of the smaller box is a fiftieth of the volume of `box`.
Box Zoomed(const SearchProblem& problem, const Box& box, const std::vector<double>& x) {
  Box zoomed = box;
  const double share = std::pow(0.02, 1.0 / static_cast<double>(x.size()));
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double half = 0.5 * share * (box.upper[i] - box.lower[i]);
    zoomed.lower[i] = std::max(problem.lower[i], x[i] - half);
    zoomed.upper[i] = std::min(problem.upper[i], x[i] + half);
  }
  return zoomed;
}

/// Runs an NLopt algorithm once, and stores the best point in the Evaluator.
void Run(nlopt::algorithm algorithm, const SearchProblem& problem, const Box& box,
         std::vector<double> x, int evaluations, const SearchOptions& options,
         Evaluator& evaluator) {
  nlopt::opt search(algorithm, static_cast<unsigned>(x.size()));
  search.set_lower_bounds(box.lower);
  search.set_upper_bounds(box.upper);
  search.set_min_objective(ObjectiveCallback, &evaluator);
  if (problem.constraint_count > 0 && ConstraintHandling(algorithm) == Handling::kNative) {
    search.add_inequality_mconstraint(ConstraintsCallback, &evaluator,
                                      std::vector<double>(problem.constraint_count, 0.0));
  }
  search.set_maxeval(evaluations);
  search.set_population(static_cast<unsigned>(options.population));
  std::vector<double> tolerance(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = std::clamp(x[i], box.lower[i], box.upper[i]);
    tolerance[i] = options.tolerance * (problem.upper[i] - problem.lower[i]);
  }
  search.set_xtol_abs(tolerance);
  try {
    double value = 0.0;
    search.optimize(x, value);
  } catch (const nlopt::forced_stop&) {
    // The Evaluator stopped NLopt, because the budget of evaluations is exhausted, or the objective
    // or a constraint threw an exception.
  } catch (const nlopt::roundoff_limited&) {
    // NLopt ended the search, because rounding errors prevent further progress.
  } catch (const std::runtime_error&) {
    // NLopt failed, for example because slsqp needed too many steps in its least-squares solver.
    // The result of the search is the best point evaluated before the failure.
  }
}

}  // namespace

const std::vector<SearchEntry>& Searches() {
  static const std::vector<SearchEntry> table{
      {SearchMethod::kIsres, "isres", "improved stochastic ranking evolution strategy (Runarsson)",
       true, true, 10000},
      {SearchMethod::kEsch, "esch", "evolutionary algorithm with Cauchy mutation (Santos)", true,
       true, 10000},
      {SearchMethod::kCrs2, "crs2", "controlled random search with local mutation (Kaelo, Ali)",
       true, true, 10000},
      {SearchMethod::kDirect, "direct", "dividing rectangles, locally biased (Gablonsky, Kelley)",
       false, true, 240},
      {SearchMethod::kCobyla, "cobyla", "linear approximations over a simplex (Powell)", false,
       false, 1000},
      {SearchMethod::kNelderMead, "nelder_mead", "downhill simplex (Nelder, Mead)", false, false,
       1000},
      {SearchMethod::kSlsqp, "slsqp", "sequential quadratic programming, differenced (Kraft)",
       false, false, 2000},
  };
  return table;
}

const SearchEntry& SearchFor(SearchMethod method) {
  for (const SearchEntry& entry : Searches()) {
    if (entry.method == method) {
      return entry;
    }
  }
  throw InternalError("a search that is not in the table");
}

const char* ToString(SearchStatus status) {
  switch (status) {
    case SearchStatus::kFound:
      return "found";
    case SearchStatus::kInfeasible:
      return "infeasible";
    case SearchStatus::kNotFinite:
      return "not_finite";
  }
  throw InternalError("no such search status");
}

std::string OptimizerVersion() {
  return fmt::format("NLopt {}.{}.{}", nlopt::version_major(), nlopt::version_minor(),
                     nlopt::version_bugfix());
}

SearchResult Search(const SearchProblem& problem, const SearchOptions& options,
                    std::uint64_t seed) {
  CheckProblem(problem, options);
  const std::size_t n = problem.lower.size();
  const int budget =
      options.evaluations > 0 ? options.evaluations : SearchFor(options.method).evaluations;
  const nlopt::algorithm algorithm = NloptAlgorithm(options.method);
  Evaluator evaluator(problem, options, budget, ConstraintHandling(algorithm));

  Box box{problem.lower, problem.upper};
  std::vector<double> start(n);
  for (std::size_t i = 0; i < n; ++i) {
    start[i] = problem.start.empty() ? 0.5 * (box.lower[i] + box.upper[i])
                                     : std::clamp(problem.start[i], box.lower[i], box.upper[i]);
  }
  // Seed NLopt's random number generator, because its default seed is the clock. In NLopt, each
  // thread has a separate random number generator with a 32-bit seed.
  if (SearchFor(options.method).random) {
    nlopt::srand(static_cast<unsigned long>((seed ^ (seed >> 32U)) & 0xffffffffU));
  }
  // Run DIRECT three times, each time in a smaller box, because its computing time grows with the
  // square of the number of its cells.
  const int looks = options.method == SearchMethod::kDirect ? 3 : 1;
  // End the loop if no evaluations are left, because NLopt's DIRECT reads uninitialized memory if
  // it is stopped at its first evaluation. As long as it finds no feasible point, a run of DIRECT
  // exceeds its share of the budget.
  const auto goes_on = [&] { return !evaluator.failure && evaluator.best().evaluations < budget; };
  for (int look = 0; look < looks && goes_on(); ++look) {
    if (look > 0 && evaluator.best().status != SearchStatus::kNotFinite) {
      box = Zoomed(problem, box, evaluator.best().x);
    }
    Run(algorithm, problem, box, start, budget / looks, options, evaluator);
  }
  if (evaluator.failure) {
    std::rethrow_exception(evaluator.failure);
  }
  return evaluator.Take();
}

void Visit(KeyVisitor& keys, SearchOptions& options) {
  static const EnumNames<SearchMethod> methods = [] {
    EnumNames<SearchMethod> names;
    for (const SearchEntry& entry : Searches()) {
      names.emplace_back(entry.method, entry.name);
    }
    return names;
  }();
  keys.Field({"method", "", "optimizer; see 'trackbed list optimizers'"}, options.method,
             Need::kOptional, methods);
  keys.Field({"population", "", "population size of isres, esch and crs2"}, options.population,
             Need::kOptional, Range{.min = 3, .max = 1e5});
  keys.Field({"evaluations", "", "maximum number of evaluations; 0: the method's default"},
             options.evaluations, Need::kOptional, Range{.min = 0, .max = 1e8});
  keys.Field({"tolerance", "",
              "termination tolerance on the variables, as a fraction of their bounds; 0: none"},
             options.tolerance, Need::kOptional, Range{.min = 0.0, .max = 1.0});
}

}  // namespace trackbed
