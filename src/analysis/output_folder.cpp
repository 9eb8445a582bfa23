#include "trackbed/analysis/output_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <system_error>
#include <utility>

#include "src/analysis/manifest.h"
#include "src/analysis/own_files.h"
#include "trackbed/analysis/json_file.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/analysis/written_names.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file_name.h"

// Writes results into output folders such that a crash leaves no incomplete results. A folder is
// locked (flock) while it is written. ResultWriter writes all files of a result into a hidden
// folder, and commits the result by renaming that folder. After the commit, ResultWriter moves the
// files of the result into the output folder, and the manifest last. If a process is killed while
// it moves files, the next process that locks the output folder moves the remaining files. The
// process that locks an output folder next also removes results that were not committed. Output
// folders may come from untrusted sources, so links are never followed. Only files that Trackbed
// has written are overwritten or removed (own_files.h).
namespace trackbed {
namespace {

namespace fs = std::filesystem;

// Names of two bookkeeping files in the hidden folder of a result. The file kObsolete lists the
// files to remove, as JSON. The file kWritten lists the files whose writing has begun, one name per
// line.
constexpr const char* kObsolete = ".obsolete";
constexpr const char* kWritten = ".written";

[[noreturn]] void FailToWrite(const fs::path& file, const std::error_code& error) {
  throw RunError(fmt::format("cannot write {}: {}", file.string(), error.message()));
}

/// Describes the process that holds the lock of a folder, such as " (process 123)", using the
/// kernel's list of locks. Returns an empty text if the holder of the lock is unknown.
std::string Holder(int descriptor) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) {
    return "";
  }
  const std::string own =
      fmt::format("{:02x}:{:02x}:{}", major(status.st_dev), minor(status.st_dev), status.st_ino);
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    // Format of a line in /proc/locks, the kernel's list of file locks:
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

/// Tries to lock an open folder. TryLock returns EWOULDBLOCK if another process holds the lock,
/// else 0. TryLock also returns 0 if the file system does not support locks.
int TryLock(int descriptor, int how) {
  return ::flock(descriptor, how | LOCK_NB) != 0 && errno == EWOULDBLOCK ? EWOULDBLOCK : 0;
}

/// Returns whether the path is a folder and not a link to a folder. A run folder may come from an
/// untrusted source, so Trackbed must not change the target of a link.
bool IsFolder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(fs::symlink_status(path, ignored));
}

/// Reads the names of the files that a committed result removes. ObsoleteNames returns an empty
/// list if the result has no list of files to remove.
std::vector<std::string> ObsoleteNames(const fs::path& complete) {
  std::error_code ignored;
  const fs::path file = complete / kObsolete;
  if (!fs::is_regular_file(fs::symlink_status(file, ignored))) {
    return {};
  }
  try {
    return JsonValue(ParseJson(file), file.string()).Texts();
  } catch (const InputError&) {
    return {};  // if the list of obsolete files is damaged, remove no file
  }
}

/// Removes the obsolete files that a committed result lists, and then moves the files of the result
/// into the output folder, with the manifest last. MoveIntoPlace also continues an interrupted
/// move. Files that Trackbed has not written stay where they are, in the output folder and in the
/// hidden folder.
void MoveIntoPlace(const fs::path& folder) {
  const fs::path complete = folder / run_folder::kComplete;
  const auto fail = [&](const fs::path& file, const std::string& why) {
    throw RunError(
        fmt::format("cannot write {}: {}; the result is complete in {}, from where the "
                    "next trackbed that writes here will move it into place",
                    file.string(), why, complete.string()));
  };
  const auto check = [&](const fs::path& file, const std::error_code& error) {
    if (error) {
      fail(file, error.message());
    }
  };
  const std::optional<Manifest> before = ReadManifest(folder);
  const auto is_own = [&](const std::string& name) {
    return IsOwnOrAbsent(folder, name, before ? &*before : nullptr);
  };
  std::error_code error;
  for (const std::string& name : ObsoleteNames(complete)) {
    if (IsFileName(name) && is_own(name)) {
      fs::remove(folder / name, error);
      check(folder / name, error);
    }
  }
  const std::optional<Manifest> now = ReadManifest(complete);
  std::vector<std::string> names;
  for (fs::directory_iterator at(complete, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (now && now->Lists(name) && IsFileName(name) && name != run_folder::kManifest &&
        fs::is_regular_file(at->symlink_status(error))) {
      names.push_back(name);
    }
  }
  check(complete, error);
  for (const std::string& name : names) {
    if (!is_own(name)) {
      fail(folder / name, "Trackbed has not written the file of that name; move it away");
    }
    fs::rename(complete / name, folder / name, error);
    check(folder / name, error);
  }
  if (now) {
    fs::rename(complete / run_folder::kManifest, folder / run_folder::kManifest, error);
    check(folder / run_folder::kManifest, error);
  }
  RemoveHiddenFolder(complete, {kObsolete, kWritten});
}

/// Removes the incomplete result that a killed process left in the folder.
void RemovePartial(const fs::path& folder) {
  const fs::path partial = folder / run_folder::kPartial;
  std::vector<std::string> names{kObsolete, kWritten, run_folder::kManifest};
  std::error_code ignored;
  if (fs::is_regular_file(fs::symlink_status(partial / kWritten, ignored))) {
    std::istringstream lines(ReadFile(partial / kWritten));
    for (std::string name; std::getline(lines, name);) {
      names.push_back(name);
    }
  }
  std::erase_if(names, [](const std::string& name) {
    return name != kObsolete && name != kWritten && !IsFileName(name);
  });
  RemoveHiddenFolder(partial, names);
}

bool NeedsRecovery(const fs::path& folder) {
  return IsFolder(folder / run_folder::kPartial) || IsFolder(folder / run_folder::kComplete);
}

/// If a killed process left a result in a hidden folder, moves a complete result into place and
/// deletes an incomplete result. The caller of Recover must hold the lock of the folder.
void Recover(const fs::path& folder) {
  if (IsFolder(folder / run_folder::kPartial)) {
    RemovePartial(folder);
  }
  if (IsFolder(folder / run_folder::kComplete)) {
    MoveIntoPlace(folder);
  }
}

/// Throws RunError if something other than a folder, such as a link, has the name of a hidden
/// folder.
void RequireHiddenFolders(const fs::path& folder) {
  for (const char* name : {run_folder::kPartial, run_folder::kComplete}) {
    static_cast<void>(FolderBelow(folder, name));
  }
}

}  // namespace

OutputFolder::OutputFolder(fs::path path, For use) : path_(std::move(path)) {
  Open(use);
  if (use == For::kResult && lock_.get() >= 0) {
    RequireHiddenFolders(path_);
    RequireNoForeignFiles(path_, run_folder::AllNames());
  }
}

void OutputFolder::Open(For use) {
  if (path_.empty()) {
    path_ = ".";
  }
  if (use == For::kResult) {
    MakeFolder(path_);
  }
  lock_ = Descriptor(::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (lock_.get() < 0) {
    // Ignore a failure to open the folder: a later read or write reports the same error.
    return;
  }
  Lock(use);
  RemoveAbandonedTemporaries(path_);
}

OutputFolder::OutputFolder(fs::path path, const std::vector<std::string>& names)
    : path_(std::move(path)) {
  Open(For::kResult);
  if (lock_.get() >= 0) {
    RequireHiddenFolders(path_);
    RequireNoForeignFiles(path_, names);
  }
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

std::optional<OutputFolder> LockFolderOf(const fs::path& file, const fs::path& result) {
  const fs::path beside = (fs::path(".") / file).parent_path();
  std::error_code ignored;
  if (fs::equivalent(beside, fs::path(".") / result, ignored)) {
    // A run folder may come from an untrusted source, so a link in the folder must not determine
    // which file is overwritten.
    const fs::file_status status = fs::symlink_status(file, ignored);
    if (fs::exists(status) && !fs::is_regular_file(status)) {
      throw RunError(fmt::format("cannot write {}: it is {}; remove it, or give another place",
                                 file.string(),
                                 fs::is_symlink(status) ? "a link" : "not a regular file"));
    }
    return OutputFolder(beside, OutputFolder::For::kAddition);
  }
  RemoveAbandonedTemporaries(beside);
  return std::nullopt;
}

ResultWriter::ResultWriter(const OutputFolder& folder) : folder_(folder.path()) {
  if (!folder.IsStillThere()) {
    new_folder_.emplace(folder_, std::vector<std::string>());
  }
  if (std::optional<Manifest> before = ReadManifest(folder_)) {
    before_ = std::make_shared<const Manifest>(std::move(*before));
  }
  RemovePartial(folder_);
  const fs::path partial = folder_ / run_folder::kPartial;
  std::error_code error;
  fs::create_directory(partial, error);
  if (error) {
    FailToWrite(folder_, error);
  }
  try {
    written_.emplace(partial / kWritten, folder_ / kWritten);
  } catch (const RunError&) {
    fs::remove(partial, error);
    throw;
  }
}

ResultWriter::~ResultWriter() {
  try {
    RemovePartial(folder_);
  } catch (const std::exception&) {
    // Ignore a failure to remove the partial result, because the next process that writes to the
    // folder reports the same error.
  }
}

void ResultWriter::Add(const std::string& name, std::string_view content) {
  bool given = false;
  Add(name, [&] { return std::exchange(given, true) ? std::string() : std::string(content); });
}

void ResultWriter::Add(const std::string& name, const std::function<std::string()>& next) {
  if (!IsFileName(name)) {
    throw RunError(
        fmt::format("cannot write '{}' to {}: not a plain file name, which has letters, digits, "
                    "'.', '_' and '-', and no leading dot",
                    WithoutControls(name), folder_.string()));
  }
  const fs::path file = folder_ / name;
  // Refuse to replace a file of another program now, because Commit would find it only after all
  // files were written.
  if (name != run_folder::kManifest && !IsOwnOrAbsent(folder_, name, before_.get())) {
    FailAsForeign(file);
  }
  // List the file name before writing the file, so that the list is complete even if the process is
  // killed.
  written_->Write(name + "\n");
  NewFile out(folder_ / run_folder::kPartial / name, file);
  EntryMaker entry;
  for (std::string part = next(); !part.empty(); part = next()) {
    out.Write(part);
    entry.Add(part);
  }
  out.Close();
  if (name != run_folder::kTimingJson) {
    files_[name] = entry.Finish();
  }
  names_.push_back(name);
}

void ResultWriter::EndResult(const std::string& result, std::vector<std::string> obsolete) {
  for (const auto& file : files_) {
    TRACKBED_REQUIRE(IsNameOf(result, file.first),
                     "ResultWriter: AllResultNames lists no file {} of the result {}", file.first,
                     result);
  }
  ended_.push_back({result, std::exchange(files_, {}), std::move(obsolete)});
}

void ResultWriter::Commit(const std::string& result, std::vector<std::string> obsolete) {
  EndResult(result, std::move(obsolete));
  Commit();
}

std::vector<std::string> ResultWriter::ObsoleteFiles() const {
  std::set<std::string> candidates;
  for (const CompletedResult& own : ended_) {
    candidates.insert(own.obsolete.begin(), own.obsolete.end());
    if (before_ == nullptr) {
      continue;
    }
    if (const auto earlier = before_->results.find(own.result); earlier != before_->results.end()) {
      for (const auto& file : earlier->second) {
        candidates.insert(file.first);
      }
    }
    std::copy_if(before_->others.begin(), before_->others.end(),
                 std::inserter(candidates, candidates.end()),
                 [&](const std::string& name) { return IsNameOf(own.result, name); });
  }
  std::vector<std::string> obsolete;
  std::error_code ignored;
  std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(obsolete),
               [&](const std::string& name) {
                 return IsFileName(name) && name != run_folder::kManifest &&
                        fs::exists(fs::symlink_status(folder_ / name, ignored)) &&
                        IsOwnOrAbsent(folder_, name, before_.get()) &&
                        std::find(names_.begin(), names_.end(), name) == names_.end();
               });
  return obsolete;
}

void ResultWriter::Commit() {
  TRACKBED_REQUIRE(files_.empty(), "ResultWriter: Commit before EndResult");
  const std::vector<std::string> obsolete = ObsoleteFiles();
  Manifest manifest = before_ == nullptr ? Manifest{} : *before_;
  for (const CompletedResult& own : ended_) {
    manifest.Take(own.result, own.files, obsolete);
  }
  Add(run_folder::kManifest, manifest.ToJson());
  const fs::path partial = folder_ / run_folder::kPartial;
  WriteNewFile(partial / kObsolete, nlohmann::json(obsolete).dump(), folder_ / kObsolete);
  written_->Close();
  // The rename commits the result: afterwards, this process or the next process moves the files of
  // the result into the folder.
  std::error_code error;
  fs::rename(partial, folder_ / run_folder::kComplete, error);
  if (error) {
    FailToWrite(folder_, error);
  }
  MoveIntoPlace(folder_);
}

}  // namespace trackbed
