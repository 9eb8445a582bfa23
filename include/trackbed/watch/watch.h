#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trackbed/analysis/output_folder.h"
#include "trackbed/analysis/run.h"

/// Serves reports to a browser on this machine, also during a run.
namespace trackbed {

/// The address of a page, and the initial state of its run.
struct WatchOptions {
  std::string host = "127.0.0.1";  ///< IP address to listen at; 0.0.0.0 and :: mean all addresses
  int port = 0;                    ///< 0 to 65535; 0 means any free port
  /// Simulated over wall-clock time, 0.01 to 1000, or infinity: as fast as possible.
  double speed = 1.0;
  bool paused = false;  ///< starts paused, until a page resumes it
};

/// Callbacks, called in the caller's thread. Each may be empty.
struct WatchHooks {
  std::function<void(const std::string& url)> serving{};  ///< called when `url` can be opened
  std::function<bool()> interrupted{};  ///< polled several times a second; true stops the server
  /// Called after the run has ended and its folder has been written.
  std::function<void(const RunResult& result)> finished{};
};

/// Parses a speed as given on the command line or by a page: a number from 0.01 to 1000, or "max",
/// which is infinity. None for other texts.
std::optional<double> ParseSpeed(std::string_view text);

/// Runs a scenario as RunMission, with all plants together on one clock, and serves its page
/// meanwhile: map, replay and charts grow with the logs, and buttons pause the run, advance it by
/// one control period, and set its speed. Any number of pages can show and control the run. After
/// the run, writes the run folder; the page becomes the report of that folder, and is served until
/// the caller interrupts. A mission without a plan gives its report at once.
///
/// Guarantees: the files of the run folder, except timing.json, have the bytes that RunMission and
/// WriteRunFolder produce. Serves other machines only if `host` allows it, and never pages of other
/// sites in a browser on this machine (src/watch/server.h has the limits).
/// Does not encrypt or ask for a password: anybody who can reach the address can see and control
/// the run.
/// Errors: InputError for an address or a scenario that cannot be used, RunError when the port is
/// in use or the folder cannot be written, exceptions of the hooks.
/// Cost: that of RunMission, and memory for the rows as text, some 0.3 kB per control period.
RunResult WatchRun(const Scenario& scenario, const CarModel& car, const OutputFolder& folder,
                   const WatchOptions& options, const WatchHooks& hooks);

/// Serves the page that WriteReport would write for the present content of `paths`, including its
/// films. Ignores `speed` and `paused`. Errors: as WriteReport, and for address and port as
/// WatchRun.
void WatchReport(const std::vector<std::filesystem::path>& paths, const WatchOptions& options,
                 const WatchHooks& hooks);

}  // namespace trackbed
