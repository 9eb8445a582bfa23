#include "trackbed/identify/identify.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <utility>

#include "src/identify/bank_model.h"
#include "src/identify/estimator.h"
#include "src/identify/linear_model.h"
#include "src/identify/residuals.h"
#include "trackbed/core/error.h"
#include "trackbed/drive/drive.h"
#include "trackbed/recording/record_clocks.h"
#include "trackbed/sim/car_parameters.h"

// Identifies parameters of a car model from recorded drives (records). The cost is the sum of the
// losses of all prediction residuals in all windows (residuals.cpp), plus the terms of the priors.
// The cost is minimized by Gauss-Newton steps in a trust region, from several starts
// (estimator.cpp). Parameters without effect on the cost are fixed before the search. The
// covariance of the estimate (linear_model.cpp) shows whether the records determine each parameter
// more accurately than its bounds. If the records do not determine all parameters, the parameter
// with the largest variance is fixed and the search is repeated. Finally, all records are replayed
// with the start values and with the fitted values.
namespace trackbed {
namespace {

/// Correlation of two estimated parameters above which the records hardly distinguish the
/// parameters.
constexpr double kStrongCorrelation = 0.95;

/// Rethrows the error. Reports a problem with a parameter at the line of the study file that
/// defines the parameter.
[[noreturn]] void ThrowPlaced(const InputError& error, const Identification& study) {
  std::vector<Problem> problems = error.problems();
  for (Problem& problem : problems) {
    for (const IdentifiedParameter& parameter : study.parameters) {
      if (problem.key == parameter.name && parameter.line > 0) {
        problem.message += fmt::format(" (of {})", problem.file);
        problem.file = study.file.string();
        problem.line = parameter.line;
        problem.column = parameter.column;
        problem.key = "parameters: " + parameter.name;
      }
    }
  }
  throw InputError(problems);
}

/// Adds the default parameter steering_offset to the study (identify.h).
Identification WithSteeringOffset(Identification study) {
  constexpr std::size_t kMaxParameters = 40;
  const auto is_offset = [](const IdentifiedParameter& parameter) {
    return parameter.name == kSteeringOffset;
  };
  const auto is_prescribed = [](const Scenario& scenario) {
    return scenario.drive.steering == SteeringInput::kPrescribed;
  };
  const auto& parameters = study.parameters;
  const auto& scenarios = study.fit_scenarios;
  if (!study.steering_offset || parameters.size() >= kMaxParameters ||
      std::any_of(parameters.begin(), parameters.end(), is_offset) ||
      std::any_of(scenarios.begin(), scenarios.end(), is_prescribed) ||
      LoadCar(scenarios.front()).params().kind != VehicleKind::kSteered) {
    return study;
  }
  constexpr double kLargest = 0.1;  // Bound of the steering offset [rad].
  study.parameters.push_back({.name = kSteeringOffset, .from = -kLargest, .to = kLargest});
  return study;
}

/// Adds the bank of the study's track to the parameters of the study.
Identification WithBank(Identification study, const std::optional<BankModel>& bank) {
  if (bank) {
    for (IdentifiedParameter& parameter : bank->Parameters()) {
      study.parameters.push_back(std::move(parameter));
    }
  }
  return study;
}

/// Returns the model of the track's bank; nullopt if the study does not estimate the bank.
std::optional<BankModel> BankOf(const Identification& study) {
  return study.bank ? std::optional<BankModel>(std::in_place, study) : std::nullopt;
}

/// Returns notes on fitted records whose signals and pose come from different clocks.
std::vector<std::string> NotesOf(const std::vector<Scenario>& scenarios) {
  std::vector<std::string> notes;
  for (const Scenario& scenario : scenarios) {
    for (const std::string& note : ClockNotes(*scenario.record->data)) {
      notes.push_back(
          fmt::format("{}: {}: parameters of the car, such as a lag of the steering, "
                      "would explain this delay; set align: true in the map of the log",
                      scenario.name, note));
    }
  }
  return notes;
}

bool IsAt(double value, double bound, const IdentifiedParameter& parameter) {
  // Distance from a bound at which a value counts as equal to the bound, as a fraction of the
  // parameter's range.
  constexpr double kBoundTolerance = 1e-4;
  return std::abs(value - bound) <= kBoundTolerance * (parameter.to - parameter.from);
}

/// Returns the free parameter with the largest standard deviation, if this standard deviation is
/// larger than that of a uniform distribution between the parameter's bounds. LeastDetermined
/// returns nullopt if the records determine all parameters. If the records do not determine the
/// free parameter `first`, it returns `first`.
std::optional<std::size_t> LeastDetermined(const Eigen::MatrixXd& covariance,
                                           std::optional<std::size_t> first) {
  std::optional<std::size_t> least;
  // Standard deviation of a uniform distribution over an interval of length 1.
  double worst = 1.0 / std::sqrt(12.0);
  if (first) {
    const auto i = static_cast<Eigen::Index>(*first);
    if (!(std::sqrt(covariance(i, i)) <= worst)) {
      return first;
    }
  }
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    const double deviation = std::sqrt(covariance(i, i));
    if (!(deviation <= worst)) {
      worst = deviation;
      least = static_cast<std::size_t>(i);
    }
  }
  return least;
}

/// Returns the index of a value in a list, or nullopt if the list does not contain the value.
std::optional<std::size_t> PlaceOf(std::optional<std::size_t> value,
                                   const std::vector<std::size_t>& list) {
  const auto found = value ? std::find(list.begin(), list.end(), *value) : list.end();
  return found == list.end() ? std::nullopt
                             : std::optional(static_cast<std::size_t>(found - list.begin()));
}

double Correlation(const Eigen::MatrixXd& covariance, std::size_t a, std::size_t b) {
  const auto i = static_cast<Eigen::Index>(a);
  const auto j = static_cast<Eigen::Index>(b);
  return covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j));
}

/// Stores the car model with the estimated parameters in the result. Unless the search was
/// interrupted, ReplayRecords also replays the records, both with the start values and with the
/// estimates.
void ReplayRecords(const ResidualModel& model, const IdentificationHooks& hooks,
                   IdentificationResult& result) {
  std::vector<CarParameter> start;
  std::vector<CarParameter> fitted;
  std::vector<double> values;
  for (const ParameterEstimate& estimate : result.parameters) {
    values.push_back(estimate.value);
    if (result.study.bank && IsBankParameter(estimate.parameter.name)) {
      continue;
    }
    start.push_back({.name = estimate.parameter.name, .value = estimate.start});
    std::string origin = fmt::format("estimated by {}", result.study.name);
    if (estimate.standard_error) {
      origin += fmt::format(", standard error {:.2g}", *estimate.standard_error);
    } else if (estimate.status == ParameterStatus::kNotIdentified) {
      origin = fmt::format("not identified by {}, as before", result.study.name);
    } else {
      origin += ", at the bound of its range";
    }
    fitted.push_back(
        {.name = estimate.parameter.name, .value = estimate.value, .origin = std::move(origin)});
  }
  result.model = WithCarParameters(model.car(), fitted);
  result.bank = model.BankAt(values);
  if (result.interrupted) {
    return;
  }
  const std::shared_ptr<const Terrain> terrain = result.bank ? MakeTerrain(*result.bank) : nullptr;
  const auto replay = [&](Scenario scenario, bool held_out) {
    std::vector<double>& windows = scenario.record->windows;
    if (std::find(windows.begin(), windows.end(), result.study.horizon) == windows.end()) {
      windows.push_back(result.study.horizon);
    }
    const auto run = [&](const Scenario& replayed, const std::vector<CarParameter>& parameters) {
      const CarModel base = LoadCar(replayed);
      const CarModel car(WithCarParameters(base, parameters), base.file());
      const RunHooks run_hooks{.drive = [&](const std::string&) {
        return DriveHooks{.interrupted = hooks.interrupted};
      }};
      return SimulateRun(PlanRun(replayed, car), car, run_hooks);
    };
    const Scenario banked = terrain ? OnGround(scenario, result.bank, terrain) : scenario;
    IdentifiedRecord record{.name = scenario.name,
                            .held_out = held_out,
                            .start = run(scenario, start),
                            .fitted = run(banked, fitted)};
    result.interrupted = result.interrupted || (hooks.interrupted && hooks.interrupted());
    if (!result.interrupted) {
      result.records.push_back(std::move(record));
    }
  };
  for (const Scenario& scenario : result.study.fit_scenarios) {
    replay(scenario, false);
  }
  for (const Scenario& scenario : result.study.held_out_scenarios) {
    replay(scenario, true);
  }
}

/// Estimates the parameters of the car model. Fixes parameters that the records do not determine,
/// one after the other, until the records determine all free parameters. The parameter `added`, if
/// any, is fixed before all other undetermined parameters.
void Estimate(Estimator& estimator, const ResidualModel& model, ProgressCounter& work,
              std::optional<std::size_t> added, IdentificationResult& result) {
  const Identification& study = result.study;
  for (const std::size_t i : estimator.FixInertParameters()) {
    result.parameters[i].status = ParameterStatus::kNotIdentified;
    result.parameters[i].remark = fmt::format("it has no effect on the plant {}", study.plant);
  }
  if (estimator.free().empty()) {
    return;
  }
  std::mt19937_64 generator(study.seed);
  for (int i = 0; i < study.starts; ++i) {
    result.start_costs.push_back(
        estimator.Improve(i == 0 ? estimator.start() : estimator.Random(generator)));
    work.SkipTo((i + 1) * study.evaluations);
  }
  for (;;) {
    std::vector<std::size_t> inside;
    for (const std::size_t i : estimator.free()) {
      ParameterEstimate& estimate = result.parameters[i];
      const IdentifiedParameter& parameter = estimate.parameter;
      const double value = estimator.best()[i];
      estimate.status = IsAt(value, parameter.from, parameter) ? ParameterStatus::kAtLowerBound
                        : IsAt(value, parameter.to, parameter) ? ParameterStatus::kAtUpperBound
                                                               : ParameterStatus::kIdentified;
      if (estimate.status == ParameterStatus::kIdentified) {
        inside.push_back(i);
      }
    }
    if (inside.empty()) {
      return;
    }
    const Eigen::MatrixXd covariance = Covariance(
        study, Linearize(study, model, estimator.best(), inside, [&] { work.Count(); }), inside);
    const std::optional<std::size_t> least = LeastDetermined(covariance, PlaceOf(added, inside));
    const auto error_of = [&](std::size_t a) {
      const auto i = static_cast<Eigen::Index>(a);
      const IdentifiedParameter& parameter = study.parameters[inside[a]];
      return std::sqrt(covariance(i, i)) * (parameter.to - parameter.from);
    };
    if (!least) {
      result.correlation.assign(inside.size(), std::vector<double>(inside.size(), 1.0));
      for (std::size_t a = 0; a < inside.size(); ++a) {
        ParameterEstimate& estimate = result.parameters[inside[a]];
        estimate.standard_error = error_of(a);
        for (std::size_t b = 0; b < inside.size(); ++b) {
          if (a == b) {
            continue;
          }
          const double correlation = Correlation(covariance, a, b);
          result.correlation[a][b] = correlation;
          if (std::abs(correlation) > kStrongCorrelation) {
            estimate.remark += fmt::format(
                "{}hard to tell from {} (correlation {:.2f})", estimate.remark.empty() ? "" : "; ",
                result.parameters[inside[b]].parameter.name, correlation);
          }
        }
      }
      return;
    }
    ParameterEstimate& held = result.parameters[inside[*least]];
    held.status = ParameterStatus::kNotIdentified;
    const double error = error_of(*least);
    held.remark =
        std::isfinite(error)
            ? fmt::format("the records do not tell: standard error {:.2g}, bounds {} to {}", error,
                          held.parameter.from, held.parameter.to)
            : "the records do not tell: it changes nothing by itself, or others make up "
              "for it";
    estimator.FixParameter(inside[*least]);
    if (estimator.free().empty()) {
      return;
    }
    static_cast<void>(estimator.Improve(estimator.best()));
  }
}

}  // namespace

const char* ToString(ParameterStatus status) {
  switch (status) {
    case ParameterStatus::kIdentified:
      return "identified";
    case ParameterStatus::kAtLowerBound:
      return "at_lower_bound";
    case ParameterStatus::kAtUpperBound:
      return "at_upper_bound";
    case ParameterStatus::kNotIdentified:
      return "not_identified";
    case ParameterStatus::kUnfinished:
      return "unfinished";
  }
  throw InternalError("no such parameter status");
}

const ParameterEstimate* IdentificationResult::Find(const std::string& name) const {
  const auto found = std::find_if(parameters.begin(), parameters.end(), [&](const auto& estimate) {
    return estimate.parameter.name == name;
  });
  return found == parameters.end() ? nullptr : &*found;
}

void CheckIdentification(const Identification& asked) {
  Identification study = WithSteeringOffset(asked);
  const std::optional<BankModel> bank = BankOf(study);
  study = WithBank(std::move(study), bank);
  try {
    const ResidualModel model(study, bank ? &*bank : nullptr, 1);
    static_cast<void>(model.CarsAt(StartValues(study, model.car())));
  } catch (const InputError& error) {
    ThrowPlaced(error, study);
  }
}

IdentificationResult Identify(const Identification& asked, const IdentificationHooks& hooks) {
  TRACKBED_REQUIRE(!asked.parameters.empty() && !asked.fit_scenarios.empty(),
                   "Identify: {} parameters, {} scenarios to fit; at least one of each",
                   asked.parameters.size(), asked.fit_scenarios.size());
  const auto begun = std::chrono::steady_clock::now();
  Identification study = WithSteeringOffset(asked);
  const std::size_t count = asked.parameters.size();
  const std::optional<std::size_t> offset =
      study.parameters.size() > count ? std::optional(count) : std::nullopt;
  const std::optional<BankModel> bank = BankOf(study);
  study = WithBank(std::move(study), bank);
  IdentificationResult result{.study = study};
  const ResidualModel model(result.study, bank ? &*bank : nullptr, std::max(1, hooks.threads),
                            hooks.interrupted);
  ProgressCounter work(hooks, study.starts * study.evaluations);
  try {
    Estimator estimator(result.study, model, work);
    if (!std::isfinite(estimator.best_cost())) {
      // If the cost at the start is not finite, call CarsAt, which throws an InputError with the
      // reason.
      static_cast<void>(model.CarsAt(estimator.start()));
    }
    result.start_cost = estimator.best_cost();
    result.windows = static_cast<int>(model.windows());
    result.notes = NotesOf(study.fit_scenarios);
    for (std::size_t i = 0; i < study.parameters.size(); ++i) {
      result.parameters.push_back(
          {.parameter = study.parameters[i], .start = estimator.start()[i]});
    }
    try {
      Estimate(estimator, model, work, offset, result);
    } catch (const Interrupted&) {
      result.interrupted = true;
      for (ParameterEstimate& estimate : result.parameters) {
        if (!estimate.standard_error && estimate.status != ParameterStatus::kNotIdentified) {
          estimate.status = ParameterStatus::kUnfinished;
        }
      }
    }
    for (std::size_t i = 0; i < result.parameters.size(); ++i) {
      result.parameters[i].value = estimator.best()[i];
    }
    result.cost = estimator.best_cost();
  } catch (const InputError& error) {
    ThrowPlaced(error, study);
  } catch (const Interrupted&) {
    throw RunError("interrupted before the first evaluation of the records");
  }
  result.evaluations = work.evaluations();
  ReplayRecords(model, hooks, result);
  result.wall_time =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  return result;
}

}  // namespace trackbed
