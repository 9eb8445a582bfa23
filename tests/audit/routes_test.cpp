// Plans and drives many ordinary routes, and checks the plans and the reasons of refusals.
//
// Environment:
//   TRACKBED_AUDIT_ROUTES  number of routes instead of the default, for long campaigns: run the
//                          program directly then, because ctest stops a shard after minutes
//   TRACKBED_AUDIT_ROUTE   runs only the route of this index
//   TRACKBED_AUDIT_UTM     1: some of the routes lie at coordinates of 1e6 m
//   TRACKBED_AUDIT_FOLDER  an existing folder for route_<index>.yaml of each route with a finding:
//                          `trackbed plan` repeats it

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>
#include <string>

#include "tests/audit/check_route.h"
#include "tests/audit/ordinary_routes.h"
#include "tests/audit/record_run.h"
#include "tests/support/case_names.h"
#include "tests/support/environment_number.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/planning/registry/planners.h"

namespace audit {
namespace routes_test {

constexpr std::size_t kShards = 16;

RouteSettings Settings(bool driven) {
  return {.far_away = trackbed::EnvironmentNumber("TRACKBED_AUDIT_UTM").value_or(0) != 0,
          .driven = driven};
}

/// Returns the planner of a route. Planners with headings meet their waypoints.
RoutePlanner PlannerOf(const OrdinaryRoute& route) {
  const trackbed::PlannerEntry& entry = trackbed::PlannerFor(route.scenario.plan->global);
  return {entry.name, entry.has_headings, entry.bounds_waypoint_miss};
}

/// Whether docs/limits.md lists a finding ("Ordinary routes"): curves whose curvature has steps,
/// and plans that use all of the grip of ice.
bool IsListed(const Finding& finding, const RoutePlanner& planner, const Record& record) {
  if (planner.meets_waypoints) {
    return finding.kind == "not_passed" || finding.kind == "needless_stop" ||
           finding.kind == "remedy" || finding.text.find("steering rate") != std::string::npos;
  }
  const Mission& mission = record.mission;
  constexpr double kIce = 0.6;
  const bool is_icy = mission.road_friction < kIce ||
                      std::any_of(mission.patches.begin(), mission.patches.end(),
                                  [](const Patch& patch) { return patch.factor < kIce; });
  return finding.kind == "not_passed" && is_icy && record.drives.front().has_wheels;
}

/// Numbers of routes of a campaign by result.
struct RouteTally {
  std::map<std::string, std::size_t> by_planner;  ///< "dubins ok", "fillet turn_too_tight", …
  std::map<std::string, std::size_t> findings;
  double longest = 0.0;  ///< longest planning time [s]

  [[nodiscard]] std::string Text() const {
    std::string text;
    for (const auto& [what, count] : by_planner) {
      text += fmt::format("\n  {:32} {}", what, count);
    }
    text += fmt::format("\nlongest planning time {:.2f} s; findings:", longest);
    for (const auto& [what, count] : findings) {
      text += fmt::format("\n  {:32} {}", what, count);
    }
    return text;
  }
};

std::vector<Finding> AuditPlan(const OrdinaryRoute& route, trackbed::CarCache& cars,
                               Record& record) {
  const RoutePlanner planner = PlannerOf(route);
  try {
    record = RecordPlan(route.scenario, cars);
    if (record.plan_ok) {
      return CheckRoutePlan(record, planner);
    }
    return CheckRefusal(record, planner, [&](double start_speed) {
      trackbed::Scenario slower = route.scenario;
      slower.mission.start.speed = start_speed;
      return RecordPlan(slower, cars).plan_ok;
    });
  } catch (const trackbed::InputError& error) {
    return {{"rejected", error.what()}};
  } catch (const std::exception& error) {
    return {{"crash", error.what()}};
  }
}

/// Drives a route that has a plan.
std::vector<Finding> AuditDrive(const OrdinaryRoute& route, Record& record) {
  try {
    record = RecordRun(route.scenario);
  } catch (const std::exception& error) {
    return {{"crash", error.what()}};
  }
  std::vector<Finding> findings = Check(record);
  if (record.plan_ok && !record.passed) {
    findings.push_back(
        {"not_passed", record.drives.front().metrics.at("status").get<std::string>()});
  }
  return findings;
}

class Campaign {
 public:
  explicit Campaign(bool driven) : driven_(driven) {}
  Campaign(const Campaign&) = delete;
  Campaign& operator=(const Campaign&) = delete;
  ~Campaign() { std::cout << tally_.Text() << std::endl; }

  void Try(std::size_t index, const std::string& plant) {
    if (trackbed::EnvironmentNumber("TRACKBED_AUDIT_ROUTE").value_or(index) != index) {
      return;
    }
    OrdinaryRoute route = RouteOf(index, Settings(driven_));
    route.scenario.drive.plants = {plant};
    Record record;
    std::vector<Finding> findings =
        driven_ ? AuditDrive(route, record) : AuditPlan(route, cars_, record);
    const RoutePlanner planner = PlannerOf(route);
    const std::size_t found = findings.size();
    std::erase_if(findings,
                  [&](const Finding& finding) { return IsListed(finding, planner, record); });
    tally_.by_planner[planner.name + " with a listed limit"] += findings.size() < found ? 1U : 0U;
    ++tally_.by_planner[planner.name + " " + record.status];
    tally_.longest = std::max(tally_.longest, record.planning_time);
    if (findings.empty()) {
      return;
    }
    std::string text = fmt::format("route {}, {}: {}", index, planner.name, route.shape);
    for (const Finding& finding : findings) {
      ++tally_.findings[planner.name + " " + finding.kind];
      text += fmt::format("\n  [{}] {}", finding.kind, finding.text);
    }
    ADD_FAILURE() << text;
    if (const char* folder = std::getenv("TRACKBED_AUDIT_FOLDER")) {
      trackbed::WriteFileAtomically(
          std::filesystem::path(folder) / fmt::format("route_{}.yaml", index),
          trackbed::ResolvedYaml(route.scenario));
    }
  }

 private:
  bool driven_;
  trackbed::CarCache cars_;
  RouteTally tally_;
};

/// Each planner with each shape.
std::size_t Round() {
  return RoutePlanners().size() * RouteShapes();
}

TEST(OrdinaryRoute, IsPlannedOrRefusedForATrueReason) {
  Campaign campaign(false);
  for (std::size_t index = 0; index < Round(); ++index) {
    campaign.Try(index, "kinematic");
  }
}

class OrdinaryRoutes : public testing::TestWithParam<std::size_t> {
 protected:
  /// Calls `call` with each index of the shard.
  template <typename Call>
  static void ForEachIndex(std::size_t count, const Call& call) {
    const std::size_t end = (GetParam() + 1) * count / kShards;
    for (std::size_t index = GetParam() * count / kShards; index < end; ++index) {
      call(index);
    }
  }
};

INSTANTIATE_TEST_SUITE_P(Shards, OrdinaryRoutes, testing::Range<std::size_t>(0, kShards),
                         trackbed::kNamedByParameter);

TEST_P(OrdinaryRoutes, ArePlannedOrRefusedForATrueReason) {
  Campaign campaign(false);
  ForEachIndex(trackbed::EnvironmentNumber("TRACKBED_AUDIT_ROUTES").value_or(66 * Round()),
               [&](std::size_t index) { campaign.Try(index, "kinematic"); });
}

/// One of eight routes is driven in MuJoCo.
TEST_P(OrdinaryRoutes, AreDriven) {
  Campaign campaign(true);
  ForEachIndex(trackbed::EnvironmentNumber("TRACKBED_AUDIT_ROUTES").value_or(8 * Round()),
               [&](std::size_t index) {
                 campaign.Try(index, index % 8 == 0 ? "mujoco:contact" : "kinematic");
               });
}

TEST(OrdinaryRoute, IsTheSameEveryTimeAndDiffersFromOthers) {
  EXPECT_EQ(trackbed::ResolvedYaml(RouteOf(5).scenario),
            trackbed::ResolvedYaml(RouteOf(5).scenario));
  EXPECT_NE(trackbed::ResolvedYaml(RouteOf(5).scenario),
            trackbed::ResolvedYaml(RouteOf(5 + Round()).scenario));
}

}  // namespace routes_test
}  // namespace audit
