#include "src/sim/sub_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <system_error>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

std::string ErrnoText(int error) {
  return std::generic_category().message(error);
}

/// Writes all of the data to a pipe. Returns false if the reading process has closed the pipe.
bool WriteAll(int pipe, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(pipe, data, size);
    if (written < 0 && errno == EINTR) {
      continue;
    }
    if (written <= 0) {
      return false;
    }
    data += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

void Limit(int resource, rlim_t value) {
  rlimit limit{};
  ::getrlimit(static_cast<__rlimit_resource>(resource), &limit);
  limit.rlim_cur = std::min(limit.rlim_max, value);
  limit.rlim_max = limit.rlim_cur;
  ::setrlimit(static_cast<__rlimit_resource>(resource), &limit);
}

/// Returns the size of this process's address space [bytes].
std::size_t AddressSpace() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

[[noreturn]] void RunChildProcess(const std::function<std::string()>& compute, std::size_t space,
                                  int seconds, int pipe) {
  // The child process must end together with its parent, because it has inherited the parent's file
  // locks.
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  // Redirects standard streams to /dev/null. Without redirected streams, a library that calls
  // exit() would flush buffers copied from the parent process, and might print an error.
  const int nowhere = ::open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    ::dup2(nowhere, stream);
  }
  Limit(RLIMIT_CORE, 0);
  Limit(RLIMIT_NOFILE, 0);
  Limit(RLIMIT_CPU, static_cast<rlim_t>(seconds));
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  Limit(RLIMIT_AS, space);
#else
  static_cast<void>(space);
#endif
  // Disables the signal handlers of the program or of a sanitizer, because the parent process
  // reports crashes.
  for (const int crash : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU}) {
    ::signal(crash, SIG_DFL);
  }
  const std::string result = compute();
  const std::uint64_t size = result.size();
  std::array<char, sizeof size> header{};
  std::memcpy(header.data(), &size, sizeof size);
  const bool written =
      WriteAll(pipe, header.data(), header.size()) && WriteAll(pipe, result.data(), result.size());
  // ends the child process without running exit handlers or flushing buffers copied from the parent
  ::_exit(written ? 0 : 1);
}

/// Reads from the pipe until its other end is closed or the time `until` is reached.
std::string ReadUntil(int pipe, std::chrono::steady_clock::time_point until) {
  std::string text;
  std::array<char, 65536> block{};
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        until - std::chrono::steady_clock::now());
    pollfd ready{pipe, POLLIN, 0};
    const int count = ::poll(&ready, 1, static_cast<int>(std::max<long>(left.count(), 0)));
    if (count < 0 && errno == EINTR) {
      continue;
    }
    if (count <= 0) {
      return text;
    }
    const ssize_t got = ::read(pipe, block.data(), block.size());
    if (got < 0 && errno == EINTR) {
      continue;
    }
    if (got <= 0) {
      return text;
    }
    text.append(block.data(), static_cast<std::size_t>(got));
  }
}

}  // namespace

SubProcessOutcome InSubProcess(const std::function<std::string()>& compute, std::size_t memory,
                               int seconds) {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) {
    throw RunError(fmt::format("cannot start a process: {}", ErrnoText(errno)));
  }
  const std::size_t space = AddressSpace() + memory;
  const pid_t child = ::fork();
  if (child < 0) {
    const int error = errno;
    ::close(pipe[0]);
    ::close(pipe[1]);
    throw RunError(fmt::format("cannot start a process: {}", ErrnoText(error)));
  }
  if (child == 0) {
    ::close(pipe[0]);
    RunChildProcess(compute, space, seconds, pipe[1]);
  }
  ::close(pipe[1]);
  // The wall-clock limit is twice the limit of processor time, because the machine may be busy.
  const std::string text =
      ReadUntil(pipe[0], std::chrono::steady_clock::now() + std::chrono::seconds(2 * seconds));
  ::close(pipe[0]);
  SubProcessOutcome outcome;
  std::uint64_t size = 0;
  if (text.size() >= sizeof size) {
    std::memcpy(&size, text.data(), sizeof size);
    outcome.finished = text.size() - sizeof size == size;
  }
  if (!outcome.finished) {
    ::kill(child, SIGKILL);  // killing a process that has already ended has no effect
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (outcome.finished) {
    outcome.result = text.substr(sizeof size);
    return outcome;
  }
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (signal == SIGKILL || signal == SIGXCPU) {
    outcome.cause = fmt::format("took longer than {} s", seconds);
  } else if (signal != 0) {
    outcome.cause = ::strsignal(signal);
  } else {
    outcome.cause = fmt::format("exit code {}", WIFEXITED(status) ? WEXITSTATUS(status) : -1);
  }
  return outcome;
}

}  // namespace trackbed
