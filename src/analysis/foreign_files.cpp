#include "trackbed/analysis/foreign_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <set>

#include "src/analysis/manifest.h"
#include "src/analysis/own_files.h"
#include "trackbed/analysis/output_folder.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/analysis/written_names.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file_name.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

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

std::vector<std::string> ForeignNames(const fs::path& folder,
                                      const std::vector<std::string>& names) {
  const auto look = [&] {
    // Another process that is still running or was killed may have moved only some files of its
    // result from the hidden folder into the output folder. Read the manifest of the hidden folder
    // first, so that a manifest that is moved between the two reads is not missed.
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

std::string ResultThatLists(const fs::path& file) {
  std::error_code error;
  const fs::path real = fs::weakly_canonical(fs::absolute(file), error);
  const std::string name = real.filename().string();
  std::optional<Manifest> manifest;
  try {
    manifest = ReadManifest(real.parent_path());
  } catch (const InputError&) {
    return "";  // another program wrote this invalid manifest
  }
  if (error || !manifest || !fs::exists(StatusOf(real))) {
    return "";
  }
  for (const auto& [result, files] : manifest->results) {
    if (name == run_folder::kManifest || files.find(name) != files.end()) {
      return result;
    }
  }
  return "";
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
