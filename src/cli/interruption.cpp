#include "src/cli/interruption.h"

#include <sys/time.h>
#include <unistd.h>

#include <csignal>
#include <string_view>
#include <utility>

#include "src/cli/verbs.h"

namespace trackbed::cli {

std::atomic<bool> interrupted{false};

namespace {

// Number of FinishingResult objects; a global variable, because a signal handler can access only
// global variables.
std::atomic<int> finishing{0};

static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

void StartGrace() {
  constexpr int kMicroseconds = 1000;  // number of microseconds in a millisecond
  const itimerval grace{.it_interval = {}, .it_value = {0, kGrace * kMicroseconds}};
  setitimer(ITIMER_REAL, &grace, nullptr);
}

void OnSignal(int /*signal*/) {
  interrupted = true;
  StartGrace();
}

void OnGraceOver(int /*signal*/) {
  if (finishing > 0) {
    return;  // wait for the result: the destructor of FinishingResult restarts the timer
  }
  constexpr std::string_view kText = "interrupted: ended in the middle of its work\n";
  if (::write(STDERR_FILENO, kText.data(), kText.size()) < 0) {
    // Ignore the failure, because without stderr no error message can be shown.
  }
  ::_exit(kInterrupted);
}

}  // namespace

void EndOnSignals() {
  struct sigaction action {};
  action.sa_handler = OnGraceOver;
  sigaction(SIGALRM, &action, nullptr);
  action.sa_handler = OnSignal;
  sigaction(SIGTERM, &action, nullptr);
  // Also end the program when the terminal is closed (SIGHUP), unless the program `nohup` made the
  // process ignore SIGHUP.
  struct sigaction hang_up {};
  sigaction(SIGHUP, nullptr, &hang_up);
  if (hang_up.sa_handler != SIG_IGN) {
    sigaction(SIGHUP, &action, nullptr);
  }
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
}

FinishingResult::FinishingResult() {
  ++finishing;
}

FinishingResult::FinishingResult(FinishingResult&& other) noexcept
    : counts_(std::exchange(other.counts_, false)) {}

FinishingResult::~FinishingResult() {
  if (counts_ && --finishing == 0 && interrupted) {
    StartGrace();
  }
}

}  // namespace trackbed::cli
