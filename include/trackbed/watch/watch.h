#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trackbed/analysis/output_folder.h"
#include "trackbed/analysis/run.h"

/// Serves reports to a browser over HTTP, even while a run is in progress.
namespace trackbed {

/// The address of the server, and the initial state of the run.
struct WatchOptions {
  /// IP address at which the server listens; 0.0.0.0 and :: mean all addresses.
  std::string host = "127.0.0.1";
  int port = 0;  ///< Port, 0 to 65535; 0 selects any free port.
  /// Ratio of simulated to wall-clock time, 0.01 to 1000. Infinity: as fast as possible.
  double speed = 1.0;
  bool paused = false;  ///< Whether the run starts paused and waits until a page resumes it.
};

/// Callbacks, which are called in the caller's thread. Each callback may be empty.
struct WatchHooks {
  std::function<void(const std::string& url)> serving{};  ///< Called when the server can be reached
                                                          ///< at `url`.
  /// Returns whether to stop the server; called several times per second.
  std::function<bool()> interrupted{};
  /// Called after the run has ended and its folder has been written.
  std::function<void(const RunResult& result)> finished{};
};

/// Parses a speed from the command line or a page: a number from 0.01 to 1000, or "max", which
/// means infinity. Returns nullopt for other texts.
std::optional<double> ParseSpeed(std::string_view text);

/// Runs a scenario like RunScenario, but with all plants synchronized by one clock, and serves a
/// page of the run. During the run, the map, the replay and the charts on the page grow. Buttons
/// pause the run, advance it by one control period, and set its speed. Any number of pages can show
/// and control the run. After the run, the run folder is written, and the page becomes the report
/// of that folder. The page is served until WatchHooks::interrupted returns true. If no plan was
/// found, the page shows the report immediately.
///
/// Guarantees: the files of the run folder, except timing.json, are byte for byte those of
/// RunScenario and WriteRunFolder. Other machines can connect only if WatchOptions::host allows it.
/// Pages of other web sites, opened in a browser on this machine, can never read or control the run
/// (src/watch/server.h lists the limits). There is no encryption and no password: anybody who can
/// reach the address can see and control the run. Errors: InputError for an invalid address or
/// scenario. RunError if the port is in use or the folder cannot be written. Exceptions of the
/// hooks are rethrown. The cost is that of RunScenario, plus memory for the rows as text, about 0.3
/// kB per control period.
RunResult WatchRun(const Scenario& scenario, const CarModel& car, const OutputFolder& folder,
                   const WatchOptions& options, const WatchHooks& hooks);

/// Serves the page that WriteReport would write for the present content of `paths`, with embedded
/// films. The options `speed` and `paused` are ignored. Throws the errors of WriteReport, and the
/// errors of WatchRun for address and port.
void WatchReport(const std::vector<std::filesystem::path>& paths, const WatchOptions& options,
                 const WatchHooks& hooks);

}  // namespace trackbed
