#include "trackbed/analysis/output_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <system_error>
#include <utility>

#include "src/analysis/manifest.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

/// Lists the files to remove, as JSON.
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

/// Whether it is a folder itself, and not a link to one: a run folder may come from anybody, and
/// what a link points to must stay there.
bool IsFolder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(fs::symlink_status(path, ignored));
}

/// The list of files to remove; none where there is no such list.
std::vector<std::string> ObsoleteNames(const fs::path& complete) {
  std::error_code ignored;
  const fs::path file = complete / kObsolete;
  if (!fs::is_regular_file(fs::symlink_status(file, ignored))) {
    return {};
  }
  const auto list = nlohmann::json::parse(ReadFile(file), nullptr, false);
  return list.is_array() && std::all_of(list.begin(), list.end(),
                                        [](const auto& name) { return name.is_string(); })
             ? list.get<std::vector<std::string>>()
             : std::vector<std::string>();
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
  for (const std::string& name : ObsoleteNames(complete)) {
    // A name from an old manifest must not lead out of the folder.
    if (!name.empty() && name.find('/') == std::string::npos &&
        !fs::is_directory(fs::symlink_status(folder / name, error))) {
      fs::remove(folder / name, error);
      check(folder / name, error);
    }
  }
  std::vector<std::string> names;
  for (fs::directory_iterator at(complete, error), end; !error && at != end; at.increment(error)) {
    // Only what a ResultWriter has put there.
    if (fs::is_regular_file(at->symlink_status(error))) {
      names.push_back(at->path().filename());
    }
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
  return IsFolder(folder / run_folder::kPartial) || IsFolder(folder / run_folder::kComplete);
}

/// What a process that was killed left there. Only with the lock.
void Recover(const fs::path& folder) {
  std::error_code error;
  fs::remove_all(folder / run_folder::kPartial, error);
  if (IsFolder(folder / run_folder::kComplete)) {
    MoveIntoPlace(folder);
  }
}

/// Whether the folder has the manifest of a result. InputError as ReadManifest.
bool HasManifest(const fs::path& folder) {
  return ReadManifest(folder).has_value();
}

/// RunError when there are files of names that results have, but no manifest that tells of any:
/// they are somebody's own.
void RequireNoForeignFiles(const fs::path& folder) {
  if (HasManifest(folder)) {
    return;
  }
  std::vector<std::string> names = run_folder::AllNames();
  for (const char* name : {run_folder::kSweepCsv, run_folder::kSweepJson}) {
    names.emplace_back(name);
  }
  std::vector<std::string> found;
  std::error_code ignored;
  for (const std::string& name : names) {
    if (fs::exists(fs::symlink_status(folder / name, ignored))) {
      found.push_back(name);
    }
  }
  if (!found.empty()) {
    throw RunError(
        fmt::format("{} has files that are of no result, as there is no {}: {}; choose "
                    "another folder, or remove them",
                    folder.string(), run_folder::kManifest, fmt::join(found, ", ")));
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
  if (use == For::kResult) {
    RequireNoForeignFiles(path_);
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

std::optional<OutputFolder> UseFolderOf(const fs::path& file, const fs::path& result) {
  const fs::path beside = (fs::path(".") / file).parent_path();
  std::error_code ignored;
  if (fs::equivalent(beside, fs::path(".") / result, ignored)) {
    // A run folder may come from anybody; a link in it must not choose what is overwritten.
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
  bool given = false;
  Add(name, [&] { return std::exchange(given, true) ? std::string() : std::string(content); });
}

void ResultWriter::Add(const std::string& name, const std::function<std::string()>& next) {
  const fs::path file = folder_ / name;
  std::error_code error;
  // Links are replaced, but not what else is in the way: Commit would find it too late.
  if (fs::is_directory(file, error)) {
    FailToWrite(file, std::make_error_code(std::errc::is_a_directory));
  }
  if (fs::exists(file, error) && !fs::is_regular_file(file, error)) {
    throw RunError(fmt::format("cannot write {}: it is not a regular file", file.string()));
  }
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

void ResultWriter::Commit(const std::string& result, std::vector<std::string> obsolete) {
  const std::optional<Manifest> before = ReadManifest(folder_);
  Manifest manifest = before.value_or(Manifest{});
  if (!before) {
    obsolete.clear();  // what is there is of nobody's result
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
  WriteNewFile(
      folder_ / run_folder::kPartial / kObsolete,
      nlohmann::json(obsolete).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace),
      folder_ / kObsolete);
  // The commit point: from here on the new result is moved into place, if not by this process then
  // by the next one.
  fs::rename(folder_ / run_folder::kPartial, folder_ / run_folder::kComplete, error);
  if (error) {
    FailToWrite(folder_, error);
  }
  MoveIntoPlace(folder_);
}

}  // namespace trackbed
