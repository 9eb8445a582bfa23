#pragma once

#include <atomic>

/// How the program ends on SIGINT (Ctrl-C), SIGTERM and SIGHUP (closed terminal), with exit code
/// 130.
///
/// The first signal sets `interrupted`, which runs, searches and films poll: they end at their next
/// step and write what they have. Work that is not done within kGrace is cut short: the process
/// ends at once. As after SIGKILL, its result is lost, and no file is half written. A second Ctrl-C
/// ends the program at once.
namespace trackbed::cli {

/// Set by the first signal; polled by runs once per control period.
extern std::atomic<bool> interrupted;

/// Time from the first signal to the end of work that does not poll `interrupted` [ms].
inline constexpr int kGrace = 700;

/// Installs the handlers. SIGHUP is left ignored where nohup ignores it.
void EndOnSignals();

/// While one lives, the result of an interrupted run is being written, which takes time in
/// proportion to its log: it is not cut short.
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
