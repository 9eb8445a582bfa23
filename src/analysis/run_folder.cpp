#include "trackbed/analysis/run_folder.h"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

#include "src/analysis/manifest.h"
#include "trackbed/analysis/written_names.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/file_name.h"
#include "trackbed/core/hash.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/scenario/record.h"

namespace trackbed::run_folder {
namespace {

constexpr std::string_view kStateEnding = ".state.csv";

/// Makes a file name from the name of a plant. Plant names may come from untrusted files, so Name()
/// rejects names with which the file would lie outside the run folder.
std::string Name(const std::string& plant, std::string_view ending) {
  if (plant.empty() || plant.front() == '.' || plant.find('/') != std::string::npos) {
    throw InputError(Problem{.message = fmt::format("'{}' is no name of a plant", plant)});
  }
  return FileNameOf(plant).append(ending);
}

}  // namespace

std::string LogCsv(const std::string& plant) {
  return Name(plant, ".csv");
}

std::string StateCsv(const std::string& plant) {
  return Name(plant, kStateEnding);
}

std::string NewPlansCsv(const std::string& plant) {
  return Name(plant, ".plan.csv");
}

std::string NewPlansJson(const std::string& plant) {
  return Name(plant, ".plan.json");
}

std::string NewPlansTreeCsv(const std::string& plant) {
  return Name(plant, ".tree.csv");
}

std::optional<std::string> PlantOfStateCsv(const std::string& file_name) {
  // A leading dot marks files that are not completely written.
  if (file_name.size() <= kStateEnding.size() || !file_name.ends_with(kStateEnding) ||
      file_name.front() == '.') {
    return std::nullopt;
  }
  for (const std::string& plant : DrivenPlantNames()) {
    if (StateCsv(plant) == file_name) {
      return plant;
    }
  }
  return file_name.substr(0, file_name.size() - kStateEnding.size());
}

std::string ResidualsCsv(const std::string& record) {
  if (!IsFileName(record)) {
    throw InputError(Problem{.message = fmt::format("'{}' is no name of a record", record)});
  }
  return record + ".residuals.csv";
}

std::vector<std::string> PathFiles() {
  std::vector<std::string> names{kPlanCsv, kScheduleCsv};
  for (const PlannerEntry& planner : Planners()) {
    for (const PlannerTable& table : planner.tables) {
      names.emplace_back(table.file);
    }
  }
  names.emplace_back(kTreeCsv);
  return names;
}

std::vector<std::string> AllNames() {
  std::vector<std::string> names = FileNamesOfVerb("compare");
  names.emplace_back(kManifest);
  return names;
}

std::filesystem::path RequireFile(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    throw InputError(Problem{.file = file.string(), .message = "missing from the run folder"});
  }
  if (std::filesystem::is_directory(file, ignored)) {
    throw InputError(Problem{.file = file.string(), .message = "is a folder, not a file"});
  }
  if (!std::filesystem::is_regular_file(file, ignored)) {
    throw InputError(Problem{.file = file.string(), .message = "is no regular file"});
  }
  if (!ReadAccessError(file.filename(), file.parent_path(), {}).empty()) {
    throw InputError(Problem{.file = file.string(), .message = "is a link out of the run folder"});
  }
  RequireInManifest(file);
  return file;
}

namespace {

std::string ManifestText(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / kManifest;
  std::error_code ignored;
  return std::filesystem::is_regular_file(std::filesystem::symlink_status(file, ignored))
             ? ReadFile(file)
             : "";
}

}  // namespace

std::string ResultHash(const std::filesystem::path& folder) {
  const std::string manifest = ManifestText(folder);
  return manifest.empty() ? "" : Sha256(manifest);
}

void RequireResult(const std::filesystem::path& folder, const std::string& hash,
                   const std::filesystem::path& source) {
  const std::string own = ResultHash(folder);
  std::error_code ignored;
  if (std::filesystem::exists(folder / kComplete, ignored) || (!own.empty() && own != hash)) {
    throw InputError(Problem{.file = folder.string(),
                             .message = fmt::format("has another result than {} tells of: written "
                                                    "by another (interrupted) run; run it again",
                                                    source.filename().string())});
  }
}

Reading::Reading(std::vector<std::filesystem::path> folders) : folders_(std::move(folders)) {
  std::transform(folders_.begin(), folders_.end(), std::back_inserter(manifests_), ManifestText);
}

void Reading::RequireUnchanged() const {
  for (std::size_t i = 0; i < folders_.size(); ++i) {
    if (ManifestText(folders_[i]) != manifests_[i]) {
      throw InputError(Problem{.file = folders_[i].string(),
                               .message = "its result was replaced while it was read; try again"});
    }
  }
}

}  // namespace trackbed::run_folder
