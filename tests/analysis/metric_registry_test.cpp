#include "trackbed/analysis/metric_registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "trackbed/analysis/sweep.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace metric_registry_test {

using testing::Contains;
using testing::HasSubstr;

/// Metrics with a value for everything that a run can have.
PlantMetrics All() {
  PlantMetrics metrics;
  metrics.plant = "mujoco";
  metrics.time = 8.0;
  metrics.end_s = 20.0;
  metrics.tracking.emplace().overspeed_max = 0.1;
  metrics.clearance.emplace();
  metrics.waypoint_miss.emplace();
  metrics.recovery.emplace();
  metrics.yaw_rate_ratio = 1.0;
  metrics.steering_activity = 0.1;
  metrics.oscillation.emplace();
  metrics.blocked = "waits";
  metrics.partial = "ends early";
  metrics.cause = "MuJoCo: huge value";
  metrics.turns.resize(2);
  metrics.recorded.emplace();
  metrics.windows.resize(2);
  return metrics;
}

TEST(Metrics, EveryOneHasALabelAndAPathOfItsOwn) {
  std::set<std::string> paths;
  for (const Metric& metric : ListMetrics(All())) {
    SCOPED_TRACE(metric.path);
    EXPECT_TRUE(paths.insert(metric.path).second);
    ASSERT_TRUE(DescribeMetric(metric.path).has_value());
    EXPECT_FALSE(DescribeMetric(metric.path)->label.empty());
  }
  for (const MetricEntry& entry : Metrics()) {
    EXPECT_TRUE(paths.contains(entry.path) || entry.measure) << entry.path;
  }
  EXPECT_FALSE(DescribeMetric("cros_track.max").has_value());
}

TEST(Metrics, EveryOneOfAManeuverHasALabelAndPhysicalUnit) {
  for (const ManeuverEntry& maneuver : Maneuvers()) {
    ManeuverMetrics metrics = AllMetrics(maneuver.defaults);
    for (const Metric& metric : ListMetrics(metrics)) {
      SCOPED_TRACE(std::string(maneuver.name) + " " + metric.path);
      EXPECT_TRUE(DescribeManeuverMetric(metric.path).has_value());
    }
  }
  EXPECT_EQ(DescribeMetric("maneuver.understeer_gradient")->unit, "rad s^2/m");
  EXPECT_EQ(DescribeMetric("maneuver.distance")->label, "Maneuver: braking distance");
  EXPECT_EQ(DescribeMetric("turns[1].lateral_offset")->label, "Turn 2: lateral offset");
}

TEST(Metrics, EveryOneOfAComparisonHasALabel) {
  for (const Metric& metric : ListMetrics(PlantComparison{})) {
    EXPECT_TRUE(DescribeComparisonMetric(metric.path).has_value()) << metric.path;
  }
  EXPECT_EQ(DescribeComparisonMetric("yaw_rate.max")->unit, "rad/s");
}

TEST(Metrics, StandInTheFileByTheirPath) {
  PlantMetrics metrics = All();
  metrics.tracking->cross_track_max = 0.5;
  metrics.turns[1].waypoint = 3;
  const nlohmann::ordered_json json = ToJson(metrics);
  EXPECT_EQ(json["cross_track"]["max"], 0.5);
  EXPECT_EQ(json["turns"][1]["waypoint"], 3);
  EXPECT_TRUE(json["recovery_time"].is_null());
  EXPECT_EQ(json.begin().key(), "status");
}

/// The metric is half of the distance driven, and its station is half of that distance.
std::optional<MetricReading> HalfWay(const MetricInput& input) {
  return MetricReading{0.5 * input.log.rows.back().state.distance,
                       {.span = MetricSpan::kMoment, .s = 1.5, .t = 0.5}};
}

std::string Refused(MetricEntry entry) {
  const std::size_t before = Metrics().size();
  try {
    RegisterMetric(std::move(entry));
  } catch (const InputError& error) {
    EXPECT_EQ(Metrics().size(), before);
    return error.what();
  }
  return "accepted";
}

TEST(RegisterMetric, RefusesWhatIsTakenOrMalformed) {
  EXPECT_EQ(Refused({.path = "cross_track.max", .label = "A", .measure = HalfWay}),
            "metric 'cross_track.max': metrics.json already has 'cross_track.max'; choose another "
            "name");
  EXPECT_EQ(Refused({.path = "cross_track", .label = "A", .measure = HalfWay}),
            "metric 'cross_track': 'cross_track' is a section of metrics.json, with "
            "'cross_track.rms'; choose another name");
  EXPECT_EQ(Refused({.path = "status.text", .label = "A", .measure = HalfWay}),
            "metric 'status.text': 'status' is a value in metrics.json, so no name may begin with "
            "'status.'");
  for (const char* taken : {"clearance_min_s", "turns", "maneuver.x"}) {
    EXPECT_THAT(Refused({.path = taken, .label = "A", .measure = HalfWay}),
                HasSubstr("metrics.json"))
        << taken;
  }
  // A metric with a station is refused for the same reason.
  EXPECT_THAT(
      Refused({.path = "cross_track.max", .label = "A", .measure = HalfWay, .located = true}),
      HasSubstr("already has"));
  for (const char* malformed : {"", "Max", "a..b", "a.", "1a", "a[0]", "a b"}) {
    EXPECT_THAT(Refused({.path = malformed, .label = "A", .measure = HalfWay}),
                HasSubstr("must be words of a-z"))
        << malformed;
  }
  EXPECT_THAT(Refused({.path = "own", .measure = HalfWay}), HasSubstr("the label is missing"));
  EXPECT_THAT(Refused({.path = "own", .label = "A"}),
              HasSubstr("exactly one of `measure` and `read`"));
}

TEST(RegisterMetric, MakesAMetricLikeAnyOther) {
  RegisterMetric({.path = "test_half_way",
                  .label = "Half way",
                  .unit = "m",
                  .measure = HalfWay,
                  .located = true});
  const std::string yaml =
      "schema: 1\nname: own\nmission: {speed: 3, duration: 1}\n"
      "control: {method: constant_steering, steering: 0}\ndrive: {plants: [kinematic]}\n"
      "expect: {metrics: [{metric: test_half_way, max: 1}]}\n";
  const Scenario scenario = ParseScenario(yaml, "own.yaml", ".");
  EXPECT_THAT(PossibleMetrics(scenario), Contains("test_half_way_s"));
  EXPECT_THAT(PossibleOutputs(scenario), Contains("metrics.*.test_half_way"));
  const RunResult run = RunScenario(scenario);
  // The car drives 3 m, for 1 s at 3 m/s.
  EXPECT_EQ(run.verdict.failures,
            std::vector<std::string>{
                "kinematic: test_half_way 1.5 m exceeds 1 m at s = 1.5 m, t = 0.5 s"});
  const nlohmann::ordered_json plant = MetricsJson(run)["plants"]["kinematic"];
  EXPECT_EQ(plant["test_half_way_t"], 0.5);
  EXPECT_EQ(CollectOutputs(run).at("metrics.kinematic.test_half_way_s"), "1.5");
  EXPECT_EQ(DescribeMetric("test_half_way")->label, "Half way");
  EXPECT_THAT(Refused({.path = "test_half_way", .label = "A", .measure = HalfWay}),
              HasSubstr("already has 'test_half_way'"));
}

}  // namespace metric_registry_test
}  // namespace trackbed
