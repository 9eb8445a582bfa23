#include "trackbed/analysis/output_folder.h"

#include <fcntl.h>
#include <fmt/ranges.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include "src/analysis/manifest.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

/// Lists the files to remove, one a line.
constexpr const char* kObsolete = ".obsolete";

[[noreturn]] void FailToWrite(const fs::path& file, const std::error_code& error) {
  throw RunError(fmt::format("cannot write {}: {}", file.string(), error.message()));
}

/// " (process 123)", from the kernel's list of locks; empty where that does not tell.
std::string Holder(int descriptor) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) {
    return "";
  }
  const std::string own =
      fmt::format("{:02x}:{:02x}:{}", major(status.st_dev), minor(status.st_dev), status.st_ino);
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    // "1: FLOCK  ADVISORY  WRITE 123 fe:00:4711 0 EOF"
    std::istringstream words(line);
    std::string number;
    std::string kind;
    std::string advisory;
    std::string access;
    long process = 0;
    std::string file;
    if (words >> number >> kind >> advisory >> access >> process >> file && kind == "FLOCK" &&
        file == own && process > 0) {
      return fmt::format(" (process {})", process);
    }
  }
  return "";
}

/// 0, or EWOULDBLOCK when another process has the lock. Where there are no locks, all have it.
int TryLock(int descriptor, int how) {
  return ::flock(descriptor, how | LOCK_NB) != 0 && errno == EWOULDBLOCK ? EWOULDBLOCK : 0;
}

/// Removes the names that the list in `complete` has, moves its files into the folder, and the
/// manifest last. What was done before is not done again.
void MoveIntoPlace(const fs::path& folder) {
  const fs::path complete = folder / run_folder::kComplete;
  const auto check = [&](const fs::path& file, const std::error_code& error) {
    if (error) {
      throw RunError(
          fmt::format("cannot write {}: {}; the result is complete in {}, from where the next "
                      "trackbed that writes here will move it into place",
                      file.string(), error.message(), complete.string()));
    }
  };
  std::error_code error;
  std::ifstream obsolete(complete / kObsolete);
  for (std::string name; std::getline(obsolete, name);) {
    // A name from an old manifest must not lead out of the folder.
    if (!name.empty() && name.find('/') == std::string::npos &&
        !fs::is_directory(fs::symlink_status(folder / name, error))) {
      fs::remove(folder / name, error);
      check(folder / name, error);
    }
  }
  std::vector<std::string> names;
  for (fs::directory_iterator at(complete, error), end; !error && at != end; at.increment(error)) {
    names.push_back(at->path().filename());
  }
  check(complete, error);
  for (const std::string& name : names) {
    if (name != kObsolete && name != run_folder::kManifest) {
      fs::rename(complete / name, folder / name, error);
      check(folder / name, error);
    }
  }
  if (fs::exists(complete / run_folder::kManifest, error)) {
    fs::rename(complete / run_folder::kManifest, folder / run_folder::kManifest, error);
    check(folder / run_folder::kManifest, error);
  }
  fs::remove_all(complete, error);
  check(complete, error);
}

bool NeedsRecovery(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / run_folder::kPartial, ignored) ||
         fs::exists(folder / run_folder::kComplete, ignored);
}

/// What a process that was killed left there. Only with the lock.
void Recover(const fs::path& folder) {
  std::error_code error;
  fs::remove_all(folder / run_folder::kPartial, error);
  if (fs::exists(folder / run_folder::kComplete, error)) {
    MoveIntoPlace(folder);
  }
}

}  // namespace

OutputFolder::OutputFolder(fs::path path, For use) : path_(std::move(path)) {
  if (path_.empty()) {
    path_ = ".";
  }
  if (use == For::kResult) {
    MakeFolder(path_);
  }
  lock_ = Descriptor(::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (lock_.get() < 0) {
    return;  // absent or unreadable: reading or writing will tell
  }
  Lock(use);
  RemoveAbandonedTemporaries(path_);
}

void OutputFolder::Lock(For use) {
  const auto require = [&](int how) {
    if (TryLock(lock_.get(), how) != 0) {
      throw RunError(fmt::format("{} is being written by another trackbed{}", path_.string(),
                                 Holder(lock_.get())));
    }
  };
  if (use == For::kAddition) {
    require(LOCK_SH);
    if (!NeedsRecovery(path_)) {
      return;
    }
  }
  require(LOCK_EX);
  Recover(path_);
  if (use == For::kAddition) {
    require(LOCK_SH);
  }
}

bool OutputFolder::IsStillThere() const {
  struct stat locked {};
  struct stat now {};
  return lock_.get() < 0 ||
         (::fstat(lock_.get(), &locked) == 0 && ::stat(path_.c_str(), &now) == 0 &&
          locked.st_dev == now.st_dev && locked.st_ino == now.st_ino);
}

std::optional<OutputFolder> UseFolderOf(const fs::path& file, const fs::path& result) {
  const fs::path beside = (fs::path(".") / file).parent_path();
  std::error_code ignored;
  if (fs::equivalent(beside, fs::path(".") / result, ignored)) {
    return OutputFolder(beside, OutputFolder::For::kAddition);
  }
  RemoveAbandonedTemporaries(beside);
  return std::nullopt;
}

ResultWriter::ResultWriter(const OutputFolder& folder) : folder_(folder.path()) {
  if (!folder.IsStillThere()) {
    anew_.emplace(folder_);
  }
  const fs::path partial = folder_ / run_folder::kPartial;
  std::error_code error;
  fs::remove_all(partial, error);
  fs::create_directory(partial, error);
  if (error) {
    FailToWrite(folder_, error);
  }
}

ResultWriter::~ResultWriter() {
  std::error_code ignored;
  fs::remove_all(folder_ / run_folder::kPartial, ignored);
}

void ResultWriter::Add(const std::string& name, std::string_view content) {
  const fs::path file = folder_ / name;
  std::error_code error;
  // Links are replaced, but not what else is in the way: Commit would find it too late.
  if (fs::is_directory(file, error)) {
    FailToWrite(file, std::make_error_code(std::errc::is_a_directory));
  }
  if (fs::exists(file, error) && !fs::is_regular_file(file, error)) {
    throw RunError(fmt::format("cannot write {}: it is not a regular file", file.string()));
  }
  WriteNewFile(folder_ / run_folder::kPartial / name, content, file);
  if (name != run_folder::kTimingJson) {
    files_[name] = EntryOf(content);
  }
  names_.push_back(name);
}

void ResultWriter::Commit(const std::string& result, std::vector<std::string> obsolete) {
  Manifest manifest;
  try {
    manifest = ReadManifest(folder_).value_or(Manifest{});
  } catch (const InputError&) {
    // Not one of ours: replaced.
  }
  if (const auto earlier = manifest.results.find(result); earlier != manifest.results.end()) {
    for (const auto& file : earlier->second) {
      obsolete.push_back(file.first);
    }
  }
  std::error_code error;
  std::erase_if(obsolete, [&](const std::string& name) {
    return name == run_folder::kManifest ||
           !fs::exists(fs::symlink_status(folder_ / name, error)) ||
           std::find(names_.begin(), names_.end(), name) != names_.end();
  });
  manifest.Take(result, files_, obsolete);
  Add(run_folder::kManifest, manifest.ToJson());
  WriteNewFile(folder_ / run_folder::kPartial / kObsolete,
               fmt::format("{}\n", fmt::join(obsolete, "\n")), folder_ / kObsolete);
  // The commit point: from here on the new result is moved into place, if not by this process then
  // by the next one.
  fs::rename(folder_ / run_folder::kPartial, folder_ / run_folder::kComplete, error);
  if (error) {
    FailToWrite(folder_, error);
  }
  MoveIntoPlace(folder_);
}

}  // namespace trackbed
