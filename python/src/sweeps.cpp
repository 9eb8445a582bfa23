#include <fmt/format.h>
#include <unistd.h>

#include <condition_variable>
#include <exception>
#include <map>
#include <optional>
#include <thread>
#include <utility>

#include "python/src/bindings.h"
#include "python/src/plugins.h"
#include "trackbed/analysis/metrics.h"
#include "trackbed/analysis/parallel.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/analysis/run_names.h"
#include "trackbed/analysis/sweep.h"
#include "trackbed/analysis/sweep_rows.h"
#include "trackbed/analysis/written_names.h"
#include "trackbed/core/error.h"
#include "trackbed/scenario/scenario_files.h"
#include "trackbed/scenario/study_reader.h"

// Runs studies on separate threads, while Python waits and shows the finished rows. The rows are
// the same as those of RunRows.
namespace trackbed::python {
namespace {

namespace fs = std::filesystem;

/// The state that the threads of a study share with Python.
struct SweepState {
  explicit SweepState(CheckedStudy own) : checked(std::move(own)) {}

  CheckedStudy checked;
  std::optional<OutputFolder> folder{};
  std::optional<SweepRecords> records{};
  std::atomic<bool> stopped{false};

  std::mutex mutex{};  ///< Guards the following members.
  std::condition_variable changed{};
  std::map<std::size_t, std::vector<std::string>> rows{};  ///< Cells of the finished rows.
  std::map<std::size_t, Kept> causes{};                    ///< Exceptions of plug-ins, by row.
  bool finished = false;
  std::exception_ptr error{};
};

/// Runs a row and adds its cells; returns false if the study was stopped.
bool RunRow(SweepState& state, std::size_t row) {
  const Study& study = state.checked.points.study();
  const auto repeat = static_cast<std::size_t>(study.repeat);
  const auto stopped = [&] { return state.stopped.load(); };
  const RunScenarioOnce run = [&](const Scenario& scenario) -> std::optional<RunOutcome> {
    if (stopped()) {
      return std::nullopt;
    }
    try {
      return DriveOnce(state.checked, scenario, stopped);
    } catch (const PluginError& error) {
      const std::lock_guard lock(state.mutex);
      state.causes.emplace(row, error.cause());
      throw;
    }
  };
  const std::optional<SweepRow> made =
      MakeRow(study, run, state.checked.points.Read(row / repeat), row % repeat);
  if (!made) {
    return false;
  }
  state.records->Append(row, ToJson(*made));
  const std::lock_guard lock(state.mutex);
  state.rows[row] = made->cells;
  state.changed.notify_all();
  return true;
}

/// Runs the missing rows. `running` ends before `finished` is set, so that Python code can register
/// plug-ins as soon as the study has finished.
void RunAll(SweepState& state, int jobs, std::unique_ptr<RunningFunction> running) {
  std::vector<std::size_t> missing;
  for (std::size_t row = 0; row < state.records->rows(); ++row) {
    if (!state.records->Has(row)) {
      missing.push_back(row);
    }
  }
  std::exception_ptr error;
  try {
    ForEachIndex(missing.size(), jobs, [&](std::size_t i) { return RunRow(state, missing[i]); });
    if (state.folder) {
      WriteSweep(*state.records, {}, *state.folder);
    }
  } catch (...) {
    error = std::current_exception();
  }
  state.folder.reset();
  running.reset();
  const std::lock_guard lock(state.mutex);
  state.error = error;
  state.finished = true;
  state.changed.notify_all();
}

/// A study that runs in the background.
class SweepJob {
 public:
  SweepJob(CheckedStudy checked, const std::optional<fs::path>& out, bool restart)
      : state_(std::make_shared<SweepState>(std::move(checked))) {
    const auto header = SweepHeader(state_->checked.points, state_->checked.inputs);
    if (!out) {
      state_->records = SweepRecords::InMemory(header);
      return;
    }
    state_->folder.emplace(*out, FileNamesOfVerb("sweep"));
    const fs::path file = *out / run_folder::kSweepRecords;
    if (restart) {
      SweepRecords::Remove(file);
    }
    state_->records.emplace(file, header, "restart=True removes them, another out keeps them");
    for (std::size_t row = 0; row < state_->records->rows(); ++row) {
      if (state_->records->Has(row)) {
        state_->rows[row] = ReadRow(*state_->records, row).cells;
      }
    }
  }

  SweepJob(const SweepJob&) = delete;
  SweepJob& operator=(const SweepJob&) = delete;
  /// Stops the study, and waits until its threads have ended. A plug-in that does not return is
  /// left behind after ten seconds.
  ~SweepJob() {
    if (started_by_ == getpid()) {  // A forked process does not have the threads.
      Stop();
      const WithoutGil release;
      std::unique_lock lock(state_->mutex);
      state_->changed.wait_for(lock, std::chrono::seconds(10), [&] { return state_->finished; });
    }
  }

  void Start(int jobs) {
    auto running = std::make_unique<RunningFunction>();
    std::thread([state = state_, jobs, running = std::move(running)]() mutable {
      RunAll(*state, jobs, std::move(running));
    }).detach();
    started_by_ = getpid();
  }

  void Stop() { state_->stopped = true; }

  /// Waits until the study has finished, at most `seconds`, and returns whether it has. Throws the
  /// error that ended the study.
  bool Wait(double seconds) {
    std::exception_ptr error;
    bool finished = false;
    {
      const WithoutGil release;
      std::unique_lock lock(state_->mutex);
      finished = state_->changed.wait_for(lock, std::chrono::duration<double>(seconds),
                                          [&] { return state_->finished; });
      error = std::exchange(state_->error, nullptr);
    }
    if (error) {
      std::rethrow_exception(error);
    }
    return finished;
  }

  [[nodiscard]] std::map<std::size_t, std::vector<std::string>> Rows() const {
    const std::lock_guard lock(state_->mutex);
    return state_->rows;
  }

  [[nodiscard]] std::size_t count() const {
    const std::lock_guard lock(state_->mutex);
    return state_->rows.size();
  }

  [[nodiscard]] py::dict Causes() const {
    std::map<std::size_t, Kept> causes;
    {
      const std::lock_guard lock(state_->mutex);
      causes = state_->causes;
    }
    py::dict result;
    for (const auto& [row, cause] : causes) {
      if (cause) {
        result[py::int_(row)] = cause.object();
      }
    }
    return result;
  }

  [[nodiscard]] const SweepState& state() const { return *state_; }

 private:
  std::shared_ptr<SweepState> state_;
  pid_t started_by_ = 0;
};

std::shared_ptr<SweepJob> MakeJob(const fs::path& file, const std::vector<std::string>& overrides,
                                  const std::optional<fs::path>& out, bool restart) {
  const WithoutGil release;
  CheckedStudy checked = CheckStudy(ReadStudy(FindScenario(file), overrides, PossibleMetrics),
                                    /*all=*/false);
  return std::make_shared<SweepJob>(std::move(checked), out, restart);
}

}  // namespace

void BindSweeps(py::module_& module) {
  py::class_<SweepJob, std::shared_ptr<SweepJob>>(module, "SweepJob")
      .def("start", &SweepJob::Start)
      .def("stop", &SweepJob::Stop)
      .def("wait", &SweepJob::Wait)
      .def_property_readonly("rows", &SweepJob::Rows)
      .def_property_readonly("count", &SweepJob::count)
      .def_property_readonly("causes", &SweepJob::Causes)
      .def_property_readonly(
          "name", [](const SweepJob& job) { return job.state().checked.points.study().name; })
      .def_property_readonly("columns",
                             [](const SweepJob& job) { return job.state().records->Columns(); })
      .def_property_readonly("rows_expected",
                             [](const SweepJob& job) { return job.state().records->rows(); });
  module.def("sweep", &MakeJob);
}

}  // namespace trackbed::python
