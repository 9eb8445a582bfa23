#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <atomic>
#include <string>

#include "bench/in_turn.h"
#include "bench/temp_folder.h"
#include "trackbed/analysis/sweep.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/scenario/study_reader.h"

namespace trackbed::bench {
namespace {

/// A study of three turns on MuJoCo with sampled speeds.
CheckedStudy SpeedStudy(const TempFolder& folder, int rows, double time_limit) {
  const std::filesystem::path file = folder.path() / "study.yaml";
  WriteFileAtomically(
      file,
      fmt::format("schema: 1\nname: study\nscenario: {}\n"
                  "set: {{drive.plants: [mujoco], drive.time_limit: {}, expect: {{}}}}\n"
                  "sample: {{count: {}, method: sobol}}\n"
                  "vary: {{mission.speed: {{distribution: uniform, from: 2, to: 4}}}}\n"
                  "outputs: [metrics.mujoco.distance]\n",
                  (DataFolder() / "scenarios" / "three_turns.yaml").string(), time_limit, rows));
  return CheckStudy(ReadStudy(file));
}

/// Executes all rows; returns the elapsed time [s] and adds the time of plants and planners to
/// `working`.
double RunAll(const CheckedStudy& study, const TempFolder& folder, int jobs,
              std::atomic<double>* working = nullptr) {
  const std::filesystem::path file = folder.path() / "sweep.records";
  std::filesystem::remove(file);
  SweepRecords records(file, SweepHeader(study.points, study.inputs));
  SweepOptions options{.jobs = jobs};
  options.finished = [&](std::size_t /*row*/, const RunOutcome& outcome) {
    if (working != nullptr) {
      working->fetch_add(outcome.result->planning_time + outcome.result->timing.front().wall_time);
    }
  };
  const Stopwatch stopwatch;
  RunRows(
      study.points, [&](const Scenario& scenario) { return DriveOnce(study, scenario); }, records,
      options);
  return stopwatch.Seconds();
}

/// Goal: on two processors, a study on two threads takes at most 1 / 1.9 of its time on one.
void TwoWorkers(benchmark::State& state) {
  const TempFolder folder;
  const CheckedStudy study = SpeedStudy(folder, 500, 120.0);
  CompareInTurn(
      state, 1.0 / 1.9, [&] { return RunAll(study, folder, 2); },
      [&] { return RunAll(study, folder, 1); });
}

/// Times the overhead of a row beyond planning and simulation, with runs of one physics step.
void RowsOfAStudy(benchmark::State& state) {
  constexpr int kRows = 1000;
  const TempFolder folder;
  const CheckedStudy study = SpeedStudy(folder, kRows, 0.002);
  double besides = 0.0;
  for ([[maybe_unused]] auto round : state) {
    std::atomic<double> working = 0.0;
    const double all = RunAll(study, folder, 1, &working);
    besides += (all - working) / kRows;
  }
  state.counters["besides_ms"] = 1e3 * besides / static_cast<double>(state.iterations());
}

[[maybe_unused]] const bool sweep_registered = [] {
  RegisterGuarded("Study/two_workers", TwoWorkers)
      ->UseManualTime()
      ->Iterations(1)
      ->Unit(benchmark::kSecond);
  RegisterGuarded("Study/rows", RowsOfAStudy)->Iterations(1)->Unit(benchmark::kSecond);
  return true;
}();

}  // namespace
}  // namespace trackbed::bench
