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
/// The plant restarts at the recorded state every `horizon` and predicts until the next restart.
/// With r_ij the residuals of one signal in window i divided by their deviation, the estimate
/// minimizes
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
/// identified: it is held at its start, and the others are estimated again. Of parameters that the
/// records cannot distinguish, all but one are held in the same way.
namespace trackbed {

enum class ParameterStatus {
  kIdentified,
  kAtLowerBound,   ///< the estimate is a bound; it has no standard error
  kAtUpperBound,   ///< no standard error, as for kAtLowerBound
  kNotIdentified,  ///< the records do not determine it: held at its start
  kUnfinished,     ///< the search was interrupted: best value so far
};

/// "identified", "at_lower_bound", …: the spelling of identify.json.
const char* ToString(ParameterStatus status);

struct ParameterEstimate {
  IdentifiedParameter parameter;
  double start = 0.0;  ///< where the first search began
  double value = 0.0;  ///< of the fitted model; the start of a parameter that is not identified
  ParameterStatus status = ParameterStatus::kIdentified;
  std::optional<double> standard_error{};  ///< of identified parameters
  std::string remark{};  ///< why it is not identified, or which parameter it is hard to tell from
};

/// One record, replayed on every plant of its scenario by the model before and after the fit.
struct IdentifiedRecord {
  std::string name;  ///< of the scenario
  bool held_out = false;
  RunResult start;
  RunResult fitted;
};

struct IdentificationResult {
  Identification study;
  std::vector<ParameterEstimate> parameters;
  std::vector<std::vector<double>> correlation;  ///< of the identified parameters, in their order
  double start_cost = 0.0;
  double cost = 0.0;
  std::vector<double>
      start_costs;  ///< minimum reached by each search: equal values suggest a single minimum
  int windows = 0;
  int evaluations = 0;  ///< of the cost
  bool interrupted = false;
  Scene model;  ///< with the estimates and their origins as comments
  std::vector<IdentifiedRecord> records;
  double wall_time = 0.0;  ///< [s]

  [[nodiscard]] const ParameterEstimate* Find(const std::string& name) const;
};

struct IdentificationHooks {
  std::function<void(double fraction)> progress{};  ///< upper estimate of the work done
  /// Ends the search early, with the best result so far and without replays of the records; before
  /// the first evaluation with a RunError. Called by several threads.
  std::function<bool()> interrupted{};
  int threads = 1;
};

/// Estimates the parameters, and replays every record with the model before and after.
///
/// Guarantees: the same study gives the same estimates, bit for bit, with any number of threads;
/// estimates lie within their bounds; the cost is never above that of the start. Does not prove
/// that there is no better minimum. Errors: InputError, placed in the study's file, for parameters
/// that the model does not have, for a start with which it cannot be compiled, and when no window
/// of the records can be used. Cost: 2 p + 2 evaluations per step of the search, each the
/// simulation of all windows and one compilation of the model; about ten steps per start.
IdentificationResult Identify(const Identification& study, const IdentificationHooks& hooks = {});

/// Checks that the model has the parameters of a study and compiles with their start values.
/// Errors: as Identify.
void CheckIdentification(const Identification& study);

/// The content of identify.json.
nlohmann::ordered_json ToJson(const IdentificationResult& result);

/// The names of the files that WriteIdentification writes to its folder, by the study alone.
std::vector<std::string> IdentificationFiles(const Identification& study);

/// The run folder of a record below the output folder. RunError as FolderBelow.
std::filesystem::path RecordFolder(const std::filesystem::path& folder, const std::string& record);

/// Writes identify.json, the fitted model `<vehicle>.xml` with its assets, timing.json, and for
/// each record `<record>.residuals.csv` and a run folder with the fitted model in
/// `records/<record>`.
void WriteIdentification(const IdentificationResult& result, const OutputFolder& folder);

}  // namespace trackbed
