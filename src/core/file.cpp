#include "trackbed/core/file.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <regex>
#include <system_error>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void Fail(const char* what, const fs::path& file, int error) {
  throw RunError(
      fmt::format("cannot {} {}: {}", what, file.string(), std::generic_category().message(error)));
}

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (descriptor_ >= 0) {
      ::close(descriptor_);
    }
  }
  [[nodiscard]] int get() const { return descriptor_; }
  int Close() {
    const int result = ::close(descriptor_);
    descriptor_ = -1;
    return result;
  }

 private:
  int descriptor_;
};

/// Returns 0 or an errno.
int WriteAll(const fs::path& file, std::string_view content) {
  Descriptor out(::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (out.get() < 0) {
    return errno;
  }
  while (!content.empty()) {
    const ssize_t written = ::write(out.get(), content.data(), content.size());
    if (written < 0) {
      if (errno == EINTR) {
        continue;
      }
      return errno;
    }
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return out.Close() == 0 ? 0 : errno;
}

/// Devices and pipes (/dev/stdout, /dev/full) can be written but not replaced.
bool IsDevice(const fs::path& file) {
  struct stat existing {};
  return ::stat(file.c_str(), &existing) == 0 && !S_ISREG(existing.st_mode) &&
         !S_ISDIR(existing.st_mode);
}

}  // namespace

std::string ReadFile(const fs::path& file) {
  Descriptor in(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (in.get() < 0) {
    Fail("read", file, errno);
  }
  std::string content;
  std::array<char, 65536> block{};
  for (;;) {
    const ssize_t got = ::read(in.get(), block.data(), block.size());
    if (got == 0) {
      return content;
    }
    if (got < 0) {
      if (errno == EINTR) {
        continue;
      }
      Fail("read", file, errno);
    }
    content.append(block.data(), static_cast<std::size_t>(got));
  }
}

fs::path TemporaryNameFor(const fs::path& file) {
  fs::path name = file;
  name.replace_filename(
      fmt::format(".{}.{}.partial{}", file.stem().string(), ::getpid(), file.extension().string()));
  return name;
}

void PublishFile(const fs::path& temporary, const fs::path& file) {
  // A link stays a link: what it points to is replaced. A device or pipe must not be replaced.
  std::error_code error_code;
  const fs::path real = fs::is_symlink(file) ? fs::weakly_canonical(file, error_code) : file;
  if (fs::is_directory(real, error_code)) {
    ::unlink(temporary.c_str());
    Fail("write", file, EISDIR);
  }
  if (fs::exists(real, error_code) && !fs::is_regular_file(real, error_code)) {
    ::unlink(temporary.c_str());
    throw RunError(fmt::format("cannot write {}: it is not a regular file", file.string()));
  }
  if (::rename(temporary.c_str(), real.c_str()) != 0) {
    const int error = errno;
    ::unlink(temporary.c_str());
    Fail("write", file, error);
  }
}

void CheckCanWrite(const fs::path& file) {
  std::error_code ignored;
  if (fs::is_directory(file, ignored)) {
    Fail("write", file, EISDIR);
  }
  if (IsDevice(file)) {
    return;
  }
  const fs::path temporary = TemporaryNameFor(file);
  const int error = WriteAll(temporary, "");
  ::unlink(temporary.c_str());
  if (error != 0) {
    Fail("write", file, error);
  }
}

void WriteFileAtomically(const fs::path& file, std::string_view content) {
  if (IsDevice(file)) {
    if (const int error = WriteAll(file, content); error != 0) {
      Fail("write", file, error);
    }
    return;
  }
  WriteTemporary(file, content);
  PublishFile(TemporaryNameFor(file), file);
}

void WriteTemporary(const fs::path& file, std::string_view content) {
  const fs::path temporary = TemporaryNameFor(file);
  if (const int error = WriteAll(temporary, content); error != 0) {
    ::unlink(temporary.c_str());
    Fail("write", file, error);
  }
}

void RemoveAbandonedTemporaries(const fs::path& folder) {
  static const std::regex temporary(R"re(\..*\.([0-9]{1,9})\.partial(\..*)?)re");
  std::error_code ignored;
  std::vector<fs::path> abandoned;
  for (fs::directory_iterator entry(folder.empty() ? "." : folder, ignored), end;
       !ignored && entry != end; entry.increment(ignored)) {
    const std::string name = entry->path().filename().string();
    std::smatch found;
    if (std::regex_match(name, found, temporary) && ::kill(std::stoi(found[1]), 0) != 0 &&
        errno == ESRCH) {
      abandoned.push_back(entry->path());
    }
  }
  for (const fs::path& file : abandoned) {
    fs::remove(file, ignored);
  }
}

void MakeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw RunError(
        fmt::format("cannot create the folder {}: {}", folder.string(), error.message()));
  }
}

namespace {

/// Without links and dots, also when the last parts of it do not exist.
fs::path RealPath(const fs::path& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path.empty() ? "." : path, error);
  fs::path real = fs::weakly_canonical(absolute, error);
  return error ? absolute.lexically_normal() : real;
}

bool LiesIn(const fs::path& real_file, const fs::path& folder) {
  const fs::path real_folder = RealPath(folder / "");
  const auto [of_folder, of_file] =
      std::mismatch(real_folder.begin(), real_folder.end(), real_file.begin(), real_file.end());
  // A folder's path may end in an empty part, after the slash.
  return of_folder == real_folder.end() || of_folder->empty();
}

}  // namespace

std::string WhyUnreadable(const fs::path& name, const fs::path& own,
                          const std::vector<fs::path>& others) {
  const fs::path real = RealPath(own / name);
  if ((name.is_relative() && LiesIn(real, own)) ||
      std::any_of(others.begin(), others.end(),
                  [&](const fs::path& folder) { return LiesIn(real, folder); })) {
    return "";
  }
  return fmt::format(
      "{} the folder of the file that names it; --allow-assets DIR allows a folder whose files may "
      "be read",
      name.is_absolute() ? "is an absolute path, not one below" : "lies outside of");
}

}  // namespace trackbed
