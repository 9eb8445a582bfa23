#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trackbed/analysis/output_folder.h"
#include "trackbed/analysis/run.h"

/// Serves the reports of runs to a browser over HTTP, even while a run is still in progress.
namespace trackbed {

/// Options of WatchRun and WatchReport: the address of the server, and the initial speed and state
/// of the run.
struct WatchOptions {
  /// IP address at which the server listens; 0.0.0.0 and :: mean all addresses.
  std::string host = "127.0.0.1";
  int port = 0;  ///< Port at which the server listens, 0 to 65535; 0 selects any free port.
  /// Speed of the simulation: ratio of simulated to wall-clock time, 0.01 to 1000, or infinity to
  /// run as fast as possible.
  double speed = 1.0;
  /// Whether the run starts paused and waits until the user resumes the run on a page.
  bool paused = false;
};

/// Callbacks of WatchRun, which WatchRun calls in the thread of its caller. Each callback may be an
/// empty std::function.
struct WatchHooks {
  /// Called as soon as browsers can reach the server at `url`.
  std::function<void(const std::string& url)> serving{};
  /// Returns true to stop the server; called several times per second.
  std::function<bool()> interrupted{};
  /// Called after the run has ended and the run folder has been written.
  std::function<void(const RunResult& result)> finished{};
};

/// Parses a speed from the command line or a page: a number from 0.01 to 1000, or "max", which
/// means infinity. Returns nullopt if the text is neither such a number nor "max".
std::optional<double> ParseSpeed(std::string_view text);

/// Runs a scenario like RunScenario, but with all plants synchronized by one clock, and serves a
/// page of the run. During the run, new data are added to the map, the replay and the charts on the
/// page. With buttons on the page, the user can pause the run, advance the run by one control
/// period, and set the speed of the simulation. Any number of pages can show and control the same
/// run. After the run has ended, WatchRun writes the run folder, and the page becomes the report of
/// this folder. The server runs until WatchHooks::interrupted returns true. If the planner finds no
/// plan, the page shows the report immediately.
///
/// Guarantees: the files in the run folder, except timing.json, are byte for byte equal to the
/// files that RunScenario and WriteRunFolder produce. Other machines can connect only if
/// WatchOptions::host allows it. Web pages from other servers that are open in a browser on the
/// same machine cannot read or control the run (src/watch/server.h explains the limits of this
/// protection). The server has no encryption and no password: anybody who can reach the address can
/// see and control the run. Throws InputError if the address or the scenario is invalid. Throws
/// RunError if the port is in use or the run folder cannot be written. WatchRun rethrows exceptions
/// of the hooks. WatchRun needs the computing time and memory of RunScenario, plus about 0.3 kB of
/// memory per control period for the log as text.
RunResult WatchRun(const Scenario& scenario, const CarModel& car, const OutputFolder& folder,
                   const WatchOptions& options, const WatchHooks& hooks);

/// Serves the report page of `paths`, with embedded videos; the page is equal to the page that
/// WriteReport would write for the present content of `paths`. WatchReport ignores the options
/// `speed` and `paused`. WatchReport throws the same errors as WriteReport. For an invalid address
/// or a port in use, WatchReport throws the same errors as WatchRun.
void WatchReport(const std::vector<std::filesystem::path>& paths, const WatchOptions& options,
                 const WatchHooks& hooks);

}  // namespace trackbed
