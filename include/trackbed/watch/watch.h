#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trackbed/analysis/output_folder.h"
#include "trackbed/analysis/run.h"

/// Reports served to a browser on this machine, also while their run goes on.
namespace trackbed {

/// Where a page is served, and how its run begins.
struct WatchOptions {
  std::string host = "127.0.0.1";  ///< IP address to listen at; 0.0.0.0 and :: are all of them
  int port = 0;                    ///< 0 to 65535; 0 is any free one
  /// Simulated over wall time, 0.01 to 1000, or infinity: as fast as possible.
  double speed = 1.0;
  bool paused = false;  ///< until a page resumes it
};

/// Callbacks, in the caller's thread. Each may be empty.
struct WatchHooks {
  std::function<void(const std::string& url)> serving{};  ///< called when `url` can be opened
  std::function<bool()> interrupted{};  ///< asked some times a second; true ends the serving
  /// Called when the run has ended and its folder is written.
  std::function<void(const RunResult& result)> finished{};
};

/// A speed as the command line and a page give it: a number from 0.01 to 1000, or "max", which is
/// infinity. None for anything else.
std::optional<double> ParseSpeed(std::string_view text);

/// Runs a scenario as RunMission, with all plants together on one clock, and serves its page
/// meanwhile: map, replay and charts grow with the logs, and buttons pause the run, let it go on
/// for one control period, and set its speed. Any number of pages see and control the one run. When
/// it has ended the run folder is written, and the page is the report of that folder, which is
/// served until the caller interrupts. A mission without a plan has its report at once.
///
/// Guarantees: the files of the run folder but timing.json have the bytes that RunMission and
/// WriteRunFolder give them. Nothing is served to other machines unless `host` says so, nor to
/// pages of other sites in a browser of this one (src/watch/server.h has the bounds).
/// Does not: encrypt, or ask for a password: who can reach the address can see and control the run.
/// Errors: InputError for an address or a scenario that cannot be used, RunError when the port is
/// in use or the folder cannot be written, exceptions of the hooks.
/// Cost: of RunMission, and the memory of the rows as text, some 0.3 kB for each control period.
RunResult WatchRun(const Scenario& scenario, const CarModel& car, const OutputFolder& folder,
                   const WatchOptions& options, const WatchHooks& hooks);

/// Serves the page that WriteReport would write of `paths`, as they are now, with its films in it.
/// `speed` and `paused` are not used. Errors: as WriteReport, and for address and port as WatchRun.
void WatchReport(const std::vector<std::filesystem::path>& paths, const WatchOptions& options,
                 const WatchHooks& hooks);

}  // namespace trackbed
