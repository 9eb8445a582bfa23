// Counts work instead of timing it: the counts are the same on every machine, except for rounding.
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <string>

#include "src/sim/mujoco_compat.h"
#include "tests/planning/frenet_scenes.h"
#include "tests/support/allocations.h"
#include "trackbed/drive/drive.h"
#include "trackbed/planning/frenet/lattice.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/sim/plant.h"

namespace trackbed {
namespace {

constexpr double kTimestep = 0.002;  // [s]

/// Plants in a slalom at 15 m/s, up to 3 m/s^2 to either side.
class Slalom {
 public:
  Slalom(const std::string& model, const std::string& plant)
      : car_(ComposeScene(FindModel(model, ""), {.timestep = kTimestep}), model),
        plant_(MakePlant(plant, {.car = car_, .world = world_, .start = {.speed = 15.0}})) {}

  void Steps(int count) {
    const double steering = std::atan(3.0 / (15.0 * 15.0) * car_.params().wheelbase);
    for (const int end = step_ + count; step_ < end; ++step_) {
      plant_->Step({.steering = steering * std::sin(1.5 * step_ * kTimestep)});
    }
  }

 private:
  World world_;
  CarModel car_;
  std::unique_ptr<Plant> plant_;
  int step_ = 0;
};

TEST(Allocations, PlantsStepWithoutAny) {
  for (const PlantEntry& entry : Plants()) {
    Slalom slalom("bmw320i", entry.name);
    slalom.Steps(10);
    const long before = allocations;
    slalom.Steps(1000);
    EXPECT_EQ(allocations - before, 0) << entry.name;
  }
}

/// Counts the allocations of a run of the scenario three_turns, after its model and plan have been
/// made.
long AllocationsOfRun(const std::string& plant, double duration) {
  Scenario scenario = ReadScenario(DataFolder() / "scenarios" / "three_turns.yaml");
  scenario.drive.time_limit = duration;
  const CarModel car = LoadCar(scenario);
  const FeasiblePlan plan = PlanScenario(scenario, car.params());
  const long before = allocations;
  static_cast<void>(SimulateScenario(scenario, car, plan, plant));
  return allocations - before;
}

TEST(Allocations, ControlPeriodsTakeMemoryForTheirLogOnly) {
  // In 10 s 600 configurations are logged. For each configuration, the plant makes a vector. Plants
  // without forces first make a vector of MuJoCo's positions. The two logs grow from 100 to at most
  // 700 rows, and double their memory at most three times each.
  constexpr long kSamples = 600;
  constexpr long kGrowth = 6;
  for (const auto& [plant, vectors] :
       {std::pair("kinematic", 2), std::pair("single_track", 2), std::pair("mujoco", 1)}) {
    const long added = AllocationsOfRun(plant, 12.0) - AllocationsOfRun(plant, 2.0);
    EXPECT_LE(added, vectors * kSamples + kGrowth) << plant;
    EXPECT_GE(added, vectors * kSamples) << plant << ": lower the bound";
  }
}

long iterations = 0;  // NOLINT: MuJoCo's callbacks are plain functions
long rows = 0;        // NOLINT

/// While it exists, adds up the work of MuJoCo's solver in the previous steps.
class SolverWatch {
 public:
  SolverWatch() {
    iterations = 0;
    rows = 0;
    mjcb_control = [](const mjModel* /*model*/, mjData* data) {
      iterations += mj::SolverIterations(*data);
      rows += data->nefc;
    };
  }
  ~SolverWatch() { mjcb_control = nullptr; }
  SolverWatch(const SolverWatch&) = delete;
  SolverWatch& operator=(const SolverWatch&) = delete;
};

TEST(Solver, HasNothingToDoOnMagicFormulaTyres) {
  for (const std::string model : {"prius", "bmw320i"}) {
    Slalom slalom(model, "mujoco:magic_formula");
    const SolverWatch watch;
    slalom.Steps(500);
    EXPECT_EQ(rows, 0) << model;
    EXPECT_EQ(iterations, 0) << model;
  }
}

TEST(Solver, IteratesAFewTimesOnContacts) {
  Slalom slalom("bmw320i", "mujoco:contact");
  slalom.Steps(100);
  const SolverWatch watch;
  slalom.Steps(500);
  // The solver has three rows for each of four tyres, and one for the dry friction of each of four
  // wheels. The iterations may differ from the counted number by an eighth, because rounding
  // decides when the solver stops.
  EXPECT_NEAR(static_cast<double>(rows), 500 * 16, 500);
  const int counted = mjVERSION_HEADER >= 300 ? 1315 : 1585;
  EXPECT_NEAR(static_cast<double>(iterations), counted, counted / 8);
}

TEST(CollisionChecks, OfMotionsAmongBoxes) {
  FrenetRequest request = OnPath(5.0);
  request.start.d = 0.2;
  request.road = {4.0, 4.0};
  request.obstacles = {BoxAt(BentRoad(), 25.0, 0.3), BoxAt(BentRoad(), 40.0, -3.0),
                       BoxAt(BentRoad(), 50.0, 2.0)};
  request.obstacles.back().velocity = {-0.5, 0.2};
  const FrenetPlan motion = PlanFrenet(BentRoad(), request, {});
  const FrenetPlan lattice = PlanLattice(BentRoad(), request, {});
  ASSERT_TRUE(motion.ok() && lattice.ok());
  // The planner checks its candidates in the order of their costs, until one is free of collisions.
  EXPECT_NEAR(motion.checked, 173, 173 / 8);
  EXPECT_NEAR(lattice.checked, 761, 761 / 8);
}

}  // namespace
}  // namespace trackbed
