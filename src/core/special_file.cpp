#include "src/core/special_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <chrono>
#include <system_error>
#include <thread>

#include "trackbed/core/error.h"

namespace trackbed {

namespace fs = std::filesystem;

[[noreturn]] void FailOnFile(const char* what, const fs::path& file, int error) {
  throw RunError(
      fmt::format("cannot {} {}: {}", what, file.string(), std::generic_category().message(error)));
}

const char* KindOfFile(mode_t mode) {
  return S_ISFIFO(mode)                   ? "a pipe"
         : S_ISCHR(mode) || S_ISBLK(mode) ? "a device"
         : S_ISSOCK(mode)                 ? "a socket"
                                          : "a special file";
}

bool IsDevice(const fs::path& file) {
  struct stat existing {};
  return ::stat(file.c_str(), &existing) == 0 && !S_ISREG(existing.st_mode) &&
         !S_ISDIR(existing.st_mode);
}

void RequireTarget(const fs::path& file) {
  std::error_code error;
  if (fs::is_symlink(file, error) && !fs::exists(file, error)) {
    throw RunError(fmt::format(
        "cannot write {}: it is a link to a file that does not exist; remove it, or name another "
        "file",
        file.string()));
  }
}

void RequireReplaceable(const fs::path& file) {
  RequireTarget(file);
  struct stat existing {};
  if (::stat(file.c_str(), &existing) != 0 || S_ISREG(existing.st_mode)) {
    return;
  }
  if (S_ISDIR(existing.st_mode)) {
    FailOnFile("write", file, EISDIR);
  }
  throw RunError(fmt::format("cannot write {}: it is {}; must be a regular file, or a new one",
                             file.string(), KindOfFile(existing.st_mode)));
}

Descriptor OpenDevice(const fs::path& file) {
  constexpr std::chrono::seconds kPatience{1};
  constexpr std::chrono::milliseconds kPause{10};
  const auto end = std::chrono::steady_clock::now() + kPatience;
  for (;;) {
    Descriptor out(::open(file.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
    if (out.get() >= 0) {
      const int flags = ::fcntl(out.get(), F_GETFL);
      if (flags < 0 || ::fcntl(out.get(), F_SETFL, flags & ~O_NONBLOCK) != 0) {
        FailOnFile("write", file, errno);
      }
      return out;
    }
    const int error = errno;
    if (error != ENXIO || !fs::is_fifo(file)) {
      FailOnFile("write", file, error);
    }
    if (std::chrono::steady_clock::now() >= end) {
      throw RunError(fmt::format(
          "cannot write {}: it is a pipe, and no process reads it; start the reader first",
          file.string()));
    }
    std::this_thread::sleep_for(kPause);
  }
}

}  // namespace trackbed
