#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include "trackbed/analysis/run.h"

namespace trackbed {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

RunResult Drive(const std::string& name, std::vector<std::string> settings) {
  settings.emplace_back("drive.plants=[kinematic]");
  return RunScenario(ReadScenario(
      std::filesystem::path(TRACKBED_SOURCE_DIR) / "scenarios" / (name + ".yaml"), settings));
}

/// Returns the proposed settings of keys, such as "plan.safe_distance=0.8".
std::vector<std::string> Proposed(const RunResult& run) {
  static const std::regex kSet("(plan[a-z_.]*safe_distance): ([0-9.]+) \\(now");
  std::vector<std::string> settings;
  for (const std::string& note : run.verdict.notes) {
    for (std::sregex_iterator it(note.begin(), note.end(), kSet), end; it != end; ++it) {
      settings.push_back(it->str(1) + "=" + it->str(2));
    }
  }
  return settings;
}

void ExpectRemedy(const std::string& name, const std::string& bound, std::size_t keys) {
  const RunResult near = Drive(name, {"expect.min_clearance=" + bound});
  ASSERT_THAT(near.verdict.failures, Contains(HasSubstr("clearance"))) << name;
  std::vector<std::string> settings = Proposed(near);
  EXPECT_THAT(settings, SizeIs(keys)) << name;
  settings.push_back("expect.min_clearance=" + bound);
  const RunResult far = Drive(name, settings);
  EXPECT_THAT(far.verdict.failures, IsEmpty()) << name;
  EXPECT_THAT(Proposed(far), IsEmpty()) << name;
}

TEST(ClearanceRemedy, LetsTheCarKeepTheDemandedClearance) {
  ExpectRemedy("parking_lot", "0.8", 1);
}

TEST(ClearanceRemedy, NamesTheDistancesOfReplanningAndItsDetours) {
  ExpectRemedy("blocked_road", "1.2", 2);
}

// The obstacle is avoided by a curve around it, which keeps 1.5 m by default.
TEST(ClearanceRemedy, NamesTheDistanceOfAvoidance) {
  ExpectRemedy("obstacle_appears", "1.7", 1);
}

TEST(ClearanceRemedy, IsNotProposedWithoutASafeDistance) {
  // `fillet` has no safe distance.
  const RunResult near = Drive("obstacle_course", {"expect.min_clearance=1.5"});
  ASSERT_THAT(near.verdict.failures, Contains(HasSubstr("clearance")));
  EXPECT_THAT(Proposed(near), IsEmpty());
}

}  // namespace
}  // namespace trackbed
