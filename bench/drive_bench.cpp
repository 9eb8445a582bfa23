#include <benchmark/benchmark.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <string>
#include <vector>

#include "bench/in_turn.h"
#include "bench/temp_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/drive/drive.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/sim/mujoco_error.h"
#include "trackbed/sim/mujoco_handles.h"

namespace trackbed::bench {
namespace {

/// What a run feeds to MuJoCo: where it starts and, per physics step, the actuators' controls and
/// the joints' dry friction, which is how the plant brakes.
struct Feed {
  MujocoModel model;  // as driven: with the road's friction
  std::vector<mjtNum> start_qpos;
  std::vector<mjtNum> start_qvel;
  std::vector<mjtNum> start_act;
  std::vector<mjtNum> controls;  // nu per step
  std::vector<mjtNum> friction;  // nv per step
  std::vector<mjtNum> last_qpos;

  [[nodiscard]] std::size_t steps() const {
    return controls.size() / static_cast<std::size_t>(model->nu);
  }
};

/// Listens while MuJoCo computes: its control callback is called once when a plant is made and once
/// per step, when the plant's controls are in place.
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
    if (!feed.model) {
      feed.model = CopyMujocoModel(model);
      feed.start_qpos.assign(data.qpos, data.qpos + model.nq);
      feed.start_qvel.assign(data.qvel, data.qvel + model.nv);
      feed.start_act.assign(data.act, data.act + model.na);
      return;
    }
    feed.controls.insert(feed.controls.end(), data.ctrl, data.ctrl + model.nu);
    feed.friction.insert(feed.friction.end(), model.dof_frictionloss,
                         model.dof_frictionloss + model.nv);
    feed.last_qpos.assign(data.qpos, data.qpos + model.nq);
  }

  static inline Feed* feed_ = nullptr;  // the callback is a plain function
};

/// A car that is to be driven on MuJoCo.
struct Drive {
  explicit Drive(const std::string& name)
      : scenario(ReadScenario(DataFolder() / "scenarios" / (name + ".yaml"))),
        car(LoadCar(scenario)),
        plan(PlanMission(scenario, car.params())) {}

  [[nodiscard]] RunLog Run() const { return DrivePlant(scenario, car, plan, "mujoco"); }

  Scenario scenario;
  CarModel car;
  Plan plan;
};

/// A bare mj_step loop over what was fed.
double StepBare(const Feed& feed) {
  const MujocoErrorScope errors;
  const MujocoModel model = CopyMujocoModel(*feed.model);
  const MujocoData data = MakeMujocoData(*model);
  const Stopwatch stopwatch;
  std::copy(feed.start_qpos.begin(), feed.start_qpos.end(), data->qpos);
  std::copy(feed.start_qvel.begin(), feed.start_qvel.end(), data->qvel);
  std::copy(feed.start_act.begin(), feed.start_act.end(), data->act);
  mj_forward(model.get(), data.get());
  const mjtNum* controls = feed.controls.data();
  const mjtNum* friction = feed.friction.data();
  for (std::size_t step = 0; step < feed.steps(); ++step) {
    std::copy_n(controls, model->nu, data->ctrl);
    std::copy_n(friction, model->nv, model->dof_frictionloss);
    mj_step(model.get(), data.get());
    controls += model->nu;
    friction += model->nv;
  }
  return stopwatch.Seconds();
}

/// The closed loop with preview, logged and written as a run does, against the same steps alone.
void ClosedLoop(benchmark::State& state, const std::string& scenario) {
  const Drive drive(scenario);
  const TempFolder folder;
  Feed feed;
  const RunLog log = [&] {
    const Listener listener(feed);
    return drive.Run();
  }();
  Feed repeated;
  {
    const Listener listener(repeated);
    StepBare(feed);
  }
  TRACKBED_CHECK(repeated.last_qpos == feed.last_qpos, "the bare loop took another way");

  const double median = CompareInTurn(
      state, 1.25,
      [&] {
        const Stopwatch stopwatch;
        const RunLog driven = drive.Run();
        WriteFileAtomically(folder.path() / "mujoco.csv", ToTable(driven).ToCsv());
        WriteFileAtomically(folder.path() / "mujoco.state.csv", driven.configurations.ToCsv());
        return stopwatch.Seconds();
      },
      [&] { return StepBare(feed); });
  state.counters["real_time_factor"] = log.rows.back().state.time / median;
}
BENCHMARK_CAPTURE(ClosedLoop, three_turns, "three_turns")
    ->Iterations(7)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ClosedLoop, obstacle_course, "obstacle_course")
    ->Iterations(7)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace trackbed::bench
