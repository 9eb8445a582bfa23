#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/analysis/run.h"
#include "trackbed/scenario/identification.h"

/// Estimates parameters of a car model from recorded drives.
///
/// The plant restarts at the recorded state after every `horizon`, and predicts the motion until
/// the next restart. A window is the time between two restarts of the plant. Let r_ij be the
/// residuals of one signal in window i, divided by the signal's expected standard deviation. The
/// estimate p minimizes
///     J(p) = sum over windows and signals of mean_j rho(r_ij)
///            + 1/2 sum_k ((p_k - mean_k)/deviation_k)^2
/// within the bounds. Each window counts as a single measurement of each signal, because
/// consecutive residuals are not independent. The search is repeated from several start points and
/// takes Gauss-Newton steps within a trust region. Each step solves a quadratic program with the
/// parameters' bounds as constraints (NLopt's SLSQP).
///
/// Unless the study has `steering_offset: false`, the constant `steering_offset` of the car
/// (sim/car_parameters.h) is estimated besides the parameters of the study, between -0.1 and 0.1
/// rad. If the records do not determine the steering offset together with the other parameters, the
/// steering offset is the first parameter that is fixed instead of estimated. The steering offset
/// is not added to the parameters if it is already a parameter of the study, or if the study
/// already has 40 parameters. The steering offset is not estimated, either, for vehicles without
/// steered wheels, and if a record has prescribed steering, which bypasses the offset.
///
/// If the study has `bank`, the bank of the track on which all records were driven is estimated,
/// too. The estimated bank (cross slope) is a closed spline over the station of the track. The
/// spline's coefficients bank[0], bank[1], … have normal prior distributions about 0. The search
/// for the bank starts at a flat track. All records are replayed on the estimated ground
/// (recording/banked_track.h).
///
/// Standard errors are computed as for an M-estimator with windows as independent clusters (Huber
/// 1967; White 1980). The covariance matrix of the estimates is H^-1 (sum_i g_i g_i^T) H^-1 n/(n -
/// p), where g_i is the gradient of window i, n the number of windows, p the number of parameters,
/// and H the Gauss-Newton Hessian of the cost J. A parameter is not identified if its standard
/// error exceeds the standard deviation of a uniform distribution over the parameter's bounds, (to
/// - from)/sqrt(12). A parameter that is not identified is held at its start value, and the other
/// parameters are estimated again. If several parameters have the same effect on the records, only
/// one of these parameters is estimated.
namespace trackbed {

enum class ParameterStatus {
  kIdentified,
  kAtLowerBound,  ///< The estimate is the parameter's lower bound and has no standard error.
  kAtUpperBound,  ///< The estimate is the parameter's upper bound and has no standard error.
  /// The parameter keeps its start value, because the records do not determine the parameter.
  kNotIdentified,
  /// The search was interrupted before it was finished. The parameter's value is the best estimate
  /// found before the interruption of the search.
  kUnfinished,
};

/// Returns the name of a status as written in identify.json, such as "identified" or
/// "at_lower_bound".
const char* ToString(ParameterStatus status);

struct ParameterEstimate {
  IdentifiedParameter parameter;
  double start = 0.0;  ///< Value of the parameter at the start of the first search.
  /// Value of the parameter in the fitted model; the start value if the parameter is not
  /// identified.
  double value = 0.0;
  ParameterStatus status = ParameterStatus::kIdentified;
  /// Standard error of the estimate; nullopt if the parameter is not identified.
  std::optional<double> standard_error{};
  /// Reason why the parameter is not identified, or the name of another parameter with a similar
  /// effect on the records.
  std::string remark{};
};

/// One recorded drive, replayed on every plant of the record's scenario, with the model before and
/// after the fit.
struct IdentifiedRecord {
  std::string name;  ///< Name of the record's scenario.
  bool held_out = false;
  RunResult start;
  RunResult fitted;
};

struct IdentificationResult {
  Identification study;
  std::vector<ParameterEstimate> parameters;
  /// Correlation matrix of the estimates, in the order of the identified parameters.
  std::vector<std::vector<double>> correlation;
  double start_cost = 0.0;
  double cost = 0.0;
  /// Lowest cost found by each search; equal values suggest that the cost has a single minimum.
  std::vector<double> start_costs;
  int windows = 0;
  int evaluations = 0;  ///< Number of times that the cost was evaluated.
  bool interrupted = false;
  /// Faults of the records that bias the estimates, such as "drive: yaw_rate lags the motion of the
  /// pose by 0.36 s ..." (recording/record_clocks.h).
  std::vector<std::string> notes;
  /// Fitted model as XML, with comments that state the estimates and the source of each estimate.
  Scene model;
  /// The track with the estimated bank; null if the study does not estimate the bank.
  std::shared_ptr<const BankedTrack> bank{};
  std::vector<IdentifiedRecord> records;
  double wall_time = 0.0;  ///< Wall-clock time [s].

  [[nodiscard]] const ParameterEstimate* Find(const std::string& name) const;
};

struct IdentificationHooks {
  /// Receives the finished fraction of the identification, which is estimated and may be too high.
  std::function<void(double fraction)> progress{};
  /// Returns true to end the search early; called by several threads. After an interruption,
  /// Identify returns the best estimate found so far, without replays of the records. Identify
  /// throws RunError if the search is interrupted before the cost was evaluated for the first time.
  std::function<bool()> interrupted{};
  int threads = 1;
};

/// Estimates the parameters of a study, then replays every record with the model before and after
/// the fit.
///
/// Guarantees: the same study always yields the same estimates, bit for bit, with any number of
/// threads. Estimates lie within the parameters' bounds, and the cost of the estimates is never
/// above the cost of the start values. A lower minimum of the cost than the one that the search
/// finds may exist. Throws InputError, with the line in the study's file, if the model does not
/// have a parameter, or if the model cannot be compiled with the start values. Also throws
/// InputError if no window of the records can be used. The search takes about ten steps per start,
/// and each step evaluates the cost 2 p + 2 times for p parameters. Each evaluation of the cost
/// compiles the model once and simulates all windows.
IdentificationResult Identify(const Identification& study, const IdentificationHooks& hooks = {});

/// Checks that the model has all parameters of a study, and that the model can be compiled with the
/// start values of the parameters. Throws InputError in the same cases as Identify.
void CheckIdentification(const Identification& study);

}  // namespace trackbed
