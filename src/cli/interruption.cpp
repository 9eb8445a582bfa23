#include "src/cli/interruption.h"

#include <semaphore.h>
#include <sys/time.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "src/cli/verbs.h"
#include "trackbed/core/temporaries.h"

namespace trackbed::cli {

std::atomic<bool> interrupted{false};

namespace {

// Number of FinishingResult objects; a global variable, because a signal handler can access only
// global variables.
std::atomic<int> finishing{0};

static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

void StartTimer(int milliseconds) {
  constexpr int kMicroseconds = 1000;  // number of microseconds in a millisecond
  const itimerval timer{.it_interval = {}, .it_value = {0, milliseconds * kMicroseconds}};
  setitimer(ITIMER_REAL, &timer, nullptr);
}

void OnSignal(int /*signal*/) {
  interrupted = true;
  StartTimer(kGrace);
}

void End() {
  constexpr std::string_view kText = "interrupted: ended in the middle of its work\n";
  if (::write(STDERR_FILENO, kText.data(), kText.size()) < 0) {
    // Ignore a failed write to stderr, because no error message can be shown.
  }
  ::_exit(kInterrupted);
}

// Semaphore posted when the grace period after a signal is over.
sem_t grace_over;

void OnGraceOver(int /*signal*/) {
  if (finishing > 0) {
    return;  // a result is being written; the destructor of FinishingResult restarts the timer
  }
  static std::atomic<bool> again{false};
  if (again.exchange(true)) {
    End();  // end now: the waiting thread is missing or blocked by the file system
  }
  sem_post(&grace_over);
  constexpr int kRemoval = 200;  // time to remove temporary files [ms]
  StartTimer(kRemoval);
}

void EndAfterGrace() {
  while (sem_wait(&grace_over) != 0 && errno == EINTR) {
  }
  RemoveTemporariesForEver();
  End();
}

/// Starts the thread that ends the process when the grace period is over. A thread is needed,
/// because a signal handler must not take the lock for the removal of temporary files.
void StartThread() {
  sem_init(&grace_over, 0, 0);
  // Block all signals in the helper thread, so that signals interrupt the system calls of the main
  // thread.
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  try {
    std::thread(EndAfterGrace).detach();
  } catch (const std::system_error&) {
    // Continue without the helper thread if it cannot be started, for example because of a limit on
    // processes. Without the helper thread, the temporary files of an interrupted process are not
    // removed.
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

}  // namespace

void EndOnSignals() {
  StartThread();
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
    StartTimer(kGrace);
  }
}

}  // namespace trackbed::cli
