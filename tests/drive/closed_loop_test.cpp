#include "trackbed/drive/closed_loop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "tests/drive/unicycle.h"
#include "tests/tolerance.h"
#include "trackbed/control/controllers.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/core/error.h"
#include "trackbed/drive/drive.h"
#include "trackbed/planning/common/plan.h"

// Tests the closed loop with a plant and a controller that a user defines.
namespace trackbed {
namespace {

LoopConfig Config() {
  return {.vehicle = UnicycleParams()};
}

LoopConfig ConfigFor(double duration) {
  LoopConfig config = Config();
  config.duration = duration;
  return config;
}

TEST(SimulateClosedLoop, DrivesAPlantOfYourOwnOnACircle) {
  Unicycle plant({.pose = {1.0, 2.0, 0.5}, .speed = 3.0, .steering = 0.1});
  ConstantController controller(0.1);
  const RunLog log =
      SimulateClosedLoop(plant, controller, Drivable(PlanAtSpeed(3.0)), ConfigFor(4.0));
  EXPECT_EQ(log.status, DriveStatus::kArrived);
  ASSERT_EQ(log.rows.size(), 201U);
  const double radius = kUnicycleWheelbase / std::tan(0.1);
  for (const LogRow& row : log.rows) {
    // The tolerance covers 2000 roundings of numbers below 32 by up to half an ulp, 1.8e-15, each.
    // Equal roundings of the yaw are multiplied by the distance of 12 m.
    const double yaw = 0.5 + 3.0 * row.state.time / radius;
    const double x = 1.0 + radius * (std::sin(yaw) - std::sin(0.5));
    const double y = 2.0 - radius * (std::cos(yaw) - std::cos(0.5));
    EXPECT_NEAR(row.state.pose.x, x, Tolerance(1e-10)) << row.state.time;
    EXPECT_NEAR(row.state.pose.y, y, Tolerance(1e-10)) << row.state.time;
    EXPECT_NEAR(row.state.speed, 3.0, Tolerance(1e-12));
    EXPECT_FALSE(row.tracking);
  }
}

TEST(SimulateClosedLoop, ObeysAControllerThatSetsTheSpeed) {
  Unicycle plant({});
  ConstantController controller(0.0, 0.5);
  const RunLog log =
      SimulateClosedLoop(plant, controller, Drivable(PlanAtSpeed(3.0)), ConfigFor(6.0));
  for (const LogRow& row : log.rows) {
    const double t = row.state.time;
    // The tolerance covers 3000 additions to numbers below 16, rounded by up to half an ulp,
    // 0.9e-15, each.
    EXPECT_NEAR(row.state.pose.x, 0.25 * t * t, Tolerance(3000 * 0.9e-15 * 2.0));
    EXPECT_NEAR(row.state.speed, 0.5 * t, Tolerance(3000 * 0.9e-15));
  }
}

TEST(SimulateClosedLoop, ArrivesAtTheEndOfAPathWhenItsSpeedsSay) {
  Unicycle plant({});
  ConstantController controller(0.0);
  const RunLog log = SimulateClosedLoop(
      plant, controller, Drivable(PlanAlongRoute({{.length = 50.0}}, 0.0)), Config());
  EXPECT_EQ(log.status, DriveStatus::kArrived);
  // The car accelerates over 4.5 m in 3 s, drives 42.5 m at 3 m/s and brakes over 3 m in 2 s. At
  // each of the three knots of the speed profile, the speed errs by at most the control period
  // times the change of acceleration. An error of the speed by 1.5 m/s^2 x 0.02 s during half a
  // period, 0.01 s, moves the stop by 0.3 mm. The last row of the log is the first row at rest, at
  // most two periods after the stop.
  EXPECT_NEAR(log.rows.back().state.pose.x, 50.0, Tolerance(3 * 3e-4));
  EXPECT_NEAR(log.rows.back().state.time, 5.0 + 42.5 / 3.0, Tolerance(0.05));
  for (const LogRow& row : log.rows) {
    ASSERT_TRUE(row.tracking);
    EXPECT_NEAR(row.tracking->s, row.state.pose.x, Tolerance(1e-9));
    EXPECT_LE(row.state.speed, 3.0 + 1e-9);
  }
}

TEST(SimulateClosedLoop, DrivesForwardAndReverseSegmentsInTurn) {
  Unicycle plant({});
  ConstantController controller(0.0);
  const RunLog log = SimulateClosedLoop(
      plant, controller,
      Drivable(PlanAlongRoute({{.length = 10.0}, {.length = 6.0, .direction = -1}}, 0.0)),
      Config());
  EXPECT_EQ(log.status, DriveStatus::kArrived);
  EXPECT_NEAR(log.rows.back().state.pose.x, 4.0, Tolerance(0.01));
  EXPECT_NEAR(log.rows.back().tracking->s, 16.0, Tolerance(0.01));
  double farthest = 0.0;
  int changes = 0;
  for (std::size_t i = 1; i < log.rows.size(); ++i) {
    const LogRow& row = log.rows[i];
    farthest = std::max(farthest, row.state.pose.x);
    changes += row.command.gear != log.rows[i - 1].command.gear ? 1 : 0;
    EXPECT_GE(row.tracking->s, log.rows[i - 1].tracking->s - 0.01);
  }
  EXPECT_EQ(changes, 1);
  EXPECT_NEAR(farthest, 10.0, Tolerance(0.01));
}

/// A unicycle that a grade stops `before` meters before x = 10.
class HeldByAGrade : public Unicycle {
 public:
  HeldByAGrade(const StartState& start, double before) : Unicycle(start), end_(10.0 - before) {}
  void Step(const Command& command) override {
    Unicycle::Step(command);
    if (state().pose.x > end_) {
      state().pose.x = end_;
      state().speed = 0.0;
    }
  }

 private:
  double end_;
};

TEST(SimulateClosedLoop, ArrivesWhereAGradeHoldsTheCarAtTheGoal) {
  // The car stands still although it is commanded to drive. Within 0.4 m of the goal, the car has
  // arrived after 1 s at rest.
  for (const double before : {0.002, 0.1, 0.39}) {
    HeldByAGrade plant({}, before);
    ConstantController controller(0.0);
    const RunLog log = SimulateClosedLoop(
        plant, controller, Drivable(PlanAlongRoute({{.length = 10.0}}, 0.0)), Config());
    EXPECT_EQ(log.status, DriveStatus::kArrived) << before;
    EXPECT_LT(log.rows.back().state.time, 12.0) << before;
  }
  HeldByAGrade plant({}, 0.41);
  ConstantController controller(0.0);
  const RunLog log = SimulateClosedLoop(
      plant, controller, Drivable(PlanAlongRoute({{.length = 10.0}}, 0.0)), Config());
  EXPECT_EQ(log.status, DriveStatus::kStopped);  // the car brakes for the goal when the grade stops
                                                 // it
}

TEST(SimulateClosedLoop, ChangesGearWhereAGradeHoldsTheCarAtACusp) {
  HeldByAGrade plant({}, 0.1);
  ConstantController controller(0.0);
  const RunLog log = SimulateClosedLoop(
      plant, controller,
      Drivable(PlanAlongRoute({{.length = 10.0}, {.length = 6.0, .direction = -1}}, 0.0)),
      Config());
  EXPECT_EQ(log.status, DriveStatus::kArrived);
}

TEST(SimulateClosedLoop, CountsFromTheOdometerThatThePlantBeginsWith) {
  const auto stations = [](double odometer) {
    Unicycle plant({});
    plant.state().distance = odometer;
    ConstantController controller(0.0);
    LoopConfig config = Config();
    config.station_source = StationSource::kOdometer;
    const RunLog log = SimulateClosedLoop(
        plant, controller, Drivable(PlanAlongRoute({{.length = 10.0}}, 0.0)), config);
    EXPECT_EQ(log.status, DriveStatus::kArrived);
    return controller.stations;
  };
  const std::vector<double> own = stations(0.0);
  const std::vector<double> later = stations(128.0);
  ASSERT_EQ(later.size(), own.size());
  for (std::size_t i = 0; i < own.size(); ++i) {
    // The tolerance covers 3500 additions to numbers from 128 to 138, rounded by up to half an ulp,
    // 1.4e-14, each.
    EXPECT_NEAR(later[i], own[i], Tolerance(3500 * 1.4e-14));
  }
}

TEST(SimulateClosedLoop, RampsAPrescribedAngleOverTheControlPeriod) {
  Unicycle plant({.speed = 3.0, .steering = 0.02});
  ConstantController controller(0.1);
  LoopConfig config = ConfigFor(0.04);
  config.steering_input = SteeringInput::kPrescribed;
  SimulateClosedLoop(plant, controller, Drivable(PlanAtSpeed(3.0)), config);
  ASSERT_EQ(plant.commands.size(), 20U);
  for (int i = 0; i < 10; ++i) {
    EXPECT_NEAR(plant.commands[static_cast<std::size_t>(i)].steering, 0.02 + 0.008 * (i + 1),
                Tolerance(1e-16 * 2));
    EXPECT_EQ(plant.commands[static_cast<std::size_t>(10 + i)].steering, 0.1);
  }
}

TEST(SimulateClosedLoop, ShowsTheControllerWhatIsMeasured) {
  Unicycle plant({.speed = 3.0});
  ConstantController controller(0.0);
  LoopConfig config = ConfigFor(1.0);
  config.disturbances.noise = {.position = 0.1, .heading = 0.01};
  config.seed = 5;
  const RunLog log = SimulateClosedLoop(plant, controller, Drivable(PlanAtSpeed(3.0)), config);
  ASSERT_EQ(controller.inputs.size() + 1, log.rows.size());
  for (std::size_t i = 0; i < controller.inputs.size(); ++i) {
    EXPECT_EQ(controller.inputs[i].pose.x, log.rows[i].measured->x);
    EXPECT_EQ(controller.inputs[i].pose.yaw, log.rows[i].measured->yaw);
    EXPECT_NE(controller.inputs[i].pose.x, log.rows[i].state.pose.x);
  }
}

TEST(SimulateClosedLoop, EndsAsThePlantDoes) {
  class Diverging : public Unicycle {
   public:
    using Unicycle::Unicycle;
    void Step(const Command& command) override {
      Unicycle::Step(command);
      is_diverged = commands.size() == 25;
    }
  };
  Diverging plant({.speed = 3.0});
  ConstantController controller(0.0);
  const RunLog log =
      SimulateClosedLoop(plant, controller, Drivable(PlanAtSpeed(3.0)), ConfigFor(5.0));
  EXPECT_EQ(log.status, DriveStatus::kDiverged);
  EXPECT_EQ(plant.commands.size(), 25U);  // the car diverged in the middle of the third period and
                                          // was not stepped again
  EXPECT_EQ(log.rows.size(), 3U);         // the log ends before
}

TEST(SimulateClosedLoop, CallsBackWithEachRowBeforeItIsSimulatedOn) {
  Unicycle plant({.speed = 3.0});
  ConstantController controller(0.1);
  LoopConfig config = ConfigFor(1.0);
  config.configuration_columns = {"x_m", "y_m"};
  std::vector<double> times;
  config.hooks.logged = [&](const RunLog& log, const Table& configurations) {
    times.push_back(log.rows.back().state.time);
    EXPECT_EQ(log.rows.size(), times.size());
    // The plant is at the pose of the row, and the configurations end within one state period of
    // the row's time.
    EXPECT_EQ(plant.Observe().pose.x, log.rows.back().state.pose.x);
    EXPECT_LE(configurations.at(configurations.rows() - 1, 0), times.back() + 1e-9);  // rounding
    EXPECT_GT(configurations.at(configurations.rows() - 1, 0), times.back() - config.state_period);
  };
  const RunLog log = SimulateClosedLoop(plant, controller, Drivable(PlanAtSpeed(3.0)), config);
  ASSERT_EQ(times.size(), log.rows.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    EXPECT_EQ(times[i], log.rows[i].state.time);
  }
}

TEST(SimulateClosedLoop, CallsItsHooks) {
  Unicycle plant({.speed = 3.0});
  ConstantController controller(0.0);
  LoopConfig config = ConfigFor(2.0);
  int updates = 0;
  std::vector<double> progress;
  config.hooks.steered = [&](double seconds) {
    ++updates;
    EXPECT_GE(seconds, 0.0);
  };
  config.hooks.progress = [&](double fraction) { progress.push_back(fraction); };
  const RunLog log = SimulateClosedLoop(plant, controller, Drivable(PlanAtSpeed(3.0)), config);
  EXPECT_EQ(updates, 100);
  ASSERT_FALSE(progress.empty());
  EXPECT_LE(progress.size(), 100U);
  EXPECT_EQ(progress.back(), 1.0);
  EXPECT_TRUE(std::is_sorted(progress.begin(), progress.end()));

  int asked = 0;
  config.hooks.interrupted = [&] { return ++asked > 10; };
  Unicycle again({.speed = 3.0});
  const RunLog cut = SimulateClosedLoop(again, controller, Drivable(PlanAtSpeed(3.0)), config);
  EXPECT_EQ(cut.status, DriveStatus::kInterrupted);
  EXPECT_EQ(cut.rows.size(), 11U);
}

TEST(SimulateClosedLoop, RepeatsEveryBit) {
  const auto csv = [] {
    Unicycle plant({.speed = 3.0});
    ConstantController controller(0.05);
    LoopConfig config = ConfigFor(3.0);
    config.disturbances.noise = {.position = 0.1, .heading = 0.01};
    config.configuration_columns = {"x_m", "y_m"};
    const RunLog log = SimulateClosedLoop(plant, controller, Drivable(PlanAtSpeed(3.0)), config);
    return ToTable(log).ToCsv() + log.configurations.ToCsv();
  };
  EXPECT_EQ(csv(), csv());
}

/// Returns the error message for arguments that `spoil` has changed, or an empty text if there is
/// no error. After an error, the plant must not have been stepped.
std::string MessageFor(const std::function<void(LoopConfig&, Plan&)>& spoil) {
  LoopConfig config = Config();
  Plan plan = PlanAlongRoute({{.length = 10.0}}, 3.0);
  spoil(config, plan);
  Unicycle plant({.speed = 3.0});
  ConstantController controller(0.0);
  try {
    SimulateClosedLoop(plant, controller, Drivable(plan), config);
  } catch (const PreconditionError& error) {
    EXPECT_TRUE(plant.commands.empty());
    return error.what();
  }
  return "";
}

TEST(SimulateClosedLoop, RefusesBadArguments) {
  static constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::pair<std::function<void(LoopConfig&, Plan&)>, std::string>> cases{
      {[](LoopConfig&, Plan& plan) {
         plan.status = PlanStatus::kTurnTooTight;
         plan.reason = "radius 1 m";
       },
       "the plan's status is turn_too_tight (radius 1 m); must be ok"},
      {[](LoopConfig& c, Plan&) { c.vehicle = {}; },
       "LoopConfig::vehicle.wheelbase is 0; must be finite and above 0"},
      {[](LoopConfig& c, Plan&) { c.nominal_vehicle = VehicleParams{}; },
       "LoopConfig::nominal_vehicle.wheelbase is 0; must be finite and above 0"},
      {[](LoopConfig& c, Plan&) { c.timestep = 0.0; },
       "LoopConfig::timestep is 0; must be finite and above 0"},
      {[](LoopConfig& c, Plan&) { c.control_period = 0.003; },
       "LoopConfig::control_period is 0.003 s; must be a whole number of timesteps of 0.002 s"},
      {[](LoopConfig& c, Plan&) { c.control_period = 0.0; },
       "LoopConfig::control_period is 0 s; must be a whole number of timesteps of 0.002 s"},
      {[](LoopConfig& c, Plan&) { c.state_period = -1.0; },
       "LoopConfig::state_period is -1; must be finite and above 0"},
      {[](LoopConfig& c, Plan&) { c.time_limit = kNan; },
       "LoopConfig::time_limit is nan; must be finite and above 0"},
      {[](LoopConfig& c, Plan&) { c.duration = 0.0; },
       "LoopConfig::duration is 0; must be finite and above 0"},
      {[](LoopConfig& c, Plan&) { c.goal_tolerance = -0.1; },
       "LoopConfig::goal_tolerance is -0.1; must be finite and at least 0"},
      {[](LoopConfig& c, Plan&) { c.goal_heading_tolerance = kNan; },
       "LoopConfig::goal_heading_tolerance is nan; must be finite and at least 0"},
      {[](LoopConfig& c, Plan&) { c.follow_schedule = true; },
       "LoopConfig::follow_schedule needs station_source kOdometer"},
      {[](LoopConfig& c, Plan&) { c.speed.deceleration = 0.0; },
       "LoopConfig::speed.deceleration is 0; must be finite and above 0"},
      {[](LoopConfig& c, Plan&) { c.disturbances.steering.factor = 0.0; },
       "LoopConfig::disturbances.steering.factor is 0; must be finite and above 0"},
      {[](LoopConfig& c, Plan&) { c.disturbances.noise.position = -1.0; },
       "LoopConfig::disturbances.noise.position is -1; must be finite and at least 0"},
      {[](LoopConfig& c, Plan&) { c.configuration_columns = {"x_m"}; },
       "LoopConfig::configuration_columns has 1 names; the plant's configuration has 2 numbers"},
      {[](LoopConfig& c, Plan&) { c.replanning.emplace().avoid.emplace(); },
       "ReplanningConfig::limits.speed is 0; must be finite and above 0"},
      {[](LoopConfig& c, Plan&) {
         c.replanning.emplace().limits = kUnicycleLimits;
         c.replanning->replan.emplace();
       },
       "ReplanningConfig::replan has neither `along` nor `detour`; it needs at least one"},
      {[](LoopConfig& c, Plan& plan) {
         plan = PlanAtSpeed(3.0);
         c.replanning.emplace().limits = kUnicycleLimits;
         c.replanning->avoid.emplace();
       },
       "the plan has no path; LoopConfig::replanning needs one"},
  };
  for (const auto& [spoil, expected] : cases) {
    EXPECT_EQ(MessageFor(spoil), "SimulateClosedLoop: " + expected);
  }
  EXPECT_EQ(MessageFor([](LoopConfig&, Plan&) {}), "");
}

TEST(SimulateClosedLoop, StopsAtAnAnswerThatIsNoNumber) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), HUGE_VAL}) {
    Unicycle plant({});
    ConstantController steers(bad);
    EXPECT_THROW(SimulateClosedLoop(plant, steers, Drivable(PlanAtSpeed(3.0)), ConfigFor(1.0)),
                 PreconditionError);
    ConstantController accelerates(0.0, bad);
    EXPECT_THROW(SimulateClosedLoop(plant, accelerates, Drivable(PlanAtSpeed(3.0)), ConfigFor(1.0)),
                 PreconditionError);
    EXPECT_TRUE(plant.commands.empty());
  }
}

TEST(LoopConfig, HasTheDefaultsOfScenarios) {
  const LoopConfig config;
  const DriveSpec drive;
  EXPECT_EQ(config.timestep, drive.timestep);
  EXPECT_EQ(config.control_period, drive.control_period);
  EXPECT_EQ(config.state_period, drive.state_period);
  EXPECT_EQ(config.time_limit, drive.time_limit);
  EXPECT_EQ(config.goal_tolerance, drive.goal_tolerance);
  EXPECT_EQ(config.steering_input, drive.steering);
}

TEST(SimulateScenario, IsTheLoopOfTheScenariosParts) {
  const Scenario scenario = ParseScenario(
      "schema: 1\nname: parts\nseed: 3\n"
      "mission: {speed: 3, waypoints: [[0, 0], [0, 6]], headings: [0, 3.1416], start: {speed: 0}}\n"
      "plan: {method: reeds_shepp}\ncontrol: {method: preview}\n"
      "disturb: {noise: {position: 0.01, heading: 0.001}, wheelbase: 1.1, payload: {share: 0.1}}\n"
      "drive: {plants: [kinematic]}\n",
      "parts.yaml", ".");
  const CarModel car = LoadCar(scenario);
  const FeasiblePlan plan = PlanScenario(scenario, car.unladen());
  const RunLog driven = SimulateScenario(scenario, car, plan, "kinematic");
  EXPECT_EQ(driven.plant, "kinematic");
  const auto plant = MakePlant(
      "kinematic", {.car = car, .world = scenario.world, .start = InitialState(scenario)});
  const auto controller = MakeSteeringController(scenario.control.steering);
  const LoopConfig config = MakeLoopConfig(scenario, car);
  EXPECT_EQ(config.goal_heading_tolerance, scenario.drive.goal_heading_tolerance);
  EXPECT_EQ(config.vehicle.mass, car.params().mass);
  ASSERT_TRUE(config.nominal_vehicle);
  EXPECT_EQ(config.nominal_vehicle->mass, car.unladen().mass);
  const RunLog own = SimulateClosedLoop(*plant, *controller, plan, config);
  EXPECT_EQ(ToTable(own).ToCsv(), ToTable(driven).ToCsv());
  EXPECT_EQ(own.configurations.ToCsv(), driven.configurations.ToCsv());
  EXPECT_EQ(own.status, driven.status);
}

TEST(SimulateScenario, RefusesAPlanThatIsNotOk) {
  const Scenario scenario = ParseScenario(
      "schema: 1\nname: none\nmission: {speed: 3, waypoints: [[0, 0], [30, 0]]}\n"
      "plan: {method: dubins}\ncontrol: {method: preview}\n",
      "none.yaml", ".");
  Plan plan;
  plan.status = PlanStatus::kUTurn;
  EXPECT_THROW(SimulateScenario(scenario, LoadCar(scenario), Drivable(plan), "kinematic"),
               PreconditionError);
}

}  // namespace
}  // namespace trackbed
