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

/// A search problem. The functions `objective` and `constraints` are pure functions of x. A point
/// at which a value is not finite is infeasible. An exception of either function ends the search
/// and is rethrown.
struct SearchProblem {
  std::vector<double> lower;  ///< Lower bounds, finite, one per variable.
  std::vector<double> upper;  ///< Upper bounds, finite, >= lower.
  /// Initial point, clamped to the bounds; empty: middle of the bounds.
  std::vector<double> start;
  std::function<double(std::span<const double> x)> objective;
  std::size_t constraint_count = 0;
  /// Computes `values`, one per constraint, scaled to suit the tolerance `SearchOptions::feasible`.
  std::function<void(std::span<const double> x, std::span<double> values)> constraints;
};

enum class SearchMethod { kIsres, kEsch, kCrs2, kDirect, kCobyla, kNelderMead, kSlsqp };

struct SearchEntry {
  SearchMethod method;
  const char* name;
  const char* summary;
  bool random;  ///< Whether the method draws random numbers, so that the seed matters.
  /// Whether the method searches the whole box, not only downhill from the start.
  bool global;
  int evaluations;  ///< Default number of evaluations.
};

/// All search methods.
const std::vector<SearchEntry>& Searches();
const SearchEntry& SearchFor(SearchMethod method);

struct SearchOptions {
  SearchMethod method = SearchMethod::kIsres;
  /// Population of isres, esch and crs2; must exceed the number of variables + 1.
  int population = 100;
  /// Maximum number of evaluations of the objective; 0: the method's default (SearchEntry). A point
  /// requested twice in a row is evaluated once.
  int evaluations = 0;
  /// Tolerance of x, as a fraction of the distance between the bounds; 0: none. The methods isres
  /// and esch ignore the tolerance and use all their evaluations.
  double tolerance = 1e-9;
  double feasible = 1e-9;  ///< Largest value of a constraint at a feasible point.
};
void Visit(KeyVisitor& keys, SearchOptions& options);

enum class SearchStatus {
  /// A point within bounds and constraints, with a finite objective, was found.
  kFound,
  /// No feasible point was found; x is the point that violates the constraints least.
  kInfeasible,
  kNotFinite,  ///< No evaluation gave a finite objective and finite constraints.
};

/// Returns the name of a status as written in plan.json: "found", "infeasible", ….
const char* ToString(SearchStatus status);

/// The best point found after a number of evaluations.
struct SearchProgress {
  int evaluations = 0;
  double value = 0.0;      ///< Objective of the best point; may rise if the point is infeasible.
  double violation = 0.0;  ///< Largest constraint, 0 if feasible.
  std::vector<double> x;
};

struct SearchResult {
  SearchStatus status = SearchStatus::kNotFinite;
  std::vector<double> x;
  double value = 0.0;      ///< Objective at x.
  double violation = 0.0;  ///< Largest constraint at x, 0 if feasible.
  int evaluations = 0;
  /// Progress after every `population` evaluations, and at the end.
  std::vector<SearchProgress> history;

  [[nodiscard]] bool ok() const { return status == SearchStatus::kFound; }
};

/// Runs a search. Guarantees: the result is the best evaluated point, by feasibility first and
/// objective second, and lies within the bounds. NLopt's own return status is ignored. The same
/// problem, options and seed give the same result bit for bit, in any thread. For esch, crs2 and
/// nelder_mead, which do not support constraints, every infeasible point ranks below every feasible
/// one. For direct, infeasible points have no value, so direct may miss a feasible set that is
/// narrower than its cells. The gradients of slsqp are central differences, which count as
/// evaluations. The search does not prove that there is no feasible point, nor that the minimum is
/// global. Errors: InternalError for invalid bounds or options. Cost: that of NLopt (isres with its
/// defaults about 24 ms) and of the evaluations.
SearchResult Search(const SearchProblem& problem, const SearchOptions& options, std::uint64_t seed);

/// The version of the optimizer, such as "NLopt 2.7.1".
std::string OptimizerVersion();

}  // namespace trackbed
