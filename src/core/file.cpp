#include "trackbed/core/file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "src/core/special_file.h"
#include "trackbed/core/error.h"
#include "trackbed/core/temporaries.h"

// Reads and writes files such that a killed process or a full disk leaves no partial file.
// 1. ReadFile accepts only regular files up to a maximum size, because a pipe could block the
//    program.
// 2. TemporaryFile writes a locked temporary file, whose name contains the process id, in the
//    folder of the final file. Publish closes the temporary file and renames it to the final name,
//    which is atomic.
// 3. RemoveAbandonedTemporaries removes temporary files that no process has locked.
// 4. Devices and pipes, such as /dev/stdout, are written directly, because they cannot be replaced.
namespace trackbed {
namespace {

namespace fs = std::filesystem;

/// Writes the whole content to a file descriptor. Returns 0 on success, otherwise the value of
/// errno.
int WriteAll(int out, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(out, content.data(), content.size());
    if (written < 0) {
      if (errno == EINTR) {
        continue;
      }
      return errno;
    }
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

[[noreturn]] void FailAsTooLarge(const fs::path& file, std::size_t max_bytes) {
  throw RunError(
      fmt::format("cannot read {}: it has more than {} MiB", file.string(), max_bytes >> 20U));
}

/// Throws an error if the file is a Git LFS pointer, which replaces a large file in a checkout
/// without Git LFS.
void RequireContent(const fs::path& file, std::string_view begin) {
  if (begin.starts_with("version https://git-lfs.github.com/spec/")) {
    throw RunError(fmt::format(
        "cannot read {}: it is a pointer of Git LFS, not the content of the file; fetch the "
        "content by `git lfs pull` in its repository",
        file.string()));
  }
}

void RequireRegular(const fs::path& file, const struct stat& status) {
  if (S_ISDIR(status.st_mode)) {
    FailOnFile("read", file, EISDIR);
  }
  if (!S_ISREG(status.st_mode)) {
    throw RunError(fmt::format(
        "cannot read {}: it is {}; must be a regular file: save the content to one first",
        file.string(), KindOfFile(status.st_mode)));
  }
}

}  // namespace

Descriptor OpenInput(const fs::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) {
    FailOnFile("read", file, errno);
  }
  // Check the kind of the file before opening it, because opening a device may have side effects.
  RequireRegular(file, status);
  Descriptor in(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  if (in.get() < 0 || ::fstat(in.get(), &status) != 0) {
    FailOnFile("read", file, errno);
  }
  // Check the kind of the file again after opening, because the name may refer to another file
  // since the first check.
  RequireRegular(file, status);
  return in;
}

std::string ReadFile(const fs::path& file, std::size_t max_bytes) {
  std::string content;
  ReadBlocks(
      file,
      [&](std::string_view block) {
        content.append(block);
        return true;
      },
      max_bytes);
  return content;
}

void ReadBlocks(const fs::path& file, const std::function<bool(std::string_view block)>& take,
                std::size_t max_bytes) {
  const Descriptor in = OpenInput(file);
  struct stat status {};
  if (::fstat(in.get(), &status) == 0 && static_cast<std::size_t>(status.st_size) > max_bytes) {
    FailAsTooLarge(file, max_bytes);
  }
  std::size_t bytes = 0;
  std::array<char, 65536> block{};
  for (;;) {
    const ssize_t got = ::read(in.get(), block.data(), block.size());
    if (got < 0) {
      if (errno == EINTR) {
        continue;
      }
      FailOnFile("read", file, errno);
    }
    const auto size = static_cast<std::size_t>(got);
    bytes += size;
    // Check the limit again while reading, because the file may have grown since its size was
    // checked, and files in /proc have a nominal size of 0.
    if (bytes > max_bytes) {
      FailAsTooLarge(file, max_bytes);
    }
    if (bytes == size) {
      RequireContent(file, {block.data(), size});
    }
    if (size == 0 || !take({block.data(), size})) {
      return;
    }
  }
}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  if (this != &other) {
    Close();
    descriptor_ = std::exchange(other.descriptor_, -1);
  }
  return *this;
}

Descriptor::~Descriptor() {
  Close();
}

int Descriptor::Close() {
  const int descriptor = std::exchange(descriptor_, -1);
  return descriptor < 0 || ::close(descriptor) == 0 ? 0 : errno;
}

namespace {

constexpr std::string_view kTemporary = ".trackbed";

fs::path TemporaryName(const fs::path& file, int number) {
  fs::path name = file;
  name.replace_filename(fmt::format(".{}.{}-{}{}{}", file.stem().string(), ::getpid(), number,
                                    kTemporary, file.extension().string()));
  return name;
}

/// Returns whether a file name may have been created by TemporaryName.
bool IsTemporaryName(std::string_view name) {
  const std::size_t mark = name.rfind(kTemporary);
  if (mark == std::string_view::npos || !name.starts_with('.')) {
    return false;
  }
  const std::string_view extension = name.substr(mark + kTemporary.size());
  const auto take_digits = [&] {
    const std::size_t other = name.find_last_not_of("0123456789");
    const bool any = other != std::string_view::npos && other + 1 < name.size();
    const char before = any ? name[other] : '\0';
    name = any ? name.substr(0, other) : "";
    return before;
  };
  name = name.substr(0, mark);
  return (extension.empty() || (extension.starts_with('.') && extension.rfind('.') == 0)) &&
         take_digits() == '-' && take_digits() == '.';
}

/// Locks a new temporary file. Returns false if another process has already locked or removed the
/// file, because that process assumed that the new file was abandoned.
bool IsOurs(int descriptor) {
  const bool taken = ::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  struct stat status {};
  return !taken && ::fstat(descriptor, &status) == 0 && status.st_nlink > 0;
}

}  // namespace

TemporaryFile::TemporaryFile(fs::path file) : file_(std::move(file)) {
  RequireReplaceable(file_);
  // Try names with increasing numbers until the name is new. Other threads, or a killed process
  // with the same process id, may have created the earlier names.
  for (int number = 0;; ++number) {
    path_ = TemporaryName(file_, number);
    const bool created = AddTemporary(path_, [this] {
      descriptor_ =
          Descriptor(::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
      return descriptor_.get() >= 0;
    });
    if (!created) {
      if (errno == EEXIST) {
        continue;
      }
      FailOnFile("write", file_, errno);
    }
    if (IsOurs(descriptor_.get())) {
      return;
    }
  }
}

TemporaryFile::~TemporaryFile() {
  if (!path_.empty()) {
    DropTemporary(path_, [this] {
      ::unlink(path_.c_str());
      return true;
    });
  }
}

void TemporaryFile::Write(std::string_view content) {
  if (const int error = WriteAll(descriptor_.get(), content); error != 0) {
    FailOnFile("write", file_, error);
  }
}

void TemporaryFile::Publish() {
  const Descriptor still_locked(::dup(descriptor_.get()));
  if (const int error = descriptor_.Close(); error != 0) {
    FailOnFile("write", file_, error);
  }
  // If the file is a link, replace the target of the link and keep the link. Check the file again,
  // because another file may have replaced it since the constructor's check.
  RequireReplaceable(file_);
  std::error_code error_code;
  const fs::path real = fs::is_symlink(file_) ? fs::weakly_canonical(file_, error_code) : file_;
  if (!DropTemporary(path_, [&] { return ::rename(path_.c_str(), real.c_str()) == 0; })) {
    FailOnFile("write", file_, errno);
  }
  path_.clear();
}

TemporaryFolder::TemporaryFolder(const fs::path& file) {
  for (int number = 0;; ++number) {
    path_ = TemporaryName(file, number);
    if (!AddTemporary(path_, [this] { return ::mkdir(path_.c_str(), 0777) == 0; })) {
      if (errno == EEXIST) {
        continue;
      }
      FailOnFile("write", file, errno);
    }
    descriptor_ = Descriptor(::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (descriptor_.get() < 0 && errno != ENOENT) {
      const int error = errno;
      DropTemporary(path_, [this] { return ::rmdir(path_.c_str()) == 0; });
      FailOnFile("write", file, error);
    }
    if (IsOurs(descriptor_.get())) {
      return;
    }
  }
}

TemporaryFolder::~TemporaryFolder() {
  DropTemporary(path_, [this] {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
    return true;
  });
}

void RemoveAbandonedTemporaries(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator at(folder.empty() ? "." : folder, error), end; !error && at != end;
       at.increment(error)) {
    if (!IsTemporaryName(at->path().filename().string())) {
      continue;
    }
    const bool is_folder = fs::is_directory(at->symlink_status(error));
    const Descriptor own(::open(at->path().c_str(), (is_folder ? O_RDONLY : O_WRONLY) | O_NOFOLLOW |
                                                        O_NONBLOCK | O_CLOEXEC));
    if (own.get() >= 0 && ::flock(own.get(), LOCK_EX | LOCK_NB) == 0) {
      std::error_code ignored;
      fs::remove_all(at->path(), ignored);
    }
  }
}

void PrepareToWrite(const fs::path& file) {
  const fs::path folder = (fs::path(".") / file).parent_path();
  MakeFolder(folder);
  RemoveAbandonedTemporaries(folder);
  CheckCanWrite(file);
}

void CheckCanWrite(const fs::path& file) {
  std::error_code ignored;
  if (fs::is_directory(file, ignored)) {
    FailOnFile("write", file, EISDIR);
  }
  RequireTarget(file);
  if (!IsDevice(file)) {
    const TemporaryFile temporary(file);
  }
}

NewFile::NewFile(const fs::path& file, fs::path shown)
    : shown_(std::move(shown)),
      descriptor_(::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666)) {
  if (descriptor_.get() < 0) {
    FailOnFile("write", shown_, errno);
  }
}

void NewFile::Write(std::string_view content) {
  if (const int error = WriteAll(descriptor_.get(), content); error != 0) {
    FailOnFile("write", shown_, error);
  }
}

void NewFile::Close() {
  if (const int error = descriptor_.Close(); error != 0) {
    FailOnFile("write", shown_, error);
  }
}

void WriteNewFile(const fs::path& file, std::string_view content, const fs::path& shown) {
  NewFile out(file, shown);
  out.Write(content);
  out.Close();
}

void WriteFileAtomically(const fs::path& file, std::string_view content) {
  if (IsDevice(file)) {
    Descriptor out = OpenDevice(file);
    const int error = WriteAll(out.get(), content);
    if (const int closed = out.Close(); error != 0 || closed != 0) {
      FailOnFile("write", file, error != 0 ? error : closed);
    }
    return;
  }
  TemporaryFile temporary(file);
  temporary.Write(content);
  temporary.Publish();
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

/// Returns the absolute path without links, "." and "..". The last components of the path may be
/// missing in the file system.
fs::path RealPath(const fs::path& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path.empty() ? "." : path, error);
  fs::path real = fs::weakly_canonical(absolute, error);
  return error ? absolute.lexically_normal() : real;
}

bool IsInside(const fs::path& real_file, const fs::path& folder) {
  const fs::path real_folder = RealPath(folder / "");
  const auto [of_folder, of_file] =
      std::mismatch(real_folder.begin(), real_folder.end(), real_file.begin(), real_file.end());
  // If the path of the folder ends with a slash, std::filesystem regards an empty text as its last
  // component; ignore this component.
  return of_folder == real_folder.end() || of_folder->empty();
}

}  // namespace

std::string ReadAccessError(const fs::path& name, const fs::path& own,
                            const std::vector<fs::path>& others) {
  const fs::path real = RealPath(own / name);
  if ((name.is_relative() && IsInside(real, own)) ||
      std::any_of(others.begin(), others.end(),
                  [&](const fs::path& folder) { return IsInside(real, folder); })) {
    return "";
  }
  return fmt::format(
      "{} the folder of the file that names it; --allow-assets DIR allows a folder whose files may "
      "be read",
      name.is_absolute() ? "is an absolute path, not one below" : "lies outside of");
}

}  // namespace trackbed
