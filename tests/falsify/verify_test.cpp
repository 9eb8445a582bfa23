#include "trackbed/falsify/verify.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <nlohmann/json.hpp>

#include "tests/support/temp_folder.h"
#include "trackbed/analysis/metrics.h"
#include "trackbed/core/error.h"
#include "trackbed/scenario/study_points.h"
#include "trackbed/scenario/study_reader.h"

namespace trackbed {
namespace {

/// Two of three runs of the kinematic car pass: those slower than 7/3 m/s.
CheckedStudy MakeSample(const TempFolder& folder) {
  return CheckStudy(ReadStudy(
      folder.Write("study.yaml",
                   "schema: 1\nname: study\nscenario: " TRACKBED_SOURCE_DIR
                   "/scenarios/winding.yaml\n"
                   "set: {drive.plants: [kinematic], drive.time_limit: 3, expect: {metrics: [\n"
                   "  {metric: status, equals: time_limit}, {metric: distance, max: 7}]}}\n"
                   "vary: {mission.speed: {distribution: uniform, from: 1, to: 3}}\n"
                   "sample: {count: 400, method: random, seed: 3}\n"),
      {}, PossibleMetrics));
}

TEST(Verify, GivesTheSameForAnyNumberOfJobsAndAfterAnInterruption) {
  const TempFolder folder;
  const CheckedStudy checked = MakeSample(folder);
  const nlohmann::ordered_json header = SweepHeader(checked.points, checked.inputs);
  for (const double probability : {0.4, 0.9}) {
    const VerifyClaim claim{.probability = probability, .confidence = 0.95};
    SweepRecords one = SweepRecords::InMemory(header);
    const VerifyResult expected = Verify(checked, claim, one);
    EXPECT_EQ(expected.verdict,
              probability < 0.6 ? ProbabilityVerdict::kAtLeast : ProbabilityVerdict::kBelow);
    EXPECT_LT(expected.runs, 200U);
    SweepRecords parts = SweepRecords::InMemory(header);
    for (int interruptions = 0;; ++interruptions) {
      ASSERT_LT(interruptions, 100);
      std::atomic<int> left{11};
      const VerifyResult result = Verify(checked, claim, parts,
                                         {.jobs = 3,
                                          .interrupted = [&] { return left <= 0; },
                                          .progress = [&](double) { --left; }});
      if (!result.interrupted) {
        EXPECT_EQ(ToJson(result, claim), ToJson(expected, claim));
        break;
      }
    }
  }
}

TEST(Verify, NeedsIndependentRunsOfOneDistribution) {
  const TempFolder folder;
  const Study study = MakeSample(folder).points.study();
  const auto problem = [&](const std::function<void(Study&)>& change) -> std::string {
    Study changed = study;
    change(changed);
    try {
      CheckVerifiable(StudyPoints(changed));
    } catch (const InputError& error) {
      return error.problems().front().WithoutPlace();
    }
    return "";
  };
  EXPECT_EQ(problem([](Study&) {}), "");
  EXPECT_THAT(problem([](Study& s) { s.sample->method = SampleMethod::kSobol; }),
              testing::StartsWith("sample.method: must be random"));
  EXPECT_THAT(problem([](Study& s) { s.repeat = 2; }), testing::StartsWith("repeat: "));
  EXPECT_THAT(
      problem([](Study& s) {
        s.vary.push_back({.key = "control.distance",
                          .alternatives = {{"control.distance", "2"}, {"control.distance", "3"}}});
      }),
      testing::StartsWith("vary: has lists of values"));
}

}  // namespace
}  // namespace trackbed
