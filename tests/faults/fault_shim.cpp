// Preloaded into the program (LD_PRELOAD): makes one of its calls that change files fail, or kills
// the program there. Calls on files outside of FAULT_FOLDER are not counted.
//
//   FAULT_FOLDER  absolute path
//   FAULT_AT      number of the call that fails, from 1; 0: none
//   FAULT_ERRNO   its errno (28: no space left); 0: the program is killed (SIGKILL) instead
//   FAULT_HALF    if set, and the call is a write, half of it is written first
//   FAULT_LOG     file that receives the calls, one per line
//
// The library counts these calls: open (to write or create), write, pwrite, ftruncate, close (of a
// file open for writing), rename, renameat, mkdir, unlink, unlinkat, rmdir.
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <string>

namespace {

std::atomic<int> calls{0};

std::string Setting(const char* name) {
  const char* value = getenv(name);
  return value == nullptr ? "" : value;
}

template <typename Function>
Function Real(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

/// Path of a descriptor's file; empty if it is not a file.
std::string PathOf(int descriptor) {
  char path[4096];
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  const ssize_t length = readlink(link.c_str(), path, sizeof path);
  return length > 0 ? std::string(path, static_cast<size_t>(length)) : "";
}

std::string Absolute(int folder, const char* path) {
  if (path[0] == '/') {
    return path;
  }
  char here[4096];
  const std::string base =
      folder == AT_FDCWD ? (getcwd(here, sizeof here) == nullptr ? "" : here) : PathOf(folder);
  return base + "/" + path;
}

bool Counts(const std::string& path) {
  static const std::string folder = Setting("FAULT_FOLDER");
  return !folder.empty() && path.compare(0, folder.size() + 1, folder + "/") == 0;
}

void DoNothing() {}

/// Counts a call. Returns whether the call must fail, with errno set. Does not return if the
/// program must be killed. Calls `first` before the call fails or the program is killed.
template <typename First = void (*)()>
bool Fails(const char* what, const std::string& path, const First& first = DoNothing) {
  if (!Counts(path)) {
    return false;
  }
  static const int at = atoi(Setting("FAULT_AT").c_str());
  static const int error = atoi(Setting("FAULT_ERRNO").c_str());
  static const std::string log = Setting("FAULT_LOG");
  const int number = ++calls;
  if (!log.empty()) {
    const std::string line = std::to_string(number) + " " + what + " " + path + "\n";
    const long out =
        syscall(SYS_openat, AT_FDCWD, log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0666);
    syscall(SYS_write, out, line.data(), line.size());
    syscall(SYS_close, out);
  }
  if (number != at) {
    return false;
  }
  if (error >= 0) {
    first();
  }
  if (error == 0) {
    kill(getpid(), SIGKILL);
    for (;;) {
      pause();
    }
  }
  if (error < 0) {
    kill(getpid(), SIGSTOP);
    return false;
  }
  errno = error;
  return true;
}

bool IsForWriting(int descriptor) {
  const int flags = fcntl(descriptor, F_GETFL);
  return flags >= 0 && (flags & O_ACCMODE) != O_RDONLY;
}

}  // namespace

extern "C" {

#define OPEN_LIKE(name)                                                                            \
  int name(const char* path, int flags, ...) {                                                     \
    va_list rest;                                                                                  \
    va_start(rest, flags);                                                                         \
    const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;                         \
    va_end(rest);                                                                                  \
    if ((flags & (O_WRONLY | O_RDWR | O_CREAT)) != 0 && Fails("open", Absolute(AT_FDCWD, path))) { \
      return -1;                                                                                   \
    }                                                                                              \
    return Real<int (*)(const char*, int, ...)>(#name)(path, flags, mode);                         \
  }
OPEN_LIKE(open)
OPEN_LIKE(open64)

ssize_t write(int descriptor, const void* bytes, size_t count) {
  const auto real = Real<ssize_t (*)(int, const void*, size_t)>("write");
  static const bool half = !Setting("FAULT_HALF").empty();
  const auto write_half = [&] {
    if (half && count > 1) {
      real(descriptor, bytes, count / 2);
    }
  };
  return Fails("write", PathOf(descriptor), write_half) ? -1 : real(descriptor, bytes, count);
}

ssize_t pwrite64(int descriptor, const void* bytes, size_t count, off64_t offset) {
  return Fails("pwrite", PathOf(descriptor)) ? -1
                                             : Real<ssize_t (*)(int, const void*, size_t, off64_t)>(
                                                   "pwrite64")(descriptor, bytes, count, offset);
}

int ftruncate64(int descriptor, off64_t size) {
  return Fails("ftruncate", PathOf(descriptor))
             ? -1
             : Real<int (*)(int, off64_t)>("ftruncate64")(descriptor, size);
}

int close(int descriptor) {
  const auto real = Real<int (*)(int)>("close");
  if (IsForWriting(descriptor) && Fails("close", PathOf(descriptor))) {
    const int error = errno;
    real(descriptor);  // the kernel closes the descriptor although close reports the error
    errno = error;
    return -1;
  }
  return real(descriptor);
}

int rename(const char* from, const char* to) {
  return Fails("rename", Absolute(AT_FDCWD, to))
             ? -1
             : Real<int (*)(const char*, const char*)>("rename")(from, to);
}

int renameat(int from_folder, const char* from, int to_folder, const char* to) {
  return Fails("rename", Absolute(to_folder, to))
             ? -1
             : Real<int (*)(int, const char*, int, const char*)>("renameat")(from_folder, from,
                                                                             to_folder, to);
}

int mkdir(const char* path, mode_t mode) {
  return Fails("mkdir", Absolute(AT_FDCWD, path))
             ? -1
             : Real<int (*)(const char*, mode_t)>("mkdir")(path, mode);
}

int unlink(const char* path) {
  return Fails("unlink", Absolute(AT_FDCWD, path)) ? -1
                                                   : Real<int (*)(const char*)>("unlink")(path);
}

int unlinkat(int folder, const char* path, int flags) {
  return Fails("unlink", Absolute(folder, path))
             ? -1
             : Real<int (*)(int, const char*, int)>("unlinkat")(folder, path, flags);
}

int remove(const char* path) {
  return Fails("unlink", Absolute(AT_FDCWD, path)) ? -1
                                                   : Real<int (*)(const char*)>("remove")(path);
}

int rmdir(const char* path) {
  return Fails("rmdir", Absolute(AT_FDCWD, path)) ? -1 : Real<int (*)(const char*)>("rmdir")(path);
}
}
