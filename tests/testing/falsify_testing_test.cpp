#include "trackbed/testing/falsify_testing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temp_folder.h"

namespace trackbed {
namespace {

/// Searches the winding route on the kinematic car for a cross-track error above `limit`.
FalsifyResult SearchWithin(double limit) {
  const TempFolder folder;
  return FalsifyStudy(folder.Write(
      "study.yaml",
      "schema: 1\nname: study\nscenario: " TRACKBED_SOURCE_DIR
      "/scenarios/winding.yaml\nset: {drive.plants: [kinematic], expect: {max_cross_track: " +
          std::to_string(limit) +
          "}}\nvary: {control.distance: {distribution: uniform, from: 2, to: 10}}\n"
          "nominal: {control.distance: 2.5}\nsearch: {method: direct, runs: 12}\n"));
}

TEST(IsNotFalsified, PrintsTheCounterexample) {
  const FalsifyResult broken = SearchWithin(0.3);
  testing::StringMatchResultListener listener;
  EXPECT_FALSE(testing::ExplainMatchResult(IsNotFalsified(), broken, &listener));
  EXPECT_THAT(listener.str(), testing::MatchesRegex("broken in [0-9]+ runs at control.distance = "
                                                    "[0-9.]+: kinematic: maximum cross-track "
                                                    "error .* exceeds 0.3 m .*"));
  EXPECT_EQ(testing::PrintToString(broken), listener.str());
  EXPECT_THAT(broken, testing::Not(IsNotFalsified()));
}

TEST(IsNotFalsified, MatchesASearchThatFoundNothing) {
  const FalsifyResult held = SearchWithin(50.0);
  EXPECT_THAT(held, IsNotFalsified());
  EXPECT_THAT(testing::PrintToString(held), testing::StartsWith("not falsified in "));
}

}  // namespace
}  // namespace trackbed
