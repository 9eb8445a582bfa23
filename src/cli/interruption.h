#pragma once

#include <atomic>

/// Ends the program on SIGINT (Ctrl-C), SIGTERM and SIGHUP (closed terminal), with exit code 130.
///
/// The first signal sets the variable `interrupted`, which runs, searches and film renderings check
/// before each step. After a signal, runs and searches end at their next step and write the results
/// so far. A process that has not ended after the grace period kGrace removes its temporary files
/// and is terminated. A result that is not complete at the end of the grace period is lost, but no
/// incomplete file remains. A second Ctrl-C ends the program without delay.
namespace trackbed::cli {

/// Whether a signal has asked the program to end. Runs check `interrupted` once per control period.
extern std::atomic<bool> interrupted;

/// Grace period [ms]. If the process still runs at the end of the grace period after a signal, the
/// process is terminated.
inline constexpr int kGrace = 700;

/// Installs the handlers for SIGINT, SIGTERM and SIGHUP. If the program `nohup` made the process
/// ignore SIGHUP, SIGHUP remains ignored.
void EndOnSignals();

/// Object that exists while the result of an interrupted run is being written. The end of the grace
/// period does not terminate the process while a FinishingResult exists, because writing the result
/// of a long run may take longer than the grace period.
class FinishingResult {
 public:
  FinishingResult();
  FinishingResult(FinishingResult&& other) noexcept;
  FinishingResult(const FinishingResult&) = delete;
  FinishingResult& operator=(const FinishingResult&) = delete;
  FinishingResult& operator=(FinishingResult&&) = delete;
  ~FinishingResult();

 private:
  bool counts_ = true;
};

}  // namespace trackbed::cli
