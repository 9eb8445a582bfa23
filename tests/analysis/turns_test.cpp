#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <ostream>
#include <string>

#include "tests/support/case_names.h"
#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/analysis/run.h"
#include "trackbed/core/file.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/vehicle/steering_schedule.h"

// Tests the predicted and the measured effects of the limited steering rate on turns.
namespace trackbed {
namespace turns_test {

Scenario Load(const std::string& name, const std::vector<Override>& overrides) {
  return ReadScenario(std::string(TRACKBED_SOURCE_DIR) + "/scenarios/" + name + ".yaml", overrides);
}

TEST(Turns, OfTheKinematicCarAreAsPredicted) {
  for (const char* name : {"three_turns", "winding"}) {
    const RunResult run =
        RunScenario(Load(name, {"control.method=schedule", "drive.plants=[kinematic]"}));
    ASSERT_EQ(run.metrics[0].turns.size(), 3U);
    for (const TurnMetrics& turn : run.metrics[0].turns) {
      // Between rows 0.06 m apart, the yaw deviates from a straight line by kappa' ds^2/8 = 0.0056
      // x 0.0036/8 = 2.5e-6 rad at either end of the turn. The corners of the steering schedule are
      // known to a control period, which adds the same error.
      EXPECT_NEAR(turn.measured.heading_deficit, turn.predicted.heading_deficit, Tolerance(1e-5));
      EXPECT_NEAR(turn.measured.lateral_offset, turn.predicted.lateral_offset, Tolerance(1e-4));
    }
  }
}

TEST(Turns, SayWhereAndWhenTheyWereMeasured) {
  const RunResult run = RunScenario(Load("three_turns", {"drive.plants=[kinematic]"}));
  const std::vector<IsolatedTurn>& planned = run.plan->turns;
  const std::vector<TurnMetrics>& turns = run.metrics[0].turns;
  ASSERT_EQ(turns.size(), planned.size());
  for (std::size_t i = 0; i < turns.size(); ++i) {
    EXPECT_EQ(turns[i].s, planned[i].middle);
    // The car drives at 3 m/s from the first row on. In a bend of radius 16.8 m, the car drives up
    // to 1 cm inside its path, which shortens the distance by 0.1 %.
    EXPECT_NEAR(turns[i].t, planned[i].middle / 3.0, Tolerance(1e-3 * turns[i].t));
  }
}

TEST(Turns, OnContactsLagByTheServo) {
  const RunResult run = RunScenario(
      Load("three_turns", {"control.method=schedule", "drive.plants=['mujoco:contact']"}));
  ASSERT_EQ(run.metrics[0].turns.size(), 3U);
  for (const TurnMetrics& turn : run.metrics[0].turns) {
    // The contacts of the tyres slip at a velocity proportional to the force, which changes the
    // heading of pi/4 by 0.1 %.
    EXPECT_NEAR(turn.measured.heading_deficit, turn.predicted.heading_deficit,
                Tolerance(1e-3 * 0.785));
  }
}

struct Ramp {
  double speed;   // [m/s]
  double radius;  // [m]
  double rate;    // steering rate as a multiple of the Prius's
};

void PrintTo(const Ramp& ramp, std::ostream* out) {
  *out << fmt::format("{} m/s to {} m at {} of the rate", ramp.speed, ramp.radius, ramp.rate);
}

class HeadingDeficit : public ::testing::TestWithParam<Ramp> {};

TEST_P(HeadingDeficit, OfAStepOnContactsIsTheClosedForm) {
  const Ramp& ramp = GetParam();
  const TempFolder folder;
  // The model of the Prius with a different steering rate.
  std::string model = ReadFile(std::string(TRACKBED_SOURCE_DIR) + "/models/prius/prius.xml");
  const std::string own = "-0.15056818181818182 0.15056818181818182";
  const std::size_t at = model.find(own);
  ASSERT_NE(at, std::string::npos);
  const double rate = ramp.rate * 0.15056818181818182;
  model.replace(at, own.size(), fmt::format("{} {}", -rate, rate));
  WriteFileAtomically(folder.path() / "car.xml", model);
  const double delta = std::atan(2.7 / ramp.radius);
  const Scenario scenario =
      ParseScenario(fmt::format("schema: 1\nname: step\nvehicle: {{model: ./car.xml}}\n"
                                "mission: {{speed: {}, duration: 8}}\n"
                                "control: {{method: constant_steering, steering: {}}}\n"
                                "drive: {{plants: ['mujoco:contact']}}\n",
                                ramp.speed, delta),
                    "step.yaml", folder.path());
  const CarModel car = LoadCar(scenario);
  ASSERT_NEAR(car.params().steering_rate, rate, 1e-12);
  const RunLog log =
      SimulateScenario(scenario, car, PlanScenario(scenario, car.params()), "mujoco:contact");
  // Compares the car with a car that follows a curvature step. The heading deficit is measured
  // after the wheels have settled, five steering lags after the end of the ramp.
  const double ramp_time = delta / rate;
  const double lag = car.params().steering_lag;
  const auto row = static_cast<std::size_t>(std::ceil((ramp_time + 5.0 * lag) / 0.02));
  ASSERT_LT(row, log.rows.size());
  const VehicleState& state = log.rows[row].state;
  const double deficit = state.distance / ramp.radius - state.pose.yaw;
  const double ramp_distance = SteeringDistance(car.params(), delta, ramp.speed);
  const double predicted = ramp_distance / ramp.radius -
                           RampHeading(car.params(), delta, ramp.speed) +
                           ramp.speed * lag / ramp.radius;
  EXPECT_NEAR(deficit, predicted, Tolerance(0.05 * predicted));
}

INSTANTIATE_TEST_SUITE_P(Speeds, HeadingDeficit,
                         ::testing::Values(Ramp{1.5, 8.0, 1.0}, Ramp{3.0, 8.0, 1.0},
                                           Ramp{3.0, 15.0, 1.0}, Ramp{5.0, 15.0, 1.0},
                                           Ramp{5.0, 30.0, 1.0}, Ramp{3.0, 15.0, 0.5},
                                           Ramp{3.0, 10.0, 2.0}, Ramp{8.0, 40.0, 3.0}),
                         kNamedByParameter);

}  // namespace turns_test
}  // namespace trackbed
