// Checks the verdicts of many random runs against the recorded results of the runs.
//
// Environment:
//   TRACKBED_AUDIT_SCENARIOS  number of scenarios instead of the default, for long campaigns: run
//                             the program directly then, because ctest stops a shard after minutes
//   TRACKBED_AUDIT_INDEX      runs only this scenario
//   TRACKBED_AUDIT_FOLDER     an existing folder for <index>.yaml of each scenario with a finding:
//                             `trackbed run` repeats it

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>
#include <string>

#include "tests/audit/checker.h"
#include "tests/audit/random_scenarios.h"
#include "tests/audit/record_run.h"
#include "tests/support/case_names.h"
#include "tests/support/environment_number.h"
#include "tests/support/waypoint_planners.h"
#include "trackbed/control/controllers.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/planning/registry/planners.h"

namespace audit {
namespace {

/// Every planner with every controller on every plant, twice: 8 planners and 8 controllers.
constexpr std::size_t kDefaultScenarios = 768;
constexpr std::size_t kShards = 16;
constexpr int kMaxAttempts = 50;

/// Findings over a range of scenarios.
struct Tally {
  std::size_t scenarios = 0;
  std::size_t planned = 0;
  std::size_t arrived = 0;
  std::size_t passed = 0;
  std::map<std::string, std::size_t> scenarios_with;  ///< with a finding of that kind

  [[nodiscard]] std::string Text() const {
    std::string text =
        fmt::format("{} scenarios, {} planned, {} arrived, {} passed; findings:", scenarios,
                    planned, arrived, passed);
    for (const auto& [kind, count] : scenarios_with) {
      text += fmt::format("\n  {:22} {}", kind, count);
    }
    return text;
  }
};

struct Outcome {
  trackbed::Scenario scenario;
  Record record;
  std::vector<Finding> findings;
};

/// The first attempt that the program does not reject as invalid input.
Outcome AuditCase(std::size_t index) {
  Outcome outcome;
  for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
    outcome.scenario = RandomScenario(index, attempt);
    try {
      outcome.record = RecordRun(outcome.scenario);
      outcome.findings = Check(outcome.record);
      return outcome;
    } catch (const trackbed::InputError&) {
      continue;
    } catch (const std::exception& error) {
      outcome.findings = {{"crash", error.what()}};
      return outcome;
    }
  }
  outcome.findings = {{"generator", "every attempt was refused"}};
  return outcome;
}

std::string Describe(std::size_t index, const Outcome& outcome) {
  const trackbed::Scenario& scenario = outcome.scenario;
  std::string text = fmt::format(
      "scenario {}: {}{}{}, {}, {}, {}", index, trackbed::PlannerFor(scenario.plan->global).name,
      scenario.plan->avoid ? " + avoid" : "", scenario.plan->replan ? " + replan" : "",
      trackbed::ControllerFor(scenario.control.steering).name, scenario.drive.plants.front(),
      std::filesystem::path(scenario.vehicle.model).stem().string());
  for (const Finding& finding : outcome.findings) {
    text += fmt::format("\n  [{}] {}", finding.kind, finding.text);
  }
  return text;
}

class EveryVerdict : public testing::TestWithParam<std::size_t> {
 protected:
  static void TearDownTestSuite() { std::cout << "In all: " << total_.Text() << std::endl; }

  static void Count(const Outcome& outcome, Tally& tally) {
    ++tally.scenarios;
    tally.planned += outcome.record.plan_ok ? 1U : 0U;
    tally.passed += outcome.record.passed ? 1U : 0U;
    for (const Drive& drive : outcome.record.drives) {
      tally.arrived += drive.metrics.at("status") == "arrived" ? 1U : 0U;
    }
    std::map<std::string, std::size_t> kinds;
    for (const Finding& finding : outcome.findings) {
      kinds[finding.kind] = 1;
    }
    for (const auto& [kind, one] : kinds) {
      tally.scenarios_with[kind] += one;
    }
  }

  static Tally total_;
};

Tally EveryVerdict::total_;

INSTANTIATE_TEST_SUITE_P(Shards, EveryVerdict, testing::Range<std::size_t>(0, kShards),
                         trackbed::kNamedByParameter);

TEST_P(EveryVerdict, IsTrue) {
  const auto only = trackbed::EnvironmentNumber("TRACKBED_AUDIT_INDEX");
  const std::size_t count =
      trackbed::EnvironmentNumber("TRACKBED_AUDIT_SCENARIOS").value_or(kDefaultScenarios);
  const char* folder = std::getenv("TRACKBED_AUDIT_FOLDER");
  Tally tally;
  // Each shard takes a contiguous range of indices. Planners alternate by index, so a shard with a
  // stride of 16 would see only one planner.
  const std::size_t end = (GetParam() + 1) * count / kShards;
  for (std::size_t index = GetParam() * count / kShards; index < end; ++index) {
    if (only && index != *only) {
      continue;
    }
    const Outcome outcome = AuditCase(index);
    Count(outcome, tally);
    Count(outcome, total_);
    if (!outcome.findings.empty()) {
      ADD_FAILURE() << Describe(index, outcome);
      if (folder != nullptr) {
        trackbed::WriteFileAtomically(std::filesystem::path(folder) / fmt::format("{}.yaml", index),
                                      trackbed::ResolvedYaml(outcome.scenario));
      }
    }
  }
  std::cout << tally.Text() << std::endl;
  // Agreement means little if the program rejects nearly all scenarios.
  if (!only && tally.scenarios >= 30) {
    EXPECT_GE(tally.planned, tally.scenarios / 4);
    EXPECT_GE(tally.passed, tally.scenarios / 12);
  }
}

TEST(RandomScenarios, AreTheSameEveryTimeAndDifferFromEachOther) {
  EXPECT_EQ(trackbed::ResolvedYaml(RandomScenario(5, 0)),
            trackbed::ResolvedYaml(RandomScenario(5, 0)));
  EXPECT_NE(trackbed::ResolvedYaml(RandomScenario(5, 0)),
            trackbed::ResolvedYaml(RandomScenario(5, 1)));
}

TEST(RandomScenarios, HaveEveryPlannerWithEveryControllerOnEveryPlant) {
  ASSERT_LE(Combinations(), kDefaultScenarios);
  std::map<std::string, int> seen;
  for (std::size_t index = 0; index < Combinations(); ++index) {
    const trackbed::Scenario scenario = RandomScenario(index, 0);
    ++seen[fmt::format("{} {} {}", trackbed::PlannerFor(scenario.plan->global).name,
                       trackbed::ControllerFor(scenario.control.steering).name,
                       scenario.drive.plants.front())];
  }
  std::size_t followers = 0;
  for (const trackbed::ControllerEntry& entry : trackbed::Controllers()) {
    followers += entry.needs_plan ? 1U : 0U;
  }
  constexpr std::size_t kPlants = 4;  // two of them twice as often
  EXPECT_EQ(seen.size(), trackbed::WaypointPlanners().size() * followers * kPlants);
}

}  // namespace
}  // namespace audit
