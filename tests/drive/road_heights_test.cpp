#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "tests/road_network/documents.h"
#include "tests/support/case_names.h"
#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/drive/drive.h"
#include "trackbed/planning/common/plan.h"

// Tests cars on roads with elevation and superelevation.
namespace trackbed {
namespace {

constexpr double kGravity = 9.81;

struct RoadDrive {
  CarModel car;
  Plan plan;
  RunLog log;
};

/// Drives along the right lane of a straight road of 200 m to the east, from x = 20 m on. `world`
/// contains further keys of the world, `more` further sections of the scenario.
RoadDrive DriveOn(const std::string& heights, const std::string& tyre, double speed,
                  const std::string& world = "", const std::string& more = "",
                  const std::string& infeasible = "slow_down") {
  const TempFolder folder;
  RoadText road;
  road.length = "200";
  road.geometry = "<geometry s='0' x='0' y='0' hdg='0' length='200'><line/></geometry>";
  road.heights = heights;
  folder.Write("roads.xodr", Document(road.Xml()));
  const Scenario scenario = ParseScenario(
      fmt::format(
          "schema: 1\nname: heights\nvehicle: {{tyre: {}}}\n"
          "world: {{road_network: roads.xodr{}}}\n"
          "mission: {{speed: {}, route: [{{road: 1, lane: -1, s: 20}}, {{road: 1, lane: -1, "
          "s: 180}}]}}\nplan: {{method: lane_route, infeasible: {}}}\n{}",
          tyre, world, speed, infeasible, more),
      "heights.yaml", folder.path());
  CarModel car = LoadCar(scenario);
  FeasiblePlan plan = PlanScenario(scenario, car.unladen());
  RunLog log = SimulateScenario(scenario, car, plan, "mujoco");
  return {std::move(car), plan, std::move(log)};
}

std::string Bank(double slope) {
  return fmt::format(
      "<lateralProfile><superelevation s='0' a='{}' b='0' c='0' d='0'/></lateralProfile>",
      std::atan(slope));
}

/// Mean loads of the wheels [N] while the rear axle is between x = `from` and x = `to` [m].
std::array<double, 4> MeanLoads(const RunLog& log, double from, double to) {
  std::array<double, 4> sums{};
  double count = 0.0;
  for (const LogRow& row : log.rows) {
    if (row.state.pose.x >= from && row.state.pose.x <= to) {
      for (std::size_t w = 0; w < sums.size(); ++w) {
        sums[w] += row.state.wheels->at(w).normal_force;
      }
      count += 1.0;
    }
  }
  for (double& sum : sums) {
    sum /= std::max(count, 1.0);
  }
  return sums;
}

double Sum(const std::array<double, 4>& loads) {
  return loads[0] + loads[1] + loads[2] + loads[3];
}

class RoadHeights : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Tyres, RoadHeights, testing::Values("contact", "magic_formula"),
                         kNamedByParameter);

TEST_P(RoadHeights, OfConstantSlopesAreThePlaneThatTheWorldCanHave) {
  // The reference is the key `ground` of the world, which describes the same plane in another way.
  for (const auto& [heights, plane] : {std::pair(Elevation(0.0, 0.1, 0.0), "grade: {x: 0.1}"),
                                       std::pair(Bank(0.1), "grade: {y: 0.1}")}) {
    const RoadDrive road = DriveOn(heights, GetParam(), 8.0);
    const RoadDrive oracle = DriveOn("", GetParam(), 8.0, fmt::format(", ground: {{{}}}", plane));
    ASSERT_EQ(road.log.status, DriveStatus::kArrived);
    ASSERT_EQ(oracle.log.status, DriveStatus::kArrived);
    const std::array<double, 4> own = MeanLoads(road.log, 60.0, 140.0);
    const std::array<double, 4> other = MeanLoads(oracle.log, 60.0, 140.0);
    for (std::size_t w = 0; w < own.size(); ++w) {
      // The road surface deviates from the plane by up to 0.02 mm in height and 2e-4 in slope,
      // which changes a wheel load by at most 0.2 %.
      EXPECT_NEAR(own[w], other[w], Tolerance(2e-3 * other[w])) << plane << " wheel " << w;
    }
    const auto end = [](const RunLog& log) { return log.rows.back().state; };
    EXPECT_NEAR(end(road.log).pose.x, end(oracle.log).pose.x, Tolerance(0.01));
    EXPECT_NEAR(end(road.log).pose.y, end(oracle.log).pose.y, Tolerance(0.01));
    EXPECT_NEAR(end(road.log).time, end(oracle.log).time, Tolerance(0.1));
  }
}

TEST_P(RoadHeights, CarryTheWeightAcrossTheSlope) {
  const RoadDrive road = DriveOn(Elevation(0.0, 0.2, 0.0), GetParam(), 6.0);
  const double weight = road.car.params().mass * kGravity;
  // The part of the weight perpendicular to a slope of 0.2 is 1.9 % below the weight. Residual
  // motion of the suspension changes the loads by a tenth of this difference.
  EXPECT_NEAR(Sum(MeanLoads(road.log, 60.0, 140.0)), weight / std::hypot(1.0, 0.2),
              Tolerance(2e-3 * weight));
}

TEST_P(RoadHeights, LoadTheLowerWheelsOfABankedRoad) {
  // The left side is up. The moment of the wheel loads about the middle of the track equals the
  // component of the weight along the road times the height of the center of gravity. The test only
  // requires that this height is between 0.4 and 0.8 m.
  const RoadDrive road = DriveOn(Bank(0.1), GetParam(), 6.0);
  const std::array<double, 4> loads = MeanLoads(road.log, 60.0, 140.0);
  const double weight = road.car.params().mass * kGravity;
  EXPECT_NEAR(Sum(loads), weight / std::hypot(1.0, 0.1), Tolerance(2e-3 * weight));
  const double moment = 0.5 * (loads[1] + loads[3] - loads[0] - loads[2]) * 0.5 *
                        (road.car.params().track_front + road.car.params().track_rear);
  const double height = moment / (weight * std::sin(std::atan(0.1)));
  EXPECT_GT(height, 0.4);
  EXPECT_LT(height, 0.8);
}

TEST_P(RoadHeights, LightenACarOnACrestByTheSquareOfItsSpeed) {
  // The road is a parabola with its crest at x = 100 m. From 97 to 103 m, the vertical acceleration
  // of the car is z'' v^2 = -0.008 * 144 m/s^2.
  const double bend = -0.008;
  const double speed = 12.0;
  // At its ends the road is too steep to stand on, so the car need not reach its goal.
  const RoadDrive road =
      DriveOn(Elevation(0.0, -bend * 100.0, 0.5 * bend), GetParam(), speed, "", "", "allow");
  ASSERT_GT(road.log.rows.back().state.pose.x, 110.0);
  double squares = 0.0;
  double count = 0.0;
  for (const LogRow& row : road.log.rows) {
    if (std::abs(row.state.pose.x + 1.35 - 100.0) < 3.0) {
      squares += row.state.speed * row.state.speed;
      count += 1.0;
    }
  }
  const double mass = road.car.params().mass;
  // The center of gravity, at the height h, moves on a path whose curvature differs by the factor 1
  // + h z'', which is 0.5 %. Wheels and chassis do not follow the curve of the ground in phase,
  // which changes the loads by up to 2 % of the weight.
  EXPECT_NEAR(Sum(MeanLoads(road.log, 95.65, 101.65)), mass * (kGravity + bend * squares / count),
              Tolerance(0.02 * mass * kGravity));
}

TEST(RoadHeightsCoasting, SlowACarBySineOfTheGrade) {
  const auto deceleration = [](const std::string& heights) {
    const RoadDrive road =
        DriveOn(heights, "magic_formula", 15.0, "",
                "control: {method: stanley, speed: {braking: {at: 2, deceleration: 0}}}\n");
    double first = 0.0;
    double last = 0.0;
    for (const LogRow& row : road.log.rows) {
      first = row.state.time <= 2.5 ? row.state.speed : first;
      last = row.state.time <= 4.5 ? row.state.speed : last;
    }
    return 0.5 * (first - last);
  };
  const double grade = 0.05;
  const double slowed = deceleration(Elevation(0.0, grade, 0.0)) - deceleration("");
  // The inertia of the wheels adds a few percent to the mass. The drag decreases with the speed,
  // but by less.
  EXPECT_NEAR(slowed, kGravity * grade, Tolerance(0.08 * kGravity * grade));
}

/// The planned speed on an arc of 60 m radius to the left, at the limit [m/s].
double SpeedAtLimitOnArc(const std::string& heights) {
  const TempFolder folder;
  RoadText road;
  road.length = "200";
  road.geometry =
      "<geometry s='0' x='-50' y='0' hdg='0' length='50'><line/></geometry>"
      "<geometry s='50' x='0' y='0' hdg='0' length='40'><spiral curvStart='0' "
      "curvEnd='0.016666666667'/></geometry>"
      "<geometry s='90' x='39.557835939' y='4.409295538' hdg='0.333333333333' length='110'>"
      "<arc curvature='0.016666666667'/></geometry>";
  road.heights = heights;
  folder.Write("roads.xodr", Document(road.Xml()));
  const Scenario scenario = ParseScenario(
      "schema: 1\nname: arc\nvehicle: {tyre: magic_formula}\nworld: {road_network: roads.xodr}\n"
      "mission: {speed: 60, speed_profile: {method: limits, share: 0.9}, start: {speed: 15}, "
      "route: [{road: 1, lane: -1, s: 5}, {road: 1, lane: -1, s: 195}]}\n"
      "plan: {method: lane_route}\n",
      "arc.yaml", folder.path());
  const Plan plan = PlanScenario(scenario, LoadCar(scenario));
  EXPECT_TRUE(plan.ok()) << plan.reason;
  return plan.reference.speed.SpeedAt(110.0);
}

TEST(RoadHeightsLimits, AreHigherInABankedTurn) {
  const double level = SpeedAtLimitOnArc("");
  const double banked = SpeedAtLimitOnArc(Bank(-0.1));  // the right side up
  const double radius = 60.0 + 1.75;
  // A point mass on a bank with the slope e obeys v^2 = g R (mu + e)/(1 - mu e). Changes of the
  // wheel loads change the friction coefficient by a few percent, and the speed by half of this.
  const double mu = level * level / (kGravity * radius);
  const double expected = std::sqrt(kGravity * radius * (mu + 0.1) / (1.0 - 0.1 * mu));
  EXPECT_GT(expected, 1.05 * level);
  EXPECT_NEAR(banked, expected, Tolerance(0.02 * expected));
}

}  // namespace
}  // namespace trackbed
