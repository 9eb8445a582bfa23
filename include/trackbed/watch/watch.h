#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trackbed/analysis/output_folder.h"
#include "trackbed/analysis/run.h"

/// Serves reports to a browser on this machine, even during a run.
namespace trackbed {

/// The address of a page, and the initial state of its run.
struct WatchOptions {
  /// IP address to listen at; 0.0.0.0 and :: listen at all addresses.
  std::string host = "127.0.0.1";
  int port = 0;  ///< Port, 0 to 65535; 0 selects any free port.
  /// Ratio of simulated to wall-clock time, 0.01 to 1000. Infinity: as fast as possible.
  double speed = 1.0;
  bool paused = false;  ///< Whether the run starts paused, until a page resumes it.
};

/// Callbacks, which run in the caller's thread. Each callback may be empty.
struct WatchHooks {
  std::function<void(const std::string& url)> serving{};  ///< Called when `url` can be opened.
  /// Whether to stop the server; called several times a second.
  std::function<bool()> interrupted{};
  /// Called after the run has ended and its folder has been written.
  std::function<void(const RunResult& result)> finished{};
};

/// Parses a speed as given on the command line or by a page: a number from 0.01 to 1000, or "max",
/// which is infinity. Nullopt for other texts.
std::optional<double> ParseSpeed(std::string_view text);

/// Runs a scenario as RunMission, with all plants together on one clock, and serves its page during
/// the run. Map, replay and charts grow with the logs. Buttons pause the run, advance it by one
/// control period, and set its speed. Any number of pages can show and control the run. After the
/// run, the run folder is written, and the page becomes the report of that folder. The page is
/// served until the caller interrupts. If the mission has no plan, the page shows the report
/// immediately.
///
/// Guarantees: the files of the run folder, except timing.json, have the bytes that RunMission and
/// WriteRunFolder produce. Other machines are served only if `host` allows it. Pages of other sites
/// in a browser on this machine are never served (src/watch/server.h has the limits). There is no
/// encryption and no password: anybody who can reach the address can see and control the run.
/// Errors: InputError for an address or a scenario that cannot be used. RunError if the port is in
/// use or the folder cannot be written. Exceptions of the hooks are rethrown. Cost: that of
/// RunMission, and memory for the rows as text, about 0.3 kB per control period.
RunResult WatchRun(const Scenario& scenario, const CarModel& car, const OutputFolder& folder,
                   const WatchOptions& options, const WatchHooks& hooks);

/// Serves the page that WriteReport would write for the present content of `paths`, including its
/// films. The options `speed` and `paused` are ignored. Throws the errors of WriteReport, and those
/// of WatchRun for address and port.
void WatchReport(const std::vector<std::filesystem::path>& paths, const WatchOptions& options,
                 const WatchHooks& hooks);

}  // namespace trackbed
