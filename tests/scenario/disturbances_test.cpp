#include "trackbed/scenario/disturbances.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "trackbed/scenario/scenario.h"

namespace trackbed {
namespace {

Scenario Read(const std::string& disturb) {
  return ParseScenario(
      "schema: 1\nname: disturbed\nmission: {speed: 3, duration: 5}\n"
      "control: {method: constant_steering, steering: 0}\n" +
          disturb,
      "test.yaml", ".");
}

TEST(Disturbances, AreOffUnlessAskedFor) {
  const Disturbances none = Read("").disturb;
  EXPECT_FALSE(none.speed_loss);
  EXPECT_EQ(none.wheelbase, 1.0);
  EXPECT_EQ(none.steering.factor, 1.0);
  EXPECT_EQ(none.steering.delay, 0.0);
  EXPECT_EQ(none.steering.backlash, 0.0);
  EXPECT_EQ(none.noise.position, 0.0);
  EXPECT_EQ(none.noise.heading, 0.0);
  EXPECT_FALSE(none.payload);
  EXPECT_TRUE(none.kicks.empty());
}

constexpr const char* kAll = R"(disturb:
  speed_loss: {station: 12, speed: 1}
  wheelbase: 1.1
  steering: {factor: 0.9, delay: 0.1, backlash: 0.02}
  noise: {position: 0.05, heading: 0.01}
  payload: {share: 0.2, x: -0.5, y: 0.3, z: 0.4}
  kicks:
    - {at: 2, displacement: 0.5}
    - {at: 3, impulse: -900, duration: 0.2}
  recovered_within: 0.1
)";

TEST(Disturbances, AreReadAndWrittenBack) {
  const std::string resolved = ResolvedYaml(Read(kAll));
  EXPECT_EQ(ResolvedYaml(ParseScenario(resolved, "resolved.yaml", ".")), resolved);
  const Disturbances all = ParseScenario(resolved, "resolved.yaml", ".").disturb;
  EXPECT_EQ(all.speed_loss->station, 12.0);
  EXPECT_EQ(all.speed_loss->speed, 1.0);
  EXPECT_EQ(all.wheelbase, 1.1);
  EXPECT_EQ(all.steering.factor, 0.9);
  EXPECT_EQ(all.steering.delay, 0.1);
  EXPECT_EQ(all.steering.backlash, 0.02);
  EXPECT_EQ(all.noise.position, 0.05);
  EXPECT_EQ(all.noise.heading, 0.01);
  EXPECT_EQ(all.payload->share, 0.2);
  EXPECT_EQ(all.payload->x, -0.5);
  EXPECT_EQ(all.payload->y, 0.3);
  EXPECT_EQ(all.payload->z, 0.4);
  ASSERT_EQ(all.kicks.size(), 2U);
  EXPECT_EQ(all.kicks[0].displacement, 0.5);
  EXPECT_EQ(all.kicks[1].at, 3.0);
  EXPECT_EQ(all.kicks[1].impulse, -900.0);
  EXPECT_EQ(all.kicks[1].duration, 0.2);
  EXPECT_EQ(all.recovered_within, 0.1);
}

TEST(DisturbedUntil, IsTheEndOfTheLastThatEnds) {
  const Disturbances all = Read(kAll).disturb;
  EXPECT_EQ(DisturbedUntil(all, {}, 10.0), 3.2);
  EXPECT_EQ(DisturbedUntil(all, {}, 3.0), 2.0);
  EXPECT_EQ(DisturbedUntil(all, {}, 1.0), std::nullopt);
  EXPECT_EQ(DisturbedUntil({}, {}, 10.0), std::nullopt);
  Wind wind;
  wind.gusts.push_back({.velocity = {0.0, 10.0}, .from = 4.0, .duration = 1.0});
  wind.gusts.push_back({.velocity = {0.0, 10.0}, .from = 6.0, .shape = GustShape::kStep});
  EXPECT_EQ(DisturbedUntil(all, wind, 10.0), 5.0);
  Disturbances kick;
  kick.kicks.push_back({.at = 1.0, .impulse = 100.0});
  EXPECT_EQ(DisturbedUntil(kick, {}, 10.0), 1.0 + kKickDuration);
}

}  // namespace
}  // namespace trackbed
