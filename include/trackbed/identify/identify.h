#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/analysis/output_folder.h"
#include "trackbed/analysis/run.h"
#include "trackbed/scenario/identification.h"

/// Estimates parameters of a car model from recorded drives.
///
/// The plant restarts at the recorded state after every `horizon` and predicts until the next
/// restart. With r_ij the residuals of one signal in window i divided by their deviation, the
/// estimate minimizes
///     J(p) = sum over windows and signals of mean_j rho(r_ij)
///            + 1/2 sum_k ((p_k - mean_k)/deviation_k)^2
/// within the bounds. A window counts as one measurement of each signal, since consecutive
/// residuals are not independent. The search takes Gauss-Newton steps within a trust region, each a
/// quadratic program with the bounds (NLopt's SLSQP), from several starts.
///
/// Standard errors are those of an M-estimator with windows as independent clusters (Huber 1967;
/// White 1980): the covariance is H^-1 (sum_i g_i g_i^T) H^-1 n/(n - p), g_i the gradient of window
/// i, n the number of windows, H the Gauss-Newton Hessian of J. A parameter whose standard error
/// exceeds the deviation of a uniform distribution over its bounds, (to - from)/sqrt(12), is not
/// identified: it is held at its start value, and the other parameters are estimated again. If the
/// records cannot distinguish several parameters, only one of them is estimated.
namespace trackbed {

enum class ParameterStatus {
  kIdentified,
  kAtLowerBound,  ///< The estimate is the lower bound; it has no standard error.
  kAtUpperBound,  ///< The estimate is the upper bound; it has no standard error.
  /// The records do not determine the parameter. The parameter is held at its start value.
  kNotIdentified,
  /// The search was interrupted. The value is the best one found before the interruption.
  kUnfinished,
};

/// Returns the name of a status as written in identify.json: "identified", "at_lower_bound", ….
const char* ToString(ParameterStatus status);

struct ParameterEstimate {
  IdentifiedParameter parameter;
  double start = 0.0;  ///< Start value of the first search.
  double value = 0.0;  ///< Value in the fitted model; the start value if not identified.
  ParameterStatus status = ParameterStatus::kIdentified;
  std::optional<double> standard_error{};  ///< Standard error of an identified parameter.
  /// Why the parameter is not identified, or from which parameter it is hard to distinguish.
  std::string remark{};
};

/// One record, replayed on every plant of its scenario with the model before and after the fit.
struct IdentifiedRecord {
  std::string name;  ///< Name of the scenario.
  bool held_out = false;
  RunResult start;
  RunResult fitted;
};

struct IdentificationResult {
  Identification study;
  std::vector<ParameterEstimate> parameters;
  /// Correlation matrix of the identified parameters, in their order.
  std::vector<std::vector<double>> correlation;
  double start_cost = 0.0;
  double cost = 0.0;
  /// Minimum found by each search; equal values suggest a single minimum.
  std::vector<double> start_costs;
  int windows = 0;
  int evaluations = 0;  ///< Number of evaluations of the cost.
  bool interrupted = false;
  Scene model;  ///< Fitted model, with the estimates and their origins as comments.
  std::vector<IdentifiedRecord> records;
  double wall_time = 0.0;  ///< Wall-clock time [s].

  [[nodiscard]] const ParameterEstimate* Find(const std::string& name) const;
};

struct IdentificationHooks {
  /// Called with an upper estimate of the finished fraction.
  std::function<void(double fraction)> progress{};
  /// Returns whether to end the search early; called by several threads. After an interruption, the
  /// result is the best one found so far, without replays of the records. If the search is
  /// interrupted before its first evaluation, Identify throws RunError.
  std::function<bool()> interrupted{};
  int threads = 1;
};

/// Estimates the parameters, then replays every record with the model before and after the fit.
///
/// Guarantees: the same study gives the same estimates, bit for bit, with any number of threads.
/// Estimates lie within their bounds, and the cost is never above that of the start values. The
/// search does not prove that there is no better minimum. Errors: InputError with a place in the
/// study's file, for parameters that the model does not have and for start values with which the
/// model cannot be compiled. InputError if no window of the records can be used. Cost: about ten
/// steps of the search per start, each with 2 p + 2 evaluations for p parameters. An evaluation
/// simulates all windows and compiles the model once.
IdentificationResult Identify(const Identification& study, const IdentificationHooks& hooks = {});

/// Checks that the model has the parameters of a study and compiles with their start values. Throws
/// the InputErrors of Identify.
void CheckIdentification(const Identification& study);

/// Returns the content of identify.json.
nlohmann::ordered_json ToJson(const IdentificationResult& result);

/// Returns the names of the files that WriteIdentification writes to its folder. The names depend
/// only on the study.
std::vector<std::string> IdentificationFiles(const Identification& study);

/// Returns the run folder of a record in the output folder. Throws the RunErrors of FolderBelow.
std::filesystem::path RecordFolder(const std::filesystem::path& folder, const std::string& record);

/// Writes identify.json, the fitted model `<vehicle>.xml` with its assets, and timing.json. For
/// each record, writes `<record>.residuals.csv`, and a run folder with the fitted model to
/// `records/<record>`.
void WriteIdentification(const IdentificationResult& result, const OutputFolder& folder);

}  // namespace trackbed
