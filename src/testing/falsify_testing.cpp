#include "trackbed/testing/falsify_testing.h"

#include <fmt/format.h>

#include <algorithm>
#include <ostream>
#include <thread>

#include "trackbed/analysis/metrics.h"
#include "trackbed/scenario/study_reader.h"

namespace trackbed {
namespace {

std::string DescribeSearch(const FalsifyResult& result) {
  if (!result.counterexample) {
    return fmt::format(
        "{} in {} runs{}",
        result.status == FalsifyStatus::kInterrupted ? "interrupted" : "not falsified", result.runs,
        result.errors > 0 ? fmt::format(", of which {} met an internal error", result.errors) : "");
  }
  std::string settings;
  for (const Setting& setting : result.counterexample->settings) {
    settings += fmt::format("{}{} = {}", settings.empty() ? "" : ", ", setting.key, setting.value);
  }
  return fmt::format("broken in {} runs at {}: {}", result.runs, settings,
                     result.counterexample->reason);
}

class IsNotFalsifiedMatcher {
 public:
  using is_gtest_matcher = void;

  bool MatchAndExplain(const FalsifyResult& result, std::ostream* out) const {
    const bool matches = result.status == FalsifyStatus::kNotFalsified && result.errors == 0;
    if (out != nullptr && !matches) {
      *out << DescribeSearch(result);
    }
    return matches;
  }

  void DescribeTo(std::ostream* out) const { *out << "no run of the search fails"; }
  void DescribeNegationTo(std::ostream* out) const { *out << "a run of the search fails"; }
};

}  // namespace

FalsifyResult FalsifyStudy(const std::filesystem::path& file,
                           const std::vector<Override>& overrides) {
  const auto threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  return Falsify(CheckSearch(ReadStudy(file, overrides, PossibleMetrics)), {.jobs = threads});
}

void PrintTo(const FalsifyResult& result, std::ostream* out) {
  *out << DescribeSearch(result);
}

testing::Matcher<const FalsifyResult&> IsNotFalsified() {
  return IsNotFalsifiedMatcher();
}

}  // namespace trackbed
