#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "trackbed/options/key_visitor.h"

/// The registry of search methods, with a common interface for NLopt's evolutionary, global,
/// simplex and gradient methods.
///
///   minimize f(x)  subject to  c_j(x) <= 0  and  lower <= x <= upper
namespace trackbed {

/// A search problem. An optimization problem for the search. The results of the functions
/// `objective` and `constraints` must depend only on x. A point is infeasible if its objective or a
/// constraint is not finite. If `objective` or `constraints` throws an exception, the search ends
/// and rethrows the exception.
struct SearchProblem {
  std::vector<double> lower;  ///< Lower bounds of the variables, finite, one per variable.
  std::vector<double> upper;  ///< Upper bounds of the variables, finite, >= `lower`.
  /// Initial point of the search, clamped to the bounds; if empty, the search starts in the middle
  /// between the bounds.
  std::vector<double> start;
  std::function<double(std::span<const double> x)> objective;
  std::size_t constraint_count = 0;
  /// Computes the constraint values c_j(x) as `values`, one per constraint. The constraint values
  /// must be scaled so that the tolerance `SearchOptions::feasible` suits all constraints.
  std::function<void(std::span<const double> x, std::span<double> values)> constraints;
};

enum class SearchMethod { kIsres, kEsch, kCrs2, kDirect, kCobyla, kNelderMead, kSlsqp };

struct SearchEntry {
  SearchMethod method;
  const char* name;
  const char* summary;
  bool random;  ///< Whether the method uses random numbers; the result then depends on the seed.
  /// Whether the method searches globally between the bounds, not only downhill from the start
  /// point.
  bool global;
  int evaluations;  ///< Default maximum number of evaluations of the objective.
};

/// All search methods.
const std::vector<SearchEntry>& Searches();
const SearchEntry& SearchFor(SearchMethod method);

struct SearchOptions {
  SearchMethod method = SearchMethod::kIsres;
  /// Population size of the methods isres, esch and crs2; must exceed the number of variables + 1.
  int population = 100;
  /// Maximum number of evaluations of the objective; 0: the method's default (SearchEntry). If a
  /// method requests the same point twice in a row, the point is evaluated only once.
  int evaluations = 0;
  /// The search stops when x changes by less than this fraction of the distance between the bounds;
  /// 0: the search does not use this criterion. The search methods isres and esch ignore the
  /// tolerance of x and always use the maximum number of evaluations.
  double tolerance = 1e-9;
  /// Tolerance of the constraints: a point is feasible if all constraints are at most this value.
  double feasible = 1e-9;
};
void Visit(KeyVisitor& keys, SearchOptions& options);

enum class SearchStatus {
  /// The search found a point that meets all bounds and constraints and has a finite objective.
  kFound,
  /// The search found no feasible point; x is the evaluated point that violates the constraints
  /// least.
  kInfeasible,
  kNotFinite,  ///< At no evaluated point are the objective and all constraints finite.
};

/// Returns the name of a status as written in plan.json, such as "found" or "infeasible".
const char* ToString(SearchStatus status);

/// Progress of the search: the best point found after a number of evaluations.
struct SearchProgress {
  int evaluations = 0;
  /// Objective at the best point so far; may rise during the search while the best point is
  /// infeasible.
  double value = 0.0;
  /// Largest value of a constraint at the best point; 0 if the point is feasible.
  double violation = 0.0;
  std::vector<double> x;
};

struct SearchResult {
  SearchStatus status = SearchStatus::kNotFinite;
  std::vector<double> x;
  double value = 0.0;      ///< Objective at x.
  double violation = 0.0;  ///< Largest value of a constraint at x; 0 if x is feasible.
  int evaluations = 0;
  /// Progress of the search, after every `population` evaluations and at the end.
  std::vector<SearchProgress> history;

  [[nodiscard]] bool ok() const { return status == SearchStatus::kFound; }
};

/// Runs a search. Guarantees: the result is the best evaluated point: a feasible point is better
/// than an infeasible point, and among feasible points the lowest objective is best. The returned
/// point lies within the bounds of the variables. The return status of NLopt is ignored. The same
/// problem, options and seed give the same result bit for bit, in any thread. For esch, crs2 and
/// nelder_mead, which do not support constraints, every infeasible point is treated as worse than
/// every feasible point. For the method direct, infeasible points have no objective, so direct may
/// miss a feasible region that is smaller than the cells into which the method divides the search
/// space. The method slsqp computes gradients by central differences, and the evaluations for these
/// differences are counted. The search does not prove that there is no feasible point, nor that the
/// minimum is global. Throws InternalError for invalid bounds or options. Computing time: the time
/// of the evaluations, plus the time of NLopt itself (about 24 ms for isres with its defaults).
SearchResult Search(const SearchProblem& problem, const SearchOptions& options, std::uint64_t seed);

/// Returns the name and version of the optimizer, such as "NLopt 2.7.1".
std::string OptimizerVersion();

}  // namespace trackbed
