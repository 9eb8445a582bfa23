#include "src/analysis/own_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <set>
#include <system_error>

#include "src/analysis/manifest.h"
#include "trackbed/analysis/output_folder.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/analysis/sweep_records.h"
#include "trackbed/analysis/written_names.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file_name.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

/// Returns the file status of a path; for a link, returns the status of the link and not of its
/// target.
fs::file_status StatusOf(const fs::path& path) {
  std::error_code ignored;
  return fs::symlink_status(path, ignored);
}

const char* KindOf(const fs::file_status& status) {
  return fs::is_symlink(status)        ? "a link"
         : fs::is_directory(status)    ? "a folder"
         : fs::is_regular_file(status) ? "a file"
                                       : "not a regular file";
}

std::vector<std::string> NamesIn(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    names.push_back(at->path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

void Remove(const fs::path& file) {
  std::error_code error;
  fs::remove(file, error);
  if (error) {
    throw RunError(fmt::format("cannot remove {}: {}", file.string(), error.message()));
  }
}

/// Returns the names of all files that Trackbed may have written to the folder, except the
/// manifest.
std::set<std::string> NamesOf(const Manifest& manifest) {
  std::set<std::string> names = manifest.others;
  names.insert(
      {run_folder::kTimingJson, run_folder::kReport, run_folder::kVideo, run_folder::kPicture});
  for (const auto& result : manifest.results) {
    for (const auto& file : result.second) {
      names.insert(file.first);
    }
  }
  names.erase(run_folder::kManifest);
  return names;
}

}  // namespace

bool IsOwnOrAbsent(const fs::path& folder, const std::string& name, const Manifest* manifest) {
  const fs::path file = folder / name;
  const fs::file_status status = StatusOf(file);
  if (!fs::exists(status)) {
    return true;
  }
  return fs::is_regular_file(status) &&
         ((manifest != nullptr && manifest->Lists(name)) || HasMark(file) ||
          (name == run_folder::kSweepRecords && SweepRecords::IsFileOfRecords(file)));
}

void FailAsForeign(const fs::path& file) {
  const fs::file_status status = StatusOf(file);
  const std::string what = fs::is_regular_file(status)
                               ? "Trackbed has not written the file of that name"
                               : fmt::format("it is {}", KindOf(status));
  throw RunError(fmt::format("cannot write {}: {}; move it away, or choose another place (-o)",
                             file.string(), what));
}

void RemoveHiddenFolder(const fs::path& folder, const std::vector<std::string>& names) {
  const fs::file_status status = StatusOf(folder);
  if (!fs::exists(status)) {
    return;
  }
  if (!fs::is_directory(status)) {
    throw RunError(fmt::format("{} is {}, not the folder that Trackbed makes there; remove it",
                               folder.string(), KindOf(status)));
  }
  for (const std::string& name : names) {
    if (fs::is_regular_file(StatusOf(folder / name))) {
      Remove(folder / name);
    }
  }
  if (const std::vector<std::string> left = NamesIn(folder); !left.empty()) {
    throw RunError(fmt::format("{} has files that Trackbed has not written: {}; move them away",
                               folder.string(), fmt::join(left, ", ")));
  }
  Remove(folder);
}

std::vector<std::string> ForeignNames(const fs::path& folder,
                                      const std::vector<std::string>& names) {
  const auto look = [&] {
    // Another process may have moved only some files of a result into the folder, because the
    // process is still running or was killed. Read the manifest of the hidden folder first, because
    // that manifest is moved into the folder last.
    const std::optional<Manifest> next = ReadManifest(folder / run_folder::kComplete);
    const std::optional<Manifest> manifest = ReadManifest(folder);
    std::vector<std::string> foreign;
    std::copy_if(names.begin(), names.end(), std::back_inserter(foreign),
                 [&](const std::string& name) {
                   // Skip the manifest, because ReadManifest has already checked that Trackbed
                   // wrote it.
                   return name != run_folder::kManifest &&
                          !IsOwnOrAbsent(folder, name, manifest ? &*manifest : nullptr) &&
                          !IsOwnOrAbsent(folder, name, next ? &*next : nullptr);
                 });
    return foreign;
  };
  // If the first check finds foreign files, check a second time, because another process may have
  // moved files after the first check read the manifests.
  return look().empty() ? std::vector<std::string>() : look();
}

void RequireNoForeignFiles(const fs::path& folder, const std::vector<std::string>& names) {
  if (const std::vector<std::string> foreign = ForeignNames(folder, names); !foreign.empty()) {
    throw RunError(
        fmt::format("{} has files that Trackbed has not written, according to its {}: "
                    "{}; move them away, or choose another folder (-o)",
                    folder.string(), run_folder::kManifest, fmt::join(foreign, ", ")));
  }
}

void RequireNoForeignFile(const fs::path& file) {
  if (fs::exists(StatusOf(file)) && !HasMark(file)) {
    FailAsForeign(file);
  }
}

fs::path FolderBelow(const fs::path& folder, const fs::path& below) {
  fs::path path = folder;
  for (const fs::path& part : below) {
    path /= part;
    const fs::file_status status = StatusOf(path);
    if (fs::exists(status) && !fs::is_directory(status)) {
      throw RunError(
          fmt::format("cannot write to {}: it is {}, not a folder; remove it, or choose "
                      "another output folder (-o)",
                      path.string(), KindOf(status)));
    }
  }
  return path;
}

void RemoveResults(const fs::path& folder) {
  const fs::file_status status = StatusOf(folder);
  if (!fs::exists(status)) {
    return;
  }
  if (!fs::is_directory(status)) {
    throw RunError(fmt::format("{} is {}, and nothing is removed through it; remove it",
                               folder.string(), KindOf(status)));
  }
  const OutputFolder locked(folder, std::vector<std::string>());
  const std::optional<Manifest> manifest = ReadManifest(folder);
  if (!manifest) {
    return;
  }
  for (const std::string& name : NamesOf(*manifest)) {
    const bool exists = fs::exists(StatusOf(folder / name));
    if (exists && IsFileName(name) && IsOwnOrAbsent(folder, name, &*manifest)) {
      Remove(folder / name);
    }
  }
  // Remove the manifest last, because the manifest lists all other files that Trackbed has written.
  Remove(folder / run_folder::kManifest);
  if (NamesIn(folder).empty()) {
    Remove(folder);
  }
}

}  // namespace trackbed
