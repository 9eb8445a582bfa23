#include <benchmark/benchmark.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/in_turn.h"
#include "bench/temp_folder.h"
#include "trackbed/control/controllers.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/drive/drive.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/sim/mujoco_error.h"
#include "trackbed/sim/mujoco_handles.h"
#include "trackbed/sim/plant.h"

namespace trackbed::bench {
namespace {

/// The inputs of MuJoCo in a run: the state at the start and, per physics step, all values that the
/// plant sets or adds.
struct Feed {
  MujocoModel model;  // the model of the run, with the road's friction
  std::vector<mjtNum> start_act;
  std::vector<mjtNum> qpos;  // with quaternions normalized by MuJoCo; begins with the start
  std::vector<mjtNum> qvel;
  std::vector<mjtNum> controls;
  std::vector<mjtNum> friction;  // friction of the joints, by which the plant brakes
  std::vector<mjtNum> linkage;   // the equality constraints of the steering
  std::vector<mjtNum> applied;   // forces of the air and of tyres

  [[nodiscard]] std::size_t steps() const {
    return applied.size() / static_cast<std::size_t>(model->nv);
  }
};

void Append(std::vector<mjtNum>& all, const mjtNum* numbers, std::int64_t count) {
  all.insert(all.end(), numbers, numbers + count);
}

/// Records the inputs of MuJoCo in MuJoCo's control callback. MuJoCo calls it once when a plant is
/// made, and once per step after the plant has set its controls. The plant applies forces after the
/// callback, so the next call records them, and the forces of the last step are missing.
class Listener {
 public:
  explicit Listener(Feed& feed) {
    feed_ = &feed;
    mjcb_control = [](const mjModel* model, mjData* data) { Hear(*model, *data); };
  }
  ~Listener() { mjcb_control = nullptr; }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

 private:
  static void Hear(const mjModel& model, const mjData& data) {
    Feed& feed = *feed_;
    Append(feed.qpos, data.qpos, model.nq);
    Append(feed.qvel, data.qvel, model.nv);
    if (!feed.model) {
      feed.model = CopyMujocoModel(model);
      feed.start_act.assign(data.act, data.act + model.na);
      return;
    }
    if (!feed.controls.empty()) {
      Append(feed.applied, data.qfrc_applied, model.nv);
    }
    Append(feed.controls, data.ctrl, model.nu);
    Append(feed.friction, model.dof_frictionloss, model.nv);
    Append(feed.linkage, model.eq_data, mjNEQDATA * model.neq);
  }

  static inline Feed* feed_ = nullptr;  // the callback is a plain function
};

/// A scenario with its car and plan, for runs on MuJoCo.
struct Drive {
  explicit Drive(const std::string& name)
      : scenario(ReadScenario(DataFolder() / "scenarios" / (name + ".yaml"))),
        car(LoadCar(scenario)),
        plan(PlanScenario(scenario, car.params())) {}

  [[nodiscard]] std::unique_ptr<Plant> MakePlant() const {
    return trackbed::MakePlant("mujoco", {.car = car,
                                          .world = scenario.world,
                                          .start = InitialState(scenario),
                                          .tyre = scenario.vehicle.tyre,
                                          .steering = scenario.drive.steering});
  }
  [[nodiscard]] RunLog Run(Plant& plant) const {
    const auto controller = MakeSteeringController(scenario.control.steering);
    return SimulateClosedLoop(plant, *controller, plan, MakeLoopConfig(scenario, car));
  }

  Scenario scenario;
  CarModel car;
  FeasiblePlan plan;
};

/// Records the commands of another plant.
class NotingPlant final : public Plant {
 public:
  explicit NotingPlant(Plant& plant) : plant_(plant) {}

  [[nodiscard]] const std::vector<Command>& commands() const { return commands_; }

  void Step(const Command& command) override {
    commands_.push_back(command);
    plant_.Step(command);
  }
  void ApplyLateralOffset(double left) override { plant_.ApplyLateralOffset(left); }
  void ApplyLateralForce(double force) override { plant_.ApplyLateralForce(force); }
  [[nodiscard]] VehicleState Observe() const override { return plant_.Observe(); }
  [[nodiscard]] Pose2 pose() const override { return plant_.pose(); }
  [[nodiscard]] double obstacle_force() const override { return plant_.obstacle_force(); }
  [[nodiscard]] std::vector<double> Configuration() const override {
    return plant_.Configuration();
  }
  [[nodiscard]] bool diverged() const override { return plant_.diverged(); }

 private:
  Plant& plant_;
  std::vector<Command> commands_;
};

void StepAlong(Plant& plant, const std::vector<Command>& commands) {
  for (const Command& command : commands) {
    plant.Step(command);
  }
}

/// Returns the commands of a run. Checks that the commands alone lead to the same final
/// configuration.
std::vector<Command> CommandsOf(const Drive& drive) {
  const auto driven = drive.MakePlant();
  NotingPlant noting(*driven);
  static_cast<void>(drive.Run(noting));
  const auto stepped = drive.MakePlant();
  StepAlong(*stepped, noting.commands());
  TRACKBED_CHECK(stepped->Configuration() == driven->Configuration(),
                 "the plant's steps alone differ from the run");
  return noting.commands();
}

/// Runs a bare mj_step loop with the recorded inputs. Between steps, the plant sets joints such as
/// the angles of the steered wheels. This loop therefore also sets all joints except those of the
/// chassis.
double StepBare(const Feed& feed, const CarModel& car) {
  const MujocoErrorScope errors;
  const MujocoModel model = CopyMujocoModel(*feed.model);
  const MujocoData data = MakeMujocoData(*model);
  const int chassis_end = car.chassis().chassis_qpos + 7;
  TRACKBED_CHECK(car.chassis().chassis_qpos == 0, "the chassis is not the first body");
  const auto row = [](const std::vector<mjtNum>& all, std::size_t step, std::int64_t count) {
    return all.data() + step * static_cast<std::size_t>(count);
  };
  const Stopwatch stopwatch;
  std::copy_n(feed.qpos.data(), model->nq, data->qpos);
  std::copy_n(feed.qvel.data(), model->nv, data->qvel);
  std::copy_n(feed.start_act.data(), model->na, data->act);
  mj_forward(model.get(), data.get());
  for (std::size_t step = 0; step < feed.steps(); ++step) {
    std::copy(row(feed.qpos, step + 1, model->nq) + chassis_end,
              row(feed.qpos, step + 2, model->nq), data->qpos + chassis_end);
    std::copy_n(row(feed.qvel, step + 1, model->nv), model->nv, data->qvel);
    std::copy_n(row(feed.controls, step, model->nu), model->nu, data->ctrl);
    std::copy_n(row(feed.applied, step, model->nv), model->nv, data->qfrc_applied);
    std::copy_n(row(feed.friction, step, model->nv), model->nv, model->dof_frictionloss);
    std::copy_n(row(feed.linkage, step, mjNEQDATA * model->neq), mjNEQDATA * model->neq,
                model->eq_data);
    mj_step(model.get(), data.get());
  }
  return stopwatch.Seconds();
}

/// Compares the closed loop with the preview controller, logged and written like a run, with the
/// plant's steps alone.
void ClosedLoop(benchmark::State& state, const std::string& scenario) {
  const Drive drive(scenario);
  const TempFolder folder;
  const std::vector<Command> commands = CommandsOf(drive);
  const double median = CompareInTurn(
      state, 1.10,
      [&] {
        const Stopwatch stopwatch;
        const RunLog log = drive.Run(*drive.MakePlant());
        WriteFileAtomically(folder.path() / "mujoco.csv", ToTable(log).ToCsv());
        WriteFileAtomically(folder.path() / "mujoco.state.csv", log.configurations.ToCsv());
        return stopwatch.Seconds();
      },
      [&] {
        const Stopwatch stopwatch;
        StepAlong(*drive.MakePlant(), commands);
        return stopwatch.Seconds();
      });
  state.counters["real_time_factor"] =
      static_cast<double>(commands.size()) * drive.car.timestep() / median;
}

/// Compares the plant's steps with MuJoCo's steps of the same model under the same forces.
void PlantSteps(benchmark::State& state, const std::string& scenario) {
  const Drive drive(scenario);
  const std::vector<Command> commands = CommandsOf(drive);
  Feed feed;
  {
    const Listener listener(feed);
    StepAlong(*drive.MakePlant(), commands);
  }
  Feed repeated;
  {
    const Listener listener(repeated);
    StepBare(feed, drive.car);
  }
  // The run's last step has no record of its forces: see Listener.
  const std::size_t last = feed.qpos.size() - static_cast<std::size_t>(feed.model->nq);
  TRACKBED_CHECK(repeated.qpos.size() == last &&
                     std::equal(repeated.qpos.begin(), repeated.qpos.end(), feed.qpos.begin()),
                 "MuJoCo's steps alone differ from the plant's");
  const double median = CompareInTurn(
      state, 1.5,
      [&] {
        const Stopwatch stopwatch;
        StepAlong(*drive.MakePlant(), commands);
        return stopwatch.Seconds();
      },
      [&] { return StepBare(feed, drive.car); });
  CountStep(state, median / static_cast<double>(commands.size()), drive.car.timestep());
}

bool RegisterDrives() {
  for (const std::string scenario : {"three_turns", "obstacle_course"}) {
    for (const auto& [name, function] :
         {std::pair{"ClosedLoop/", &ClosedLoop}, std::pair{"PlantSteps/", &PlantSteps}}) {
      RegisterGuarded(name + scenario, function, scenario)
          ->Iterations(7)
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond);
    }
  }
  return true;
}
[[maybe_unused]] const bool drive_registered = RegisterDrives();

}  // namespace
}  // namespace trackbed::bench
