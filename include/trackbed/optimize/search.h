#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "trackbed/options/key_visitor.h"

/// The registry of search methods: NLopt's evolutionary, global, simplex and gradient methods
/// behind one interface.
///
///   minimize f(x)  subject to  c_j(x) <= 0  and  lower <= x <= upper
namespace trackbed {

/// A search problem. `objective` and `constraints` are pure functions of x; a value that is not
/// finite counts as infeasible. An exception thrown by either ends the search and reaches its
/// caller.
struct SearchProblem {
  std::vector<double> lower;  ///< finite, one per variable
  std::vector<double> upper;  ///< finite, >= lower
  std::vector<double> start;  ///< initial point, clamped to the bounds; empty: the middle
  std::function<double(std::span<const double> x)> objective;
  std::size_t constraint_count = 0;
  /// Fills `values`, one per constraint, scaled to suit the tolerance `SearchOptions::feasible`.
  std::function<void(std::span<const double> x, std::span<double> values)> constraints;
};

enum class SearchMethod { kIsres, kEsch, kCrs2, kDirect, kCobyla, kNelderMead, kSlsqp };

struct SearchEntry {
  SearchMethod method;
  const char* name;
  const char* summary;
  bool random;      ///< draws random numbers: the seed matters
  bool global;      ///< searches the whole box, not only downhill from the start
  int evaluations;  ///< the default budget
};

/// All search methods.
const std::vector<SearchEntry>& Searches();
const SearchEntry& SearchFor(SearchMethod method);

struct SearchOptions {
  SearchMethod method = SearchMethod::kIsres;
  int population = 100;  ///< of isres, esch and crs2, > the number of variables + 1
  /// Maximum number of evaluations of the objective; 0: the method's default (SearchEntry). A point
  /// requested twice in a row is evaluated once.
  int evaluations = 0;
  /// On x, as a fraction of the bounds; 0: none. Isres and esch ignore it and use all their
  /// evaluations.
  double tolerance = 1e-9;
  double feasible = 1e-9;  ///< constraint values up to this are feasible
};
void Visit(KeyVisitor& keys, SearchOptions& options);

enum class SearchStatus {
  kFound,       ///< a point within bounds and constraints, with a finite objective
  kInfeasible,  ///< no feasible point was found; x violates the constraints least
  kNotFinite,   ///< no evaluation gave a finite objective and finite constraints
};

/// "found", "infeasible", …: the spelling of plan.json.
const char* ToString(SearchStatus status);

/// The best so far after a number of evaluations.
struct SearchProgress {
  int evaluations = 0;
  double value = 0.0;      ///< objective; may rise later if the point is infeasible
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

/// Runs a search. Guarantees: the result is the best point that was evaluated, by feasibility first
/// and objective second, regardless of NLopt's verdict; x lies within the bounds; the same problem,
/// options and seed give the same result bit for bit, in any thread. Methods without constraint
/// support see constraints as a ranking below every feasible point (esch, crs2, nelder_mead) or as
/// points without a value (direct, which may miss a feasible set narrower than its cells). Slsqp
/// takes its gradients from central differences, which count as evaluations. Does not prove that
/// there is no feasible point, nor that the minimum is global.
/// Errors: InternalError for invalid bounds or options. Cost: that of NLopt (isres with its
/// defaults about 24 ms) and of the evaluations.
SearchResult Search(const SearchProblem& problem, const SearchOptions& options, std::uint64_t seed);

/// "NLopt 2.7.1"
std::string OptimizerVersion();

}  // namespace trackbed
