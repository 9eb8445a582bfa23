#include "trackbed/testing/scenario_testing.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>
#include <ostream>

#include "trackbed/analysis/requirement_metrics.h"
#include "trackbed/analysis/verdict.h"
#include "trackbed/core/error.h"

// Defines GoogleTest matchers for scenario runs. Each matcher is a RunMatcher, which contains a
// function that returns the reasons why a run does not match. Most matchers apply the same check to
// every plant. A run without a plan or without plants never matches.
namespace trackbed {
namespace {

/// Function that returns the reasons why a run does not match; empty if the run matches.
using Failures = std::function<std::vector<std::string>(const RunResult&)>;

class RunMatcher {
 public:
  using is_gtest_matcher = void;

  RunMatcher(std::string description, Failures failures)
      : description_(std::move(description)), failures_(std::move(failures)) {}

  bool MatchAndExplain(const RunResult& run, std::ostream* out) const {
    std::vector<std::string> failures;
    if (!run.plan.ok()) {
      failures.push_back(fmt::format("no plan: {}", run.plan->reason));
    } else {
      failures = failures_(run);
    }
    if (out != nullptr) {
      for (std::size_t i = 0; i < failures.size(); ++i) {
        *out << (i == 0 ? "" : "; ") << failures[i];
      }
    }
    return failures.empty();
  }

  void DescribeTo(std::ostream* out) const { *out << description_; }
  void DescribeNegationTo(std::ostream* out) const { *out << "not: " << description_; }

 private:
  std::string description_;
  Failures failures_;
};

/// Returns a function that applies `check` to every plant of a run. The function `check` must
/// return an empty text for a plant that passes the check, otherwise a failure message.
Failures ForEveryPlant(std::function<std::string(const PlantMetrics&)> check) {
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

class DifferenceBoundsMatcher {
 public:
  using is_gtest_matcher = void;

  explicit DifferenceBoundsMatcher(const DifferenceBounds& bounds) : bounds_(bounds) {}

  bool MatchAndExplain(const PlantComparison& comparison, std::ostream* out) const {
    const std::vector<std::string> failures = Exceeded(bounds_, comparison);
    if (out != nullptr) {
      *out << fmt::format("{}", fmt::join(failures, "; "));
    }
    return failures.empty();
  }

  void DescribeTo(std::ostream* out) const { *out << "differ by at most " << Bounds(); }
  void DescribeNegationTo(std::ostream* out) const { *out << "differ by more than " << Bounds(); }

 private:
  [[nodiscard]] std::string Bounds() const {
    std::vector<std::string> all;
    for (const ComparedQuantity& quantity : ComparedQuantities()) {
      if (const std::optional<double>& limit = bounds_.*quantity.bound) {
        all.push_back(fmt::format("{} {} in {}", *limit, quantity.unit, quantity.name));
      }
    }
    return fmt::format("{}", fmt::join(all, ", "));
  }

  DifferenceBounds bounds_;
};

}  // namespace

void PrintTo(const PlantComparison& comparison, std::ostream* out) {
  *out << fmt::format(
      "{} and {} from {:.4g} m to {:.4g} m: maximum difference in position {:.4g} m, heading "
      "{:.4g} rad, yaw rate {:.4g} rad/s, steering {:.4g} rad",
      comparison.first, comparison.second, comparison.from_s, comparison.to_s,
      comparison.position.max, comparison.heading.max, comparison.yaw_rate.max,
      comparison.steering.max);
}

testing::Matcher<const PlantComparison&> DiffersByAtMost(const DifferenceBounds& bounds) {
  return DifferenceBoundsMatcher(bounds);
}

void PrintTo(const RunResult& run, std::ostream* out) {
  *out << run.scenario.name << ": ";
  if (!run.plan.ok()) {
    *out << fmt::format("no plan ({}): {}", ToString(run.plan->status), run.plan->reason);
    return;
  }
  for (const PlantMetrics& metrics : run.metrics) {
    *out << fmt::format("{}{} {} at {:.4g} s", &metrics == &run.metrics.front() ? "" : ", ",
                        metrics.plant, ToString(metrics.status), metrics.time);
  }
  *out << (!run.verdict.judged  ? "; the scenario has no expectations"
           : run.verdict.passed ? "; expectations met"
                                : "; expectations not met");
}

testing::Matcher<const RunResult&> TracksWithin(double limit) {
  return RunMatcher(fmt::format("tracks its path within {} m", limit),
                    ForEveryPlant([limit](const PlantMetrics& metrics) -> std::string {
                      if (!metrics.tracking) {
                        return "there is no path to track";
                      }
                      return DescribeFailure(
                          metrics, "cross_track.max", Relation::kAtMost, limit,
                          "cross-track error {:.4g} m at s = {:.4g} m, t = {:.4g} s");
                    }));
}

testing::Matcher<const RunResult&> StaysWithin(const std::string& first, const std::string& second,
                                               double limit) {
  return RunMatcher(
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

testing::Matcher<const RunResult&> KeepsClearance(double distance) {
  return RunMatcher(fmt::format("keeps a clearance of {} m from obstacles", distance),
                    ForEveryPlant([distance](const PlantMetrics& metrics) -> std::string {
                      if (!metrics.clearance) {
                        return "there are no obstacles";
                      }
                      return DescribeFailure(metrics, "clearance_min", Relation::kAtLeast, distance,
                                             "clearance {:.4g} m at s = {:.4g} m, t = {:.4g} s");
                    }));
}

testing::Matcher<const RunResult&> ReachesGoal(double distance) {
  return RunMatcher(fmt::format("reaches its goal within {} m", distance),
                    ForEveryPlant([distance](const PlantMetrics& metrics) -> std::string {
                      if (!metrics.tracking) {
                        return "there is no goal";
                      }
                      if (!CheckMetric(metrics, "status", Relation::kEquals, "arrived").met) {
                        return fmt::format(
                            "did not reach the goal: {}, {:.4g} m from it, t = {:.4g} s",
                            ToString(metrics.status), metrics.tracking->goal_distance,
                            metrics.time);
                      }
                      return DescribeFailure(metrics, "goal_distance", Relation::kAtMost, distance,
                                             "stopped {0:.4g} m from the goal, t = {2:.4g} s");
                    }));
}

testing::Matcher<const RunResult&> Satisfies(const std::string& formula) {
  return RunMatcher(
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

testing::Matcher<const RunResult&> MeetsItsExpectations() {
  return RunMatcher("meets its scenario's expectations", [](const RunResult& run) {
    return run.verdict.judged ? run.verdict.failures
                              : std::vector<std::string>{"the scenario has no expectations"};
  });
}

}  // namespace trackbed
