#include "trackbed/analysis/run_folder.h"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

#include "src/analysis/manifest.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/path_files/path_file.h"
#include "trackbed/recording/record_csv.h"
#include "trackbed/road_network/open_drive.h"
#include "trackbed/scenario/map_file.h"
#include "trackbed/scenario/record.h"
#include "trackbed/scenario/recording_file.h"
#include "trackbed/sim/plant.h"
#include "trackbed/track/track_file.h"

namespace trackbed::run_folder {
namespace {

constexpr std::string_view kStateEnding = ".state.csv";

/// The names of plants come from files, too, and must not lead out of the folder.
std::string Name(const std::string& plant, std::string_view ending) {
  if (plant.empty() || plant.front() == '.' || plant.find('/') != std::string::npos) {
    throw InputError(Problem{.message = fmt::format("'{}' is no name of a plant", plant)});
  }
  return PlantFileName(plant).append(ending);
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
  // Names with a leading dot are files that a writer has not finished.
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
  return record + ".residuals.csv";
}

std::vector<std::string> AllNames() {
  std::vector<std::string> names{kManifest,   kScenarioYaml, kModelXml,   kPlanJson,
                                 kTimingJson, kMetricsJson,  kMcap,       kVideo,
                                 kPicture,    kReport,       kCompareCsv, kCompareJson};
  names.emplace_back(kRecordingCsv);
  names.emplace_back(kRecordCsv);
  names.emplace_back(kPathCsv);
  names.emplace_back(kTrackCsv);
  names.emplace_back(kMapYaml);
  names.emplace_back(kMapPgm);
  names.emplace_back(kRoadNetworkXodr);
  names.insert(names.end(), kPathFiles.begin(), kPathFiles.end());
  for (const std::string& plant : DrivenPlantNames()) {
    for (const auto name_of : {LogCsv, StateCsv, NewPlansCsv, NewPlansJson, NewPlansTreeCsv}) {
      names.push_back(name_of(plant));
    }
  }
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
  if (!WhyUnreadable(file.filename(), file.parent_path(), {}).empty()) {
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
