#include "src/analysis/own_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <system_error>

#include "src/analysis/manifest.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/analysis/sweep_records.h"
#include "trackbed/analysis/written_names.h"
#include "trackbed/core/error.h"

namespace trackbed {

namespace fs = std::filesystem;

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

}  // namespace trackbed
