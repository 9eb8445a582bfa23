#include "trackbed/testing/scenario_testing.h"

#include <fmt/format.h>

#include <functional>
#include <ostream>

namespace trackbed {
namespace {

/// What keeps a run from matching, one line each; none when it matches.
using Check = std::function<std::vector<std::string>(const RunResult&)>;

class RunMatcher {
 public:
  using is_gtest_matcher = void;

  RunMatcher(std::string description, Check check)
      : description_(std::move(description)), check_(std::move(check)) {}

  bool MatchAndExplain(const RunResult& run, std::ostream* out) const {
    std::vector<std::string> failures;
    if (!run.plan.ok()) {
      failures.push_back(fmt::format("there is no plan: {}", run.plan.reason));
    } else {
      failures = check_(run);
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
  Check check_;
};

/// The failures of a check that every plant must pass; `check` returns an empty text when it does.
Check ForEveryPlant(std::function<std::string(const PlantMetrics&)> check) {
  return [check = std::move(check)](const RunResult& run) {
    std::vector<std::string> failures;
    for (const PlantMetrics& metrics : run.metrics) {
      if (std::string failure = check(metrics); !failure.empty()) {
        failures.push_back(metrics.plant + " " + failure);
      }
    }
    if (run.metrics.empty()) {
      failures.emplace_back("no plant was driven");
    }
    return failures;
  };
}

}  // namespace

RunResult RunScenario(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  return RunMission(ReadScenario(file, overrides));
}

RunResult RunScenario(const Scenario& scenario) {
  return RunMission(scenario);
}

void PrintTo(const RunResult& run, std::ostream* out) {
  *out << run.scenario.name << ": ";
  if (!run.plan.ok()) {
    *out << fmt::format("no plan ({}): {}", ToString(run.plan.status), run.plan.reason);
    return;
  }
  for (const PlantMetrics& metrics : run.metrics) {
    *out << fmt::format("{}{} {} at {:.4g} s", &metrics == &run.metrics.front() ? "" : ", ",
                        metrics.plant, ToString(metrics.status), metrics.time);
  }
  *out << (run.verdict.passed ? "; met its expectations" : "; failed its expectations");
}

testing::Matcher<const RunResult&> TracksWithin(double limit) {
  return RunMatcher(fmt::format("tracks its path within {} m", limit),
                    ForEveryPlant([limit](const PlantMetrics& metrics) -> std::string {
                      if (!metrics.tracking) {
                        return "has no path to track";
                      }
                      const TrackingMetrics& tracking = *metrics.tracking;
                      return tracking.cross_track_max <= limit
                                 ? ""
                                 : fmt::format("was {:.4g} m off at s = {:.4g} m, t = {:.4g} s",
                                               tracking.cross_track_max, tracking.cross_track_max_s,
                                               tracking.cross_track_max_t);
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
            if (c.position_max <= limit) {
              return {};
            }
            return {fmt::format("they were {:.4g} m apart at s = {:.4g} m, t = {:.4g} s",
                                c.position_max, c.position_max_s, c.position_max_t)};
          }
        }
        return {fmt::format("the run did not drive both {} and {}", first, second)};
      });
}

testing::Matcher<const RunResult&> KeepsClearOf(double distance) {
  return RunMatcher(fmt::format("keeps {} m clear of obstacles", distance),
                    ForEveryPlant([distance](const PlantMetrics& metrics) -> std::string {
                      if (!metrics.clearance) {
                        return "has no obstacles to keep clear of";
                      }
                      const ClearanceMetrics& clearance = *metrics.clearance;
                      return clearance.min >= distance
                                 ? ""
                                 : fmt::format("was {:.4g} m away at s = {:.4g} m, t = {:.4g} s",
                                               clearance.min, clearance.min_s, clearance.min_t);
                    }));
}

testing::Matcher<const RunResult&> ReachesGoal(double distance) {
  return RunMatcher(fmt::format("reaches its goal within {} m", distance),
                    ForEveryPlant([distance](const PlantMetrics& metrics) -> std::string {
                      if (!metrics.tracking) {
                        return "has no goal";
                      }
                      if (metrics.status != DriveStatus::kArrived) {
                        return fmt::format("ended as {} {:.4g} m from it, t = {:.4g} s",
                                           ToString(metrics.status),
                                           metrics.tracking->goal_distance, metrics.time);
                      }
                      return metrics.tracking->goal_distance <= distance
                                 ? ""
                                 : fmt::format("stopped {:.4g} m from it, t = {:.4g} s",
                                               metrics.tracking->goal_distance, metrics.time);
                    }));
}

testing::Matcher<const RunResult&> MeetsItsExpectations() {
  return RunMatcher("meets its scenario's expectations",
                    [](const RunResult& run) { return run.verdict.failures; });
}

}  // namespace trackbed
