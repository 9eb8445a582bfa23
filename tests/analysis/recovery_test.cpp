#include "trackbed/analysis/recovery.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/tolerance.h"
#include "trackbed/analysis/metrics.h"
#include "trackbed/core/angle.h"

namespace trackbed {
namespace {

/// Recovery metrics of a car whose cross-track error over 10 s is `offset(time)`.
template <typename Offset>
std::optional<RecoveryMetrics> Recovery(const Disturbances& disturb, const Offset& offset,
                                        const Wind& wind = {}) {
  RunLog log{.plant = "made_up", .configurations = Table({"t_s"})};
  for (int i = 0; i <= 500; ++i) {
    LogRow row;
    row.state.time = i / 50.0;
    row.tracking = Projection{};
    row.tracking->cross_track = offset(row.state.time);
    log.rows.push_back(row);
  }
  return MeasureRecovery(log, disturb, wind);
}

TEST(RecoveryTime, IsTheTimeUntilTheCarStaysNearItsPath) {
  Disturbances disturb;
  disturb.kicks.push_back({.at = 2.0, .displacement = 0.5});
  const auto swings_back = [](double t) {
    return t <= 2.0 ? 0.0 : -0.5 * std::exp(2.0 - t) * std::cos(kPi * (t - 2.0));
  };
  // The swings have amplitudes 0.5 e^-1 and 0.5 e^-2 at 1 s and 2 s, and 0.025 at 3 s. The error
  // last exceeds 0.05 between 2 s and 3 s, until e^-t |cos(pi t)| = 0.1 at t = 2.16 s.
  const std::optional<RecoveryMetrics> recovery = Recovery(disturb, swings_back);
  ASSERT_TRUE(recovery);
  EXPECT_EQ(recovery->from, 2.0);
  double t = 2.2;
  for (int i = 0; i < 50; ++i) {
    t = std::acos(0.1 * std::exp(t)) / kPi + 2.0;
  }
  EXPECT_GE(*recovery->time, t);
  EXPECT_LE(*recovery->time, t + 0.02 + 1e-12);  // the next control period
  disturb.recovered_within = 1.0;
  EXPECT_EQ(*Recovery(disturb, swings_back)->time, 0.0);
  disturb.recovered_within = 1e-9;
  EXPECT_FALSE(Recovery(disturb, swings_back)->time);
}

TEST(RecoveryTime, CountsFromTheEndOfAGust) {
  Wind wind;
  wind.gusts.push_back({.velocity = {0.0, 10.0}, .from = 3.0, .duration = 1.0});
  const auto blown_off = [](double t) { return t > 3.0 && t < 5.005 ? 0.2 : 0.0; };
  EXPECT_NEAR(*Recovery({}, blown_off, wind)->time, 1.02, Tolerance(1e-12));
}

TEST(RecoveryTime, IsSaidOfNothingElse) {
  const auto on_path = [](double) { return 0.0; };
  Disturbances disturb;
  EXPECT_FALSE(Recovery(disturb, on_path));
  disturb.kicks.push_back({.at = 11.0, .displacement = 0.5});  // after the run
  EXPECT_FALSE(Recovery(disturb, on_path));
  disturb.kicks.front().at = 9.0;
  EXPECT_TRUE(Recovery(disturb, on_path));
  RunLog pathless{.plant = "made_up", .configurations = Table({"t_s"})};
  pathless.rows.emplace_back().state.time = 10.0;
  EXPECT_FALSE(MeasureRecovery(pathless, disturb, {}));
}

TEST(RecoveryTime, IsNullWhereTheCarNeverRecovers) {
  PlantMetrics metrics;
  EXPECT_FALSE(ToJson(metrics).contains("recovery_time"));
  metrics.recovery = RecoveryMetrics{.from = 1.0, .time = {}};
  EXPECT_TRUE(ToJson(metrics)["recovery_time"].is_null());
  metrics.recovery->time = 1.5;
  EXPECT_EQ(ToJson(metrics)["recovery_time"], 1.5);
}

}  // namespace
}  // namespace trackbed
