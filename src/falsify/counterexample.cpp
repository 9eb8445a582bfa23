#include "trackbed/falsify/counterexample.h"

#include <algorithm>
#include <optional>
#include <variant>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Builds expectations that every repetition of a run meets. The built expectations are those that
/// the run met, and the negations of those that the run violated.
class OutcomeExpectations {
 public:
  /// Adds an expectation that is met if and only if a repetition of the check has the same outcome.
  /// Add() returns false if no expectation can express the outcome.
  bool Add(const Check& check) {
    switch (check.reason) {
      case CheckReason::kSteeringRate:
      case CheckReason::kComparable:
      case CheckReason::kSameEnd:
        return check.met;
      case CheckReason::kNoContact:
        if (!check.met) {
          Of(check.plant).collision = true;
        }
        return true;
      case CheckReason::kCollision:
        Of(check.plant).collision = check.value == MetricValue(true);
        return std::holds_alternative<bool>(check.value);
      case CheckReason::kArrival:
        return check.met || AddEqual(check);
      case CheckReason::kCorridor:
      case CheckReason::kOverspeed:
        return check.met || AddLimit(check);
      case CheckReason::kOscillation:
        return check.met || AddOscillation(check);
      case CheckReason::kRequirement:
        return AddRequirement(check);
      case CheckReason::kExpected:
        break;
    }
    if (!check.other.empty()) {
      // A passed check between two plants needs no new expectation, because the scenario keeps the
      // section `between`. A failed check between two plants cannot be negated.
      return check.met;
    }
    return check.relation == Relation::kEquals ? AddEqual(check) : AddLimit(check);
  }

  [[nodiscard]] std::vector<std::pair<std::string, PlantExpectation>> Take() {
    return std::move(plants_);
  }

 private:
  PlantExpectation& Of(const std::string& plant) {
    for (auto& [name, expectation] : plants_) {
      if (name == plant) {
        return expectation;
      }
    }
    return plants_.emplace_back(plant, PlantExpectation{}).second;
  }

  MetricExpectation& OfMetric(const Check& check) {
    std::vector<MetricExpectation>& metrics = Of(check.plant).metrics;
    const auto found = std::find_if(
        metrics.begin(), metrics.end(),
        [&](const MetricExpectation& expectation) { return expectation.metric == check.metric; });
    return found != metrics.end()
               ? *found
               : metrics.emplace_back(
                     MetricExpectation{.metric = check.metric, .min = {}, .max = {}, .equals = {}});
  }

  bool AddEqual(const Check& check) {
    if (std::holds_alternative<std::monostate>(check.value)) {
      return false;
    }
    OfMetric(check).equals = ToText(check.value);
    return true;
  }

  bool AddLimit(const Check& check) {
    const double* bound = std::get_if<double>(&check.bound);
    const double* real = std::get_if<double>(&check.value);
    const int* whole = std::get_if<int>(&check.value);
    if (bound == nullptr || (real == nullptr && whole == nullptr)) {
      return false;
    }
    const bool is_upper = (check.relation == Relation::kAtMost) == check.met;
    if (check.metric == "cross_track.max" && is_upper) {
      Of(check.plant).max_cross_track = *bound;
      return true;
    }
    (is_upper ? OfMetric(check).max : OfMetric(check).min) = *bound;
    if (check.metric == "cross_track.max" && real != nullptr) {
      // Set the bound of the cross-track error explicitly, because otherwise the default bound of
      // one car width would apply.
      Of(check.plant).max_cross_track = 2.0 * *real;
    }
    return true;
  }

  /// Expects a steering oscillation of at least half of the found amplitude. The scenario's limit
  /// of the amplitude is 0, so it cannot be used as a lower bound.
  bool AddOscillation(const Check& check) {
    const double* amplitude = std::get_if<double>(&check.value);
    if (amplitude == nullptr) {
      return false;
    }
    OfMetric(check).min = 0.5 * *amplitude;
    return true;
  }

  bool AddRequirement(const Check& check) {
    // The metric of a requirement has the path requirements.NAME.robustness.
    const std::size_t dot = check.metric.find('.') + 1;
    Of(check.plant)
        .requirements.push_back(
            {.name = check.metric.substr(dot, check.metric.rfind('.') - dot),
             .formula = check.met ? check.formula : "not (" + check.formula + ")"});
    return check.met || std::holds_alternative<double>(check.value);
  }

  std::vector<std::pair<std::string, PlantExpectation>> plants_;
};

/// Runs the scenario and returns whether it passes. Passes() also returns false for an invalid
/// scenario; a scenario is invalid, for example, if a negated requirement is too long or nested too
/// deeply.
bool Passes(const Scenario& scenario) {
  try {
    return RunScenario(scenario).verdict.passed;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

Regression MakeRegression(const RunResult& failed, const std::string& name) {
  TRACKBED_REQUIRE(failed.verdict.judged && !failed.verdict.passed,
                   "MakeRegression: the run of {} did not fail", failed.scenario.name);
  Regression regression{.scenario = failed.scenario};
  regression.scenario.name = name;
  OutcomeExpectations expectations;
  bool all = failed.plan.ok();
  for (const Check& check : failed.verdict.checks) {
    all = expectations.Add(check) && all;
  }
  if (!all) {
    return regression;
  }
  Scenario with_expectations = regression.scenario;
  with_expectations.expect.all = {};
  with_expectations.expect.plants = expectations.Take();
  if (Passes(with_expectations)) {
    regression.scenario = std::move(with_expectations);
    regression.expects_failure = true;
  }
  return regression;
}

std::string RegressionYaml(const Regression& regression, const RunResult& failed) {
  std::string text = "# A counterexample of `trackbed falsify`. What is expected of " +
                     failed.scenario.name + " fails here:\n";
  for (std::string failure : failed.verdict.failures) {
    failure = WithoutControls(failure);
    std::replace(failure.begin(), failure.end(), '\n', ' ');
    text += "#   " + failure + "\n";
  }
  text += regression.expects_failure
              ? "# `expect` says what happened, so that this scenario passes for as long as it "
                "does, and fails\n# when it is mended: then turn the limits round.\n"
              : "# No expectation can say so: this scenario fails until it is mended.\n";
  return text + ResolvedYaml(regression.scenario);
}

}  // namespace trackbed
