#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/tolerance.h"
#include "trackbed/analysis/metric_registry.h"
#include "trackbed/analysis/run.h"

// Tests the metrics and expectations of trailers against the steady circle.
namespace trackbed {
namespace trailer_metrics_test {

RunResult Circle(const std::string& expect) {
  return RunScenario(
      ParseScenario(fmt::format("schema: 1\nname: circle\n"
                                "vehicle: {{trailer: {{hitch: 1.0, tongue: 3.0}}}}\n"
                                "mission: {{speed: 3, duration: 30, start: {{steering: 0.2}}}}\n"
                                "control: {{method: constant_steering, steering: 0.2}}\n"
                                "drive: {{plants: [kinematic]}}\n"
                                "expect: {}\n",
                                expect),
                    "circle.yaml", "."));
}

double Value(const RunResult& run, const std::string& path) {
  for (const Metric& metric : ListMetrics(run.metrics.front())) {
    if (metric.path == path) {
      return std::get<double>(metric.value);
    }
  }
  ADD_FAILURE() << "no metric " << path;
  return 0.0;
}

// After 90 m, 30 tongues, nothing of the start is left. With R = 2.7/tan(0.2) the trailer's axle
// runs on the radius sqrt(R^2 + b^2 - l^2). The driven line is a polygon of chords of 6 cm, which
// lie up to 0.06^2/(8 R) = 3.4e-5 m inside the circle.
TEST(TrailerMetrics, MeasureTheSteadyCircle) {
  const RunResult run = Circle("{}");
  const double radius = 2.7 / std::tan(0.2);
  const double off = radius - std::sqrt(radius * radius + 1.0 - 9.0);
  EXPECT_NEAR(Value(run, "off_tracking.max"), off, Tolerance(4e-5));
  const double angle = std::asin(3.0 / std::hypot(radius, 1.0)) + std::atan(1.0 / radius);
  EXPECT_NEAR(Value(run, "hitch_angle.max"), angle, Tolerance(1e-9));
  // The trailer starts straight, so its rate is largest at the start: -r (1 + b/l).
  EXPECT_NEAR(Value(run, "hitch_rate.max"), 3.0 / radius * (1.0 + 1.0 / 3.0), Tolerance(1e-12));
}

TEST(TrailerMetrics, AreBoundedByExpectations) {
  EXPECT_TRUE(Circle("{max_hitch_angle: 0.31}").verdict.passed);
  const RunResult failed = Circle("{max_hitch_angle: 0.2}");
  EXPECT_FALSE(failed.verdict.passed);
  EXPECT_THAT(failed.verdict.failures,
              testing::ElementsAre(testing::HasSubstr("largest hitch angle")));
}

}  // namespace trailer_metrics_test
}  // namespace trackbed
