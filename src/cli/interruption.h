#pragma once

#include <atomic>

/// Ends the program on SIGINT (Ctrl-C), SIGTERM and SIGHUP (closed terminal), with exit code 130.
///
/// The first signal sets `interrupted`, which runs, searches and films poll. Runs, searches and
/// films then end at their next step and write their results so far. A process that has not ended
/// after the time kGrace is terminated at once. A result that was not committed by then is lost, as
/// after SIGKILL, but no file is half written. A second Ctrl-C ends the program at once.
namespace trackbed::cli {

/// Whether a signal has asked the program to end. Runs poll this variable once per control period.
extern std::atomic<bool> interrupted;

/// Grace period [ms]. A process that has not ended this long after a signal is terminated.
inline constexpr int kGrace = 700;

/// Installs the handlers for SIGINT, SIGTERM and SIGHUP. Under nohup, SIGHUP remains ignored.
void EndOnSignals();

/// Exists while the result of an interrupted run is being written. The time for writing a result
/// grows with the length of the log. The grace period therefore does not end the process while a
/// FinishingResult exists.
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
