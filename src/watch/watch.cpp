#include "trackbed/watch/watch.h"

#include <fmt/format.h>

#include <atomic>
#include <charconv>
#include <future>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <utility>

#include "src/watch/live_run.h"
#include "src/watch/server.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/file.h"
#include "trackbed/report/report.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// Returns a random id that distinguishes this run from other runs served on the same port.
std::string NewId() {
  std::random_device random;
  return fmt::format("{:08x}{:08x}", random(), random());
}

/// Returns the report data at the beginning of the run, with the first row of each plant's log. The
/// function ReportData needs a run folder, so a temporary run folder is written, hidden inside the
/// output folder.
ordered_json DataAtBegin(const RunResult& planned, const CarModel& car, const fs::path& folder) {
  const RunResult begun = SimulateRun(
      planned, car,
      {.drive = [](const std::string&) { return DriveHooks{.interrupted = [] { return true; }}; },
       .together = true});
  const TemporaryFolder hidden(folder / run_folder::kReport);
  const fs::path own = hidden.path() / fs::weakly_canonical(folder).filename();
  WriteRunFolder(begun, own);
  return ReportData({own});
}

std::string PageOf(const std::vector<fs::path>& paths) {
  // The server serves only the page and no other files, so videos are embedded in the page.
  return ReportPageOf(paths, paths.front() / run_folder::kReport, FilmPlace::kEmbedded);
}

void Serve(Server& server, const WatchHooks& hooks, const std::atomic<bool>& failed) {
  if (hooks.serving) {
    hooks.serving(server.url());
  }
  server.Run([&] { return failed || (hooks.interrupted && hooks.interrupted()); });
}

/// Passes the end of a run from the simulation thread to the server's thread.
class RunFinisher {
 public:
  RunFinisher(const OutputFolder& folder, Server& server, const WatchHooks& hooks)
      : folder_(folder), server_(server), hooks_(hooks) {}

  /// Writes the run folder, and serves its report unless the run was interrupted.
  void Report(const RunResult& result, LiveRun* live) {
    WriteRunFolder(result, folder_);
    if (result.interrupted) {
      return;
    }
    server_.Post([this, &result, live, page = PageOf({folder_.path()})] {
      server_.Show(page, live);
      if (live != nullptr) {
        live->Finish();
      }
      NotifyFinished(result);
    });
  }

  /// Calls the hook `finished` unless it was already called.
  void NotifyFinished(const RunResult& result) {
    if (!std::exchange(notified_, true) && hooks_.finished) {
      hooks_.finished(result);
    }
  }

 private:
  const OutputFolder& folder_;
  Server& server_;
  const WatchHooks& hooks_;
  bool notified_ = false;  // whether the hook `finished` was called; used only in the server's
                           // thread
};

}  // namespace

std::optional<double> ParseSpeed(std::string_view text) {
  if (text == "max") {
    return std::numeric_limits<double>::infinity();
  }
  double speed = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), speed);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  return whole && speed >= kMinPlaybackSpeed && speed <= kMaxPlaybackSpeed ? std::optional(speed)
                                                                           : std::nullopt;
}

RunResult WatchRun(const Scenario& scenario, const CarModel& car, const OutputFolder& folder,
                   const WatchOptions& options, const WatchHooks& hooks) {
  Server server(options.host, options.port);
  RunResult result = PlanRun(scenario, car);
  RunFinisher finisher(folder, server, hooks);
  std::atomic<bool> failed{false};
  if (!result.plan.ok()) {
    finisher.Report(result, nullptr);
    Serve(server, hooks, failed);
    finisher.NotifyFinished(result);
    return result;
  }
  const ordered_json first = DataAtBegin(result, car, folder.path());
  const std::string id = NewId();
  LiveRun live(first, id, scenario.drive.control_period, options.speed, options.paused);
  server.Show(LivePage(first, id), &live);
  std::future<void> driven = std::async(std::launch::async, [&] {
    try {
      result = SimulateRun(std::move(result), car,
                           {.drive = [&](const std::string& plant) { return live.HooksOf(plant); },
                            .ended = [&](const std::string& plant) { live.EndOf(plant); },
                            .together = true});
      finisher.Report(result, &live);
    } catch (...) {
      failed = true;
      throw;
    }
  });
  try {
    Serve(server, hooks, failed);
  } catch (...) {
    live.Interrupt();  // without this interruption, the destructor of `driven` would wait for the
                       // end of the run
    throw;
  }
  live.Interrupt();
  driven.get();
  // calls the hook `finished` if the server stopped before the end of the run was reported
  finisher.NotifyFinished(result);
  return result;
}

void WatchReport(const std::vector<fs::path>& paths, const WatchOptions& options,
                 const WatchHooks& hooks) {
  Server server(options.host, options.port);
  server.Show(PageOf(paths), nullptr);
  Serve(server, hooks, false);
}

}  // namespace trackbed
