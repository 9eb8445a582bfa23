#pragma once

#include <atomic>

/// Ends the program on SIGINT (Ctrl-C), SIGTERM and SIGHUP (closed terminal), with exit code 130.
///
/// The first signal sets `interrupted`, which runs, searches and films poll. Runs, searches and
/// films end at their next step and write their results so far. If work is not done within kGrace,
/// the process ends at once. A result that was not committed before the end of the process is lost,
/// as after SIGKILL, but no file is half written. A second Ctrl-C ends the program at once.
namespace trackbed::cli {

/// Set by the first signal. Runs poll the variable once per control period.
extern std::atomic<bool> interrupted;

/// Time from the first signal to the end of a process that does not poll `interrupted` [ms].
inline constexpr int kGrace = 700;

/// Installs the handlers for SIGINT, SIGTERM and SIGHUP. SIGHUP stays ignored under nohup.
void EndOnSignals();

/// Marks that the result of an interrupted run is being written. The time for writing a result
/// grows with the length of the log. The process is therefore not ended while a FinishingResult
/// exists.
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
