#include "trackbed/analysis/run_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

#include "trackbed/analysis/requirement_metrics.h"
#include "trackbed/analysis/verdict.h"
#include "trackbed/core/error.h"

// Most run checks apply one check to every plant. A run without plants never passes.
namespace trackbed::run_checks {
namespace {

RunCheck MakeCheck(std::string description,
                   std::function<std::vector<std::string>(const RunResult&)> failures) {
  return {std::move(description), std::move(failures)};
}

/// Returns a function that applies `check` to every plant of a run. The function `check` must
/// return an empty text for a plant that passes the check, otherwise a failure message.
std::function<std::vector<std::string>(const RunResult&)> ForEveryPlant(
    std::function<std::string(const PlantMetrics&)> check) {
  return [check = std::move(check)](const RunResult& run) {
    std::vector<std::string> failures;
    for (const PlantMetrics& metrics : run.metrics) {
      if (std::string failure = check(metrics); !failure.empty()) {
        failures.push_back(metrics.plant + ": " + failure);
      }
    }
    if (run.metrics.empty()) {
      failures.emplace_back("no plant was run");
    }
    return failures;
  };
}

/// Describes how a metric of a plant violates its bound; returns an empty text if the bound is met.
/// The value, the station and the time of the metric are inserted into the format string `format`.
std::string DescribeFailure(const PlantMetrics& plant, const char* metric, Relation relation,
                            double bound, const char* format) {
  const Check check = CheckMetric(plant, metric, relation, bound);
  return check.met ? ""
                   : fmt::format(fmt::runtime(format), std::get<double>(check.value), check.at.s,
                                 check.at.t);
}

}  // namespace

std::vector<std::string> Failures(const RunCheck& check, const RunResult& run) {
  if (!run.plan.ok()) {
    return {fmt::format("no plan: {}", run.plan->reason)};
  }
  return check.failures(run);
}

std::string Describe(const DifferenceBounds& bounds) {
  std::vector<std::string> all;
  for (const ComparedQuantity& quantity : ComparedQuantities()) {
    if (const std::optional<double>& limit = bounds.*quantity.bound) {
      all.push_back(fmt::format("{} {} in {}", *limit, quantity.unit, quantity.name));
    }
  }
  return fmt::format("{}", fmt::join(all, ", "));
}

std::string Describe(const PlantComparison& comparison) {
  return fmt::format(
      "{} and {} from {:.4g} m to {:.4g} m: maximum difference in position {:.4g} m, heading "
      "{:.4g} rad, yaw rate {:.4g} rad/s, steering {:.4g} rad",
      comparison.first, comparison.second, comparison.from_s, comparison.to_s,
      comparison.position.max, comparison.heading.max, comparison.yaw_rate.max,
      comparison.steering.max);
}

std::string Describe(const RunResult& run) {
  std::string text = run.scenario.name + ": ";
  if (!run.plan.ok()) {
    return text + fmt::format("no plan ({}): {}", ToString(run.plan->status), run.plan->reason);
  }
  for (const PlantMetrics& metrics : run.metrics) {
    text += fmt::format("{}{} {} at {:.4g} s", &metrics == &run.metrics.front() ? "" : ", ",
                        metrics.plant, ToString(metrics.status), metrics.time);
  }
  return text + (!run.verdict.judged  ? "; the scenario has no expectations"
                 : run.verdict.passed ? "; expectations met"
                                      : "; expectations not met");
}

RunCheck TracksWithin(double limit) {
  return MakeCheck(fmt::format("tracks its path within {} m", limit),
                   ForEveryPlant([limit](const PlantMetrics& metrics) -> std::string {
                     if (!metrics.tracking) {
                       return "there is no path to track";
                     }
                     return DescribeFailure(
                         metrics, "cross_track.max", Relation::kAtMost, limit,
                         "cross-track error {:.4g} m at s = {:.4g} m, t = {:.4g} s");
                   }));
}

RunCheck StaysWithin(const std::string& first, const std::string& second, double limit) {
  return MakeCheck(
      fmt::format("keeps {} and {} within {} m of each other", first, second, limit),
      [=](const RunResult& run) -> std::vector<std::string> {
        for (const PlantComparison& c : run.comparisons) {
          if ((c.first == first && c.second == second) ||
              (c.first == second && c.second == first)) {
            const Check check = CheckBounds({.position_max = limit}, c).front();
            return check.met ? std::vector<std::string>{}
                   : check.reason == CheckReason::kComparable
                       ? std::vector{check.detail}
                       : std::vector{fmt::format(
                             "position difference {:.4g} m at s = {:.4g} m, t = {:.4g} s",
                             std::get<double>(check.value), check.at.s, check.at.t)};
          }
        }
        return {fmt::format("the run does not have both {} and {}", first, second)};
      });
}

RunCheck KeepsClearance(double distance) {
  return MakeCheck(fmt::format("keeps a clearance of {} m from obstacles", distance),
                   ForEveryPlant([distance](const PlantMetrics& metrics) -> std::string {
                     if (!metrics.clearance) {
                       return "there are no obstacles";
                     }
                     return DescribeFailure(metrics, "clearance_min", Relation::kAtLeast, distance,
                                            "clearance {:.4g} m at s = {:.4g} m, t = {:.4g} s");
                   }));
}

RunCheck ReachesGoal(double distance) {
  return MakeCheck(fmt::format("reaches its goal within {} m", distance),
                   ForEveryPlant([distance](const PlantMetrics& metrics) -> std::string {
                     if (!metrics.tracking) {
                       return "there is no goal";
                     }
                     if (!CheckMetric(metrics, "status", Relation::kEquals, "arrived").met) {
                       return fmt::format(
                           "did not reach the goal: {}, {:.4g} m from it, t = {:.4g} s",
                           ToString(metrics.status), metrics.tracking->goal_distance, metrics.time);
                     }
                     return DescribeFailure(metrics, "goal_distance", Relation::kAtMost, distance,
                                            "stopped {0:.4g} m from the goal, t = {2:.4g} s");
                   }));
}

RunCheck SteersCalmly() {
  return MakeCheck("steers calmly", ForEveryPlant([](const PlantMetrics& metrics) -> std::string {
                     if (!metrics.oscillation) {
                       return "there is no path to steer along";
                     }
                     const OscillationMetrics& found = *metrics.oscillation;
                     return found.frequency
                                ? fmt::format(
                                      "steering oscillates by {:.4g} rad to each side at {:.4g} Hz "
                                      "between t = {:.4g} s and {:.4g} s",
                                      found.amplitude, *found.frequency, found.from_t, found.to_t)
                                : "";
                   }));
}

RunCheck Satisfies(const std::string& formula) {
  return MakeCheck(
      fmt::format("satisfies {}", formula),
      [formula](const RunResult& run) -> std::vector<std::string> {
        std::vector<std::string> failures;
        for (const RunLog& log : run.logs) {
          const Check check = CheckRequirement(
              log.plant, MeasureRequirement({.name = formula, .formula = formula}, log));
          if (!check.met) {
            failures.push_back(FailureMessage(check));
          }
        }
        return run.logs.empty() ? std::vector<std::string>{"no plant was run"} : failures;
      });
}

RunCheck MeetsItsExpectations() {
  return MakeCheck("meets its scenario's expectations", [](const RunResult& run) {
    return run.verdict.judged ? run.verdict.failures
                              : std::vector<std::string>{"the scenario has no expectations"};
  });
}

}  // namespace trackbed::run_checks
