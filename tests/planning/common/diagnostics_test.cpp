#include "trackbed/planning/common/diagnostics.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "trackbed/core/error.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed {
namespace {

using nlohmann::json;

struct Leg {
  double cost = 0.0;
  double start = 0.0;  ///< Station of the leg's start [m].
};

void Visit(DiagnosticsVisitor& out, const Leg& leg) {
  out.Number("cost_m", leg.cost);
  out.Number("start_s_m", leg.start);
}

/// The diagnostics of a user-defined planner.
struct OwnDiagnostics {
  int expansions = 0;
  std::vector<Leg> legs;
};

void Visit(DiagnosticsVisitor& out, const OwnDiagnostics& own) {
  out.Integer("expansions", own.expansions);
  out.List("legs", own.legs);
  out.Section("last", own.legs.back());
  out.Flag("optimal", true);
  out.Text("word", "LSR");
  out.Numbers("speeds_mps", {1.0, 2.5});
  out.Point("center_m", {3.0, -4.0});
  out.Points("path_m", {{0.0, 0.0}, {1.0, 2.0}});
}

void ReplaceStretch(OwnDiagnostics& own, const Stations& replaced, double shift) {
  for (Leg& leg : own.legs) {
    leg.start += leg.start >= replaced.to ? shift : 0.0;
  }
}

struct WithoutStations {
  double cost = std::numeric_limits<double>::infinity();
};

void Visit(DiagnosticsVisitor& out, const WithoutStations& own) {
  out.Number("cost_m", own.cost);
}

Plan PlanWithOwn() {
  Plan plan;
  plan.diagnostics.planner = OwnDiagnostics{.expansions = 7, .legs = {{1.0, 0.0}, {2.0, 10.0}}};
  return plan;
}

TEST(Diagnostics, OfAnyPlannerAreWrittenAsItNamesThem) {
  Plan plan = PlanWithOwn();
  plan.diagnostics.stop_distance = 12.5;
  EXPECT_EQ(DiagnosticsJson(plan), json::parse(R"({
    "expansions": 7,
    "legs": [{"cost_m": 1.0, "start_s_m": 0.0}, {"cost_m": 2.0, "start_s_m": 10.0}],
    "last": {"cost_m": 2.0, "start_s_m": 10.0},
    "optimal": true,
    "word": "LSR",
    "speeds_mps": [1.0, 2.5],
    "center_m": [3.0, -4.0],
    "path_m": [[0.0, 0.0], [1.0, 2.0]],
    "stop_distance_m": 12.5,
    "turns": []
  })"));
}

TEST(Diagnostics, KeepTheirType) {
  const Plan plan = PlanWithOwn();
  ASSERT_NE(plan.diagnostics.planner.GetIf<OwnDiagnostics>(), nullptr);
  EXPECT_EQ(plan.diagnostics.planner.Get<OwnDiagnostics>().expansions, 7);
  EXPECT_EQ(plan.diagnostics.planner.GetIf<WithoutStations>(), nullptr);
  EXPECT_THROW((void)plan.diagnostics.planner.Get<WithoutStations>(), InternalError);
  EXPECT_FALSE(Plan{}.diagnostics.planner.has_value());
}

TEST(Diagnostics, StationsMoveWithThePathWhereAPlannerSaysHow) {
  MethodDiagnostics own = PlanWithOwn().diagnostics.planner;
  ReplaceStretch(own, {4.0, 6.0}, 1.5);
  EXPECT_EQ(own.Get<OwnDiagnostics>().legs[0].start, 0.0);
  EXPECT_EQ(own.Get<OwnDiagnostics>().legs[1].start, 11.5);
  MethodDiagnostics other = WithoutStations{3.0};
  ReplaceStretch(other, {4.0, 6.0}, 1.5);
  EXPECT_EQ(other.Get<WithoutStations>().cost, 3.0);
  MethodDiagnostics none;
  ReplaceStretch(none, {4.0, 6.0}, 1.5);
  EXPECT_FALSE(none.has_value());
}

TEST(Diagnostics, WriteWhatIsNotFiniteAsNull) {
  Plan plan;
  plan.diagnostics.planner = WithoutStations{};
  EXPECT_EQ(DiagnosticsJson(plan).dump(), R"({"cost_m":null,"turns":[]})");
}

TEST(Diagnostics, OfARefusedPlanHaveNoEmptyListOfTurns) {
  Plan refused;
  refused.status = PlanStatus::kNoPath;
  EXPECT_EQ(DiagnosticsJson(refused), json::object());
}

}  // namespace
}  // namespace trackbed
