#include "trackbed/testing/scenario_testing.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>
#include <ostream>

#include "trackbed/core/error.h"

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

class PartsAtMostMatcher {
 public:
  using is_gtest_matcher = void;

  explicit PartsAtMostMatcher(const DifferenceBounds& bounds) : bounds_(bounds) {}

  bool MatchAndExplain(const PlantComparison& comparison, std::ostream* out) const {
    const std::vector<std::string> failures = Exceeded(bounds_, comparison);
    if (out != nullptr) {
      *out << fmt::format("{}", fmt::join(failures, "; "));
    }
    return failures.empty();
  }

  void DescribeTo(std::ostream* out) const { *out << "part at most " << Bounds(); }
  void DescribeNegationTo(std::ostream* out) const { *out << "part more than " << Bounds(); }

 private:
  [[nodiscard]] std::string Bounds() const {
    std::vector<std::string> all;
    const auto add = [&](const std::optional<double>& limit, const char* unit, const char* what) {
      if (limit) {
        all.push_back(fmt::format("{} {} in {}", *limit, unit, what));
      }
    };
    add(bounds_.position_max, "m", "position");
    add(bounds_.heading_max, "rad", "heading");
    add(bounds_.yaw_rate_max, "rad/s", "yaw rate");
    add(bounds_.steering_max, "rad", "steering");
    return fmt::format("{}", fmt::join(all, ", "));
  }

  DifferenceBounds bounds_;
};

const RunLog& LogOf(const RunResult& run, const std::string& plant) {
  std::vector<std::string> driven;
  for (const RunLog& log : run.logs) {
    if (log.plant == plant) {
      return log;
    }
    driven.push_back(log.plant);
  }
  throw InputError(
      Problem{.message = fmt::format("the run {} did not drive {}; driven: {}", run.scenario.name,
                                     plant, fmt::join(driven, ", "))});
}

}  // namespace

PlantComparison Compare(const RunResult& run, const std::string& first, const std::string& second) {
  return ComparePlants(LogOf(run, first), LogOf(run, second));
}

PlantComparison Compare(const RunResult& first, const RunResult& second, const std::string& plant) {
  PlantComparison comparison = ComparePlants(LogOf(first, plant), LogOf(second, plant));
  comparison.first = first.scenario.name + "/" + plant;
  comparison.second = second.scenario.name + "/" + plant;
  return comparison;
}

void PrintTo(const PlantComparison& comparison, std::ostream* out) {
  *out << fmt::format(
      "{} and {} from {:.4g} m to {:.4g} m: position {:.4g} m, heading {:.4g} rad, yaw rate {:.4g} "
      "rad/s, steering {:.4g} rad at most",
      comparison.first, comparison.second, comparison.from_s, comparison.to_s,
      comparison.position.max, comparison.heading.max, comparison.yaw_rate.max,
      comparison.steering.max);
}

testing::Matcher<const PlantComparison&> PartsAtMost(const DifferenceBounds& bounds) {
  return PartsAtMostMatcher(bounds);
}

RunResult RunScenario(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  return RunMission(ReadScenario(file, overrides, {}, PossibleMetrics));
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
  *out << (!run.verdict.judged  ? "; its scenario expects nothing"
           : run.verdict.passed ? "; met its expectations"
                                : "; failed its expectations");
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
            if (!c.comparable()) {
              return {"they have no stretch in common"};
            }
            if (c.position.max <= limit) {
              return {};
            }
            return {fmt::format("they were {:.4g} m apart at s = {:.4g} m, t = {:.4g} s",
                                c.position.max, c.position.max_s, c.position.max_t)};
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
  return RunMatcher("meets its scenario's expectations", [](const RunResult& run) {
    return run.verdict.judged ? run.verdict.failures
                              : std::vector<std::string>{"its scenario expects nothing"};
  });
}

}  // namespace trackbed
