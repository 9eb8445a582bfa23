#include "trackbed/identify/identify.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <utility>

#include "src/identify/linear_model.h"
#include "src/identify/residuals.h"
#include "trackbed/core/error.h"
#include "trackbed/optimize/quadratic_program.h"
#include "trackbed/sim/car_parameters.h"

namespace trackbed {
namespace {

/// Ends a search; never leaves this file.
struct Interrupted {};

/// Two parameters whose estimates are correlated more than this cannot be told apart by much.
constexpr double kAlike = 0.95;

/// Counts evaluations and tells the caller how far the work is.
class Work {
 public:
  Work(const IdentificationHooks& hooks, int most) : hooks_(hooks), most_(std::max(most, 1)) {}

  /// Throws Interrupted when the caller wants no more.
  void Count() {
    ++evaluations_;
    if (hooks_.progress) {
      hooks_.progress(std::min(1.0, static_cast<double>(evaluations_) / most_));
    }
    if (hooks_.interrupted && hooks_.interrupted()) {
      throw Interrupted{};
    }
  }
  /// What was not needed of a budget is done, too.
  void SkipTo(int evaluations) { most_ -= std::max(0, evaluations - evaluations_); }
  [[nodiscard]] int evaluations() const { return evaluations_; }

 private:
  const IdentificationHooks& hooks_;
  int most_;
  int evaluations_ = 0;
};

std::vector<double> StartValues(const Identification& study, const CarModel& car) {
  std::vector<double> values;
  for (const IdentifiedParameter& parameter : study.parameters) {
    const double own = CarParameterValue(car, parameter.name);
    values.push_back(std::clamp(parameter.start.value_or(own), parameter.from, parameter.to));
  }
  return values;
}

/// The estimate on its way: all parameters, of which some are free.
class Estimator {
 public:
  Estimator(const Identification& study, const ResidualModel& model, Work& work)
      : study_(study), model_(model), work_(work), start_(StartValues(study, model.car())) {
    free_.resize(start_.size());
    std::iota(free_.begin(), free_.end(), std::size_t{0});
    best_ = start_;
    best_cost_ = Cost(start_);
  }

  [[nodiscard]] const std::vector<double>& start() const { return start_; }
  [[nodiscard]] const std::vector<double>& best() const { return best_; }
  [[nodiscard]] double best_cost() const { return best_cost_; }
  [[nodiscard]] const std::vector<std::size_t>& free() const { return free_; }

  [[nodiscard]] double Cost(const std::vector<double>& values) const {
    return CostOf(study_, model_, values);
  }

  /// Holds the parameters that leave the cost as it is, to the last bit: a plant without that part.
  /// Gives them back.
  std::vector<std::size_t> HoldInert() {
    std::vector<std::size_t> inert;
    for (const std::size_t i : free_) {
      const IdentifiedParameter& parameter = study_.parameters[i];
      constexpr double kMove = 0.1;  // of the width
      const double move = kMove * (parameter.to - parameter.from);
      std::vector<double> moved = start_;
      moved[i] = start_[i] + move <= parameter.to ? start_[i] + move : start_[i] - move;
      work_.Count();
      if (!study_.parameters[i].prior && Cost(moved) == best_cost_) {
        inert.push_back(i);
      }
    }
    for (const std::size_t i : inert) {
      std::erase(free_, i);
    }
    return inert;
  }

  /// Gauss-Newton steps within a trust region from there on; the best of all stays. Gives back the
  /// cost that it reached. Each step is a
  /// quadratic program with the bounds, which NLopt's SLSQP solves. (SLSQP on the cost itself takes
  /// six times as many evaluations: it has to learn the Hessian that the residuals give away.)
  double Improve(std::vector<double> at) {
    constexpr double kSmallest = 1e-4;   // step, of the widths
    constexpr double kLeastGain = 1e-5;  // of the cost
    const int last = work_.evaluations() + study_.evaluations;
    double radius = 0.25;  // of the widths
    double cost = Cost(at);
    Keep(at, cost);
    while (std::isfinite(cost) && work_.evaluations() < last) {
      const LinearModel linear = Linearize(study_, model_, at, free_, [this] { work_.Count(); });
      bool moved = false;
      double gained = 0.0;
      while (!moved && radius > kSmallest) {
        const Eigen::VectorXd step = Step(linear, at, radius);
        const double expected = -linear.gradient.dot(step) - 0.5 * step.dot(linear.hessian * step);
        if (!(expected > 0.0)) {
          return cost;
        }
        const std::vector<double> next = Moved(at, step);
        work_.Count();
        const double reached = Cost(next);
        const double share = (cost - reached) / expected;
        const double length = step.cwiseAbs().maxCoeff();
        if (share > 0.1) {  // false for NaN
          moved = true;
          gained = cost - reached;
          at = next;
          cost = reached;
          Keep(at, cost);
          radius = share > 0.75 ? std::max(radius, 2.0 * length) : radius;
          if (length < kSmallest) {
            return cost;
          }
        } else {
          radius = 0.3 * length;
        }
      }
      if (!moved || gained < kLeastGain * cost) {
        return cost;
      }
    }
    return cost;
  }

  /// A random point within the bounds, of the free parameters.
  std::vector<double> Random(std::mt19937_64& generator) const {
    std::vector<double> values = start_;
    for (const std::size_t i : free_) {
      const IdentifiedParameter& parameter = study_.parameters[i];
      const double share = static_cast<double>(generator() >> 11U) * 0x1p-53;
      values[i] = std::lerp(parameter.from, parameter.to, share);
    }
    return values;
  }

  /// No longer estimates a parameter.
  void Hold(std::size_t index) {
    std::erase(free_, index);
    best_[index] = start_[index];
    best_cost_ = Cost(best_);
  }

 private:
  void Keep(const std::vector<double>& values, double cost) {
    if (cost < best_cost_) {
      best_ = values;
      best_cost_ = cost;
    }
  }

  [[nodiscard]] std::vector<double> Moved(std::vector<double> values,
                                          const Eigen::VectorXd& step) const {
    for (std::size_t k = 0; k < free_.size(); ++k) {
      const IdentifiedParameter& parameter = study_.parameters[free_[k]];
      const double move = step[static_cast<Eigen::Index>(k)] * (parameter.to - parameter.from);
      values[free_[k]] = std::clamp(values[free_[k]] + move, parameter.from, parameter.to);
    }
    return values;
  }

  /// The step to the minimum of the linear model within the bounds and the trust region, over the
  /// widths.
  [[nodiscard]] Eigen::VectorXd Step(const LinearModel& linear, const std::vector<double>& at,
                                     double radius) const {
    const Eigen::Index n = linear.gradient.size();
    // A little of the identity: directions that change nothing stay where they are.
    constexpr double kLeast = 1e-9;
    const double ridge = std::max(kLeast * linear.hessian.trace(), kLeast);
    QuadraticProgram program;
    program.hessian = linear.hessian + ridge * Eigen::MatrixXd::Identity(n, n);
    program.linear = linear.gradient;
    program.constraints = QuadraticProgram::Rows::Zero(2 * n, n);
    program.bounds = QuadraticProgram::Bounds::Zero(2 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const std::size_t index = free_[static_cast<std::size_t>(i)];
      const IdentifiedParameter& parameter = study_.parameters[index];
      const double width = parameter.to - parameter.from;
      program.constraints(2 * i, i) = 1.0;
      program.bounds[2 * i] = std::min(radius, (parameter.to - at[index]) / width);
      program.constraints(2 * i + 1, i) = -1.0;
      program.bounds[2 * i + 1] = std::min(radius, (at[index] - parameter.from) / width);
    }
    return Solve(program).x;
  }

  const Identification& study_;
  const ResidualModel& model_;
  Work& work_;
  std::vector<double> start_;
  std::vector<std::size_t> free_;
  std::vector<double> best_;
  double best_cost_ = 0.0;
};

/// Places a problem of a parameter's name in the study's file.
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

bool IsAt(double value, double bound, const IdentifiedParameter& parameter) {
  constexpr double kTouches = 1e-4;  // of the width
  return std::abs(value - bound) <= kTouches * (parameter.to - parameter.from);
}

/// Which of the free parameters the records do not tell, the one that is told least first; none if
/// they tell all.
std::optional<std::size_t> LeastKnown(const Eigen::MatrixXd& covariance) {
  std::optional<std::size_t> least;
  double worst = 1.0 / std::sqrt(12.0);  // deviation of a uniform distribution over the width
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    const double deviation = std::sqrt(covariance(i, i));
    if (!(deviation <= worst)) {
      worst = deviation;
      least = static_cast<std::size_t>(i);
    }
  }
  return least;
}

double Correlation(const Eigen::MatrixXd& covariance, std::size_t a, std::size_t b) {
  const auto i = static_cast<Eigen::Index>(a);
  const auto j = static_cast<Eigen::Index>(b);
  return covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j));
}

void ReplayRecords(const ResidualModel& model, const IdentificationHooks& hooks,
                   IdentificationResult& result) {
  std::vector<CarParameter> start;
  std::vector<CarParameter> fitted;
  for (const ParameterEstimate& estimate : result.parameters) {
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
  const auto replay = [&](Scenario scenario, bool held_out) {
    std::vector<double>& windows = scenario.record->windows;
    if (std::find(windows.begin(), windows.end(), result.study.horizon) == windows.end()) {
      windows.push_back(result.study.horizon);
    }
    const CarModel base = LoadCar(scenario);
    const auto run = [&](const std::vector<CarParameter>& parameters) {
      const CarModel car(WithCarParameters(base, parameters), base.file());
      const RunHooks run_hooks{.drive = [&](const std::string&) {
        return DriveHooks{.interrupted = hooks.interrupted};
      }};
      return DriveRun(PlanRun(scenario, car), car, run_hooks);
    };
    result.records.push_back(
        {.name = scenario.name, .held_out = held_out, .start = run(start), .fitted = run(fitted)});
  };
  for (const Scenario& scenario : result.study.fit_scenarios) {
    replay(scenario, false);
  }
  for (const Scenario& scenario : result.study.held_out_scenarios) {
    replay(scenario, true);
  }
}

/// Estimates, and holds what cannot be estimated, until all that is free is told by the records.
void Estimate(Estimator& estimator, const ResidualModel& model, Work& work,
              IdentificationResult& result) {
  const Identification& study = result.study;
  for (const std::size_t i : estimator.HoldInert()) {
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
    const std::optional<std::size_t> least = LeastKnown(covariance);
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
          if (std::abs(correlation) > kAlike) {
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
    estimator.Hold(inside[*least]);
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

void CheckIdentification(const Identification& study) {
  try {
    const ResidualModel model(study, 1);
    static_cast<void>(model.CarsAt(StartValues(study, model.car())));
  } catch (const InputError& error) {
    ThrowPlaced(error, study);
  }
}

IdentificationResult Identify(const Identification& study, const IdentificationHooks& hooks) {
  TRACKBED_REQUIRE(!study.parameters.empty() && !study.fit_scenarios.empty(),
                   "Identify: {} parameters, {} scenarios to fit; at least one of each",
                   study.parameters.size(), study.fit_scenarios.size());
  const auto begun = std::chrono::steady_clock::now();
  IdentificationResult result{.study = study};
  const ResidualModel model(result.study, std::max(1, hooks.threads));
  Work work(hooks, study.starts * study.evaluations);
  try {
    Estimator estimator(result.study, model, work);
    if (!std::isfinite(estimator.best_cost())) {
      static_cast<void>(model.CarsAt(estimator.start()));  // says why
    }
    result.start_cost = estimator.best_cost();
    result.windows = static_cast<int>(model.windows());
    for (std::size_t i = 0; i < study.parameters.size(); ++i) {
      result.parameters.push_back(
          {.parameter = study.parameters[i], .start = estimator.start()[i]});
    }
    try {
      Estimate(estimator, model, work, result);
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
  }
  result.evaluations = work.evaluations();
  // A second Ctrl-C is needed to end this: what was found is to be looked at.
  ReplayRecords(model, result.interrupted ? IdentificationHooks{} : hooks, result);
  result.wall_time =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  return result;
}

}  // namespace trackbed
