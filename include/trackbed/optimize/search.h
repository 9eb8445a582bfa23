#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "trackbed/options/key_visitor.h"

/// The one table of searches: NLopt's evolutionary, global, simplex and gradient methods behind one
/// interface.
///
///   minimize f(x)  subject to  c_j(x) <= 0  and  lower <= x <= upper
namespace trackbed {

/// What is searched. `objective` and `constraints` are pure functions of x; a value that is not
/// finite counts as infeasible. An exception thrown by either ends the search and reaches its
/// caller.
struct SearchProblem {
  std::vector<double> lower;  ///< finite, one per variable
  std::vector<double> upper;  ///< finite, >= lower
  std::vector<double> start;  ///< where to begin; cut to the bounds. Empty: the middle
  std::function<double(std::span<const double> x)> objective;
  std::size_t constraint_count = 0;
  /// Fills `values`, one per constraint, scaled so that `SearchOptions::feasible` means something.
  std::function<void(std::span<const double> x, std::span<double> values)> constraints;
};

enum class SearchMethod { kIsres, kEsch, kCrs2, kDirect, kCobyla, kNelderMead, kSlsqp };

struct SearchEntry {
  SearchMethod method;
  const char* name;
  const char* summary;
  bool random;      ///< draws random numbers: the seed matters
  bool global;      ///< looks everywhere within the bounds, not only downhill from the start
  int evaluations;  ///< the budget when none is given
};

/// Every search there is.
const std::vector<SearchEntry>& Searches();
const SearchEntry& SearchFor(SearchMethod method);

struct SearchOptions {
  SearchMethod method = SearchMethod::kIsres;
  int population = 100;  ///< of isres, esch and crs2, > the number of variables + 1
  int evaluations = 0;   ///< of the objective at most; 0: the method's own (SearchEntry). A point
                         ///< that is asked for twice in a row is evaluated once
  double tolerance = 1e-9;  ///< on x, as a share of the bounds; 0: none. Isres and esch use all
                            ///< their evaluations whatever it is
  double feasible = 1e-9;   ///< a constraint up to this counts as kept
};
void Visit(KeyVisitor& keys, SearchOptions& options);

enum class SearchStatus {
  kFound,       ///< a point that keeps bounds and constraints, with a finite objective
  kInfeasible,  ///< none was found; x is the one that violates least
  kNotFinite,   ///< no evaluation gave a finite objective and finite constraints
};

/// "found", "infeasible", …: the spelling of plan.json.
const char* ToString(SearchStatus status);

/// The best so far after a number of evaluations.
struct SearchProgress {
  int evaluations = 0;
  double value = 0.0;      ///< of the objective; of an infeasible point it may rise later
  double violation = 0.0;  ///< largest constraint, 0 when feasible
  std::vector<double> x;
};

struct SearchResult {
  SearchStatus status = SearchStatus::kNotFinite;
  std::vector<double> x;
  double value = 0.0;      ///< objective at x
  double violation = 0.0;  ///< largest constraint at x, 0 when feasible
  int evaluations = 0;
  std::vector<SearchProgress> history;  ///< one per `population` evaluations, and the end

  [[nodiscard]] bool ok() const { return status == SearchStatus::kFound; }
};

/// Searches. Guarantees: the result is the best point that was evaluated, by feasibility first and
/// objective second, whatever NLopt's own verdict; x lies within the bounds; the same problem,
/// options and seed give the same result bit for bit, in any thread. Methods that know no
/// constraints see them as a ranking below every feasible point (esch, crs2, nelder_mead) or as
/// points without a value (direct, which may miss a feasible set narrower than its cells).
/// Slsqp takes its gradients from central differences, which count as evaluations.
/// Does not prove that there is no feasible point, nor that the minimum is global.
/// Errors: InternalError for bounds or options that make no sense. Cost: that of NLopt (isres with
/// its defaults about 24 ms) and of the evaluations.
SearchResult Search(const SearchProblem& problem, const SearchOptions& options, std::uint64_t seed);

/// "NLopt 2.7.1"
std::string OptimizerVersion();

}  // namespace trackbed
