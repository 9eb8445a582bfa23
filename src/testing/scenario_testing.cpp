#include "trackbed/testing/scenario_testing.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <ostream>

#include "trackbed/analysis/run_checks.h"
#include "trackbed/analysis/verdict.h"

// Defines GoogleTest matchers for the checks of trackbed/analysis/run_checks.h.
namespace trackbed {
namespace {

class RunMatcher {
 public:
  using is_gtest_matcher = void;

  explicit RunMatcher(run_checks::RunCheck check) : check_(std::move(check)) {}

  bool MatchAndExplain(const RunResult& run, std::ostream* out) const {
    const std::vector<std::string> failures = run_checks::Failures(check_, run);
    if (out != nullptr) {
      *out << fmt::format("{}", fmt::join(failures, "; "));
    }
    return failures.empty();
  }

  void DescribeTo(std::ostream* out) const { *out << check_.description; }
  void DescribeNegationTo(std::ostream* out) const { *out << "not: " << check_.description; }

 private:
  run_checks::RunCheck check_;
};

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

  void DescribeTo(std::ostream* out) const {
    *out << "differ by at most " << run_checks::Describe(bounds_);
  }
  void DescribeNegationTo(std::ostream* out) const {
    *out << "differ by more than " << run_checks::Describe(bounds_);
  }

 private:
  DifferenceBounds bounds_;
};

}  // namespace

void PrintTo(const PlantComparison& comparison, std::ostream* out) {
  *out << run_checks::Describe(comparison);
}

testing::Matcher<const PlantComparison&> DiffersByAtMost(const DifferenceBounds& bounds) {
  return DifferenceBoundsMatcher(bounds);
}

void PrintTo(const RunResult& run, std::ostream* out) {
  *out << run_checks::Describe(run);
}

testing::Matcher<const RunResult&> TracksWithin(double limit) {
  return RunMatcher(run_checks::TracksWithin(limit));
}

testing::Matcher<const RunResult&> StaysWithin(const std::string& first, const std::string& second,
                                               double limit) {
  return RunMatcher(run_checks::StaysWithin(first, second, limit));
}

testing::Matcher<const RunResult&> KeepsClearance(double distance) {
  return RunMatcher(run_checks::KeepsClearance(distance));
}

testing::Matcher<const RunResult&> ReachesGoal(double distance) {
  return RunMatcher(run_checks::ReachesGoal(distance));
}

testing::Matcher<const RunResult&> SteersCalmly() {
  return RunMatcher(run_checks::SteersCalmly());
}

testing::Matcher<const RunResult&> Satisfies(const std::string& formula) {
  return RunMatcher(run_checks::Satisfies(formula));
}

testing::Matcher<const RunResult&> MeetsItsExpectations() {
  return RunMatcher(run_checks::MeetsItsExpectations());
}

}  // namespace trackbed
