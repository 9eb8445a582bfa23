#include "trackbed/watch/watch.h"

#include <fmt/format.h>

#include <atomic>
#include <future>
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

/// What tells this run from others that were or will be served on the same port.
std::string NewId() {
  std::random_device random;
  return fmt::format("{:08x}{:08x}", random(), random());
}

/// ReportData of the run as it begins: with the first row of each plant's log. It is read from a
/// run folder, as every report is; that lies hidden in the one that the run will be written to.
ordered_json DataAtBegin(const RunResult& planned, const CarModel& car, const fs::path& folder) {
  const RunResult begun = DriveRun(
      planned, car,
      {.drive = [](const std::string&) { return DriveHooks{.interrupted = [] { return true; }}; },
       .together = true});
  const TemporaryFolder hidden(folder / run_folder::kReport);
  const fs::path own = hidden.path() / fs::weakly_canonical(folder).filename();
  WriteRunFolder(begun, own);
  return ReportData({own});
}

std::string PageOf(const std::vector<fs::path>& paths) {
  // Films that lie beside the page could not be loaded: they are in it.
  return ReportPageOf(paths, paths.front() / run_folder::kReport, FilmPlace::kEmbedded);
}

void Serve(Server& server, const WatchHooks& hooks, const std::atomic<bool>& failed) {
  if (hooks.serving) {
    hooks.serving(server.url());
  }
  server.Run([&] { return failed || (hooks.interrupted && hooks.interrupted()); });
}

/// A run that ends in the thread of its plants, and is told of in the server's.
class Ending {
 public:
  Ending(const OutputFolder& folder, Server& server, const WatchHooks& hooks)
      : folder_(folder), server_(server), hooks_(hooks) {}

  /// Writes the folder, and has its page shown, unless the server ends as the run did.
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
      Tell(result);
    });
  }

  /// Calls `finished`, unless it has been.
  void Tell(const RunResult& result) {
    if (!std::exchange(told_, true) && hooks_.finished) {
      hooks_.finished(result);
    }
  }

 private:
  const OutputFolder& folder_;
  Server& server_;
  const WatchHooks& hooks_;
  bool told_ = false;  // in the server's thread
};

}  // namespace

RunResult WatchRun(const Scenario& scenario, const CarModel& car, const OutputFolder& folder,
                   const WatchOptions& options, const WatchHooks& hooks) {
  Server server(options.host, options.port);
  RunResult result = PlanRun(scenario, car);
  Ending ending(folder, server, hooks);
  std::atomic<bool> failed{false};
  if (!result.plan.ok()) {
    ending.Report(result, nullptr);
    Serve(server, hooks, failed);
    ending.Tell(result);
    return result;
  }
  const ordered_json first = DataAtBegin(result, car, folder.path());
  const std::string id = NewId();
  LiveRun live(first, id, scenario.drive.control_period, options.speed, options.paused);
  server.Show(LivePage(first, id), &live);
  std::future<void> driven = std::async(std::launch::async, [&] {
    try {
      result = DriveRun(std::move(result), car,
                        {.drive = [&](const std::string& plant) { return live.HooksOf(plant); },
                         .ended = [&](const std::string& plant) { live.EndOf(plant); },
                         .together = true});
      ending.Report(result, &live);
    } catch (...) {
      failed = true;
      throw;
    }
  });
  try {
    Serve(server, hooks, failed);
  } catch (...) {
    live.Interrupt();  // or `driven` waits for the end of the run
    throw;
  }
  live.Interrupt();
  driven.get();
  ending.Tell(result);  // if it has ended as the server did
  return result;
}

void WatchReport(const std::vector<fs::path>& paths, const WatchOptions& options,
                 const WatchHooks& hooks) {
  Server server(options.host, options.port);
  server.Show(PageOf(paths), nullptr);
  Serve(server, hooks, false);
}

}  // namespace trackbed
