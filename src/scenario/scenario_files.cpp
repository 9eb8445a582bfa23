#include "trackbed/scenario/scenario_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>
#include <system_error>

#include "trackbed/core/error.h"
#include "trackbed/core/spelling.h"
#include "trackbed/path_files/path_file.h"
#include "trackbed/scenario/identification.h"
#include "trackbed/scenario/map_file.h"
#include "trackbed/scenario/record.h"
#include "trackbed/scenario/study_reader.h"
#include "trackbed/sim/scene.h"

namespace trackbed {

namespace fs = std::filesystem;

namespace {

using Accepts = std::function<bool(const fs::path&)>;

/// Returns whether a YAML file is a scenario (or a study, if `content` asks for studies). Reads the
/// file.
bool IsContent(const fs::path& file, FolderContent content) {
  const bool is_study = IsStudy(file) || IsIdentification(file);
  return (content == FolderContent::kScenariosAndStudies || !is_study) && !IsLogMap(file) &&
         !IsRosMap(file) && !IsNavPathYaml(file);
}

/// Appends the YAML files in `folder` for which `accepts` returns true, followed by those in its
/// subfolders.
void AddFilesIn(const fs::path& folder, const Accepts& accepts, std::vector<fs::path>& files) {
  std::vector<fs::path> own;
  std::vector<fs::path> folders;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const fs::path& path = entry->path();
    const std::string extension = path.extension().string();
    if (path.filename().string().starts_with('.')) {
      continue;
    }
    if (entry->is_directory()) {
      if (!entry->is_symlink()) {
        folders.push_back(path);
      }
    } else if (extension == ".yaml" || extension == ".yml") {
      if (accepts(path)) {
        own.push_back(path);
      }
    }
  }
  if (error) {
    throw RunError(fmt::format("cannot read {}: {}", folder.string(), error.message()));
  }
  std::sort(own.begin(), own.end());
  std::sort(folders.begin(), folders.end());
  files.insert(files.end(), own.begin(), own.end());
  for (const fs::path& inner : folders) {
    AddFilesIn(inner, accepts, files);
  }
}

/// Returns the scenario files shipped with Trackbed for which `accepts` returns true.
std::vector<fs::path> ShippedFiles(const Accepts& accepts) {
  std::vector<fs::path> files;
  const Accepts installed = [&](const fs::path& file) {
    return file.parent_path().filename() != "validation" && accepts(file);
  };
  AddFilesIn(DataFolder() / "scenarios", installed, files);
  return files;
}

/// Returns the path of a shipped file inside of the folder of scenarios, without its extension.
fs::path NameOf(const fs::path& file) {
  return file.lexically_relative(DataFolder() / "scenarios").replace_extension();
}

}  // namespace

std::vector<fs::path> ShippedScenarios(FolderContent content) {
  return ShippedFiles([content](const fs::path& file) { return IsContent(file, content); });
}

fs::path FindScenario(const fs::path& name) {
  std::error_code ignored;
  if (fs::exists(fs::symlink_status(name, ignored)) || name.has_extension() || name.is_absolute()) {
    return name;
  }
  const std::vector<fs::path> found = ShippedFiles([&](const fs::path& file) {
    const fs::path inside = NameOf(file);
    return (inside == name || inside.filename() == name) &&
           IsContent(file, FolderContent::kScenariosAndStudies);
  });
  if (found.size() == 1) {
    return found.front();
  }
  if (found.size() > 1) {
    throw InputError(Problem{.file = name.string(),
                             .message = fmt::format("is the name of {} and of {}",
                                                    found[0].string(), found[1].string())});
  }
  std::vector<std::string> names;
  for (const fs::path& file : ShippedScenarios(FolderContent::kScenariosAndStudies)) {
    names.push_back(NameOf(file).filename().string());
  }
  const std::string nearest = NearestSpelling(name.string(), names);
  throw InputError(Problem{
      .file = name.string(),
      .message = fmt::format("no such file, and no scenario of this name comes with Trackbed{}",
                             nearest.empty() ? "; `trackbed list scenarios` names those that do"
                                             : fmt::format("; did you mean '{}'?", nearest))});
}

std::vector<fs::path> ScenarioFiles(const std::vector<std::string>& paths, FolderContent content) {
  std::vector<fs::path> found;
  for (const std::string& path : paths) {
    const std::size_t before = found.size();
    if (fs::is_directory(path)) {
      AddFilesIn(
          path, [content](const fs::path& file) { return IsContent(file, content); }, found);
    }
    if (found.size() == before) {
      found.push_back(FindScenario(path));
    }
  }
  std::vector<fs::path> files;
  std::set<fs::path> known;
  for (const fs::path& file : found) {
    if (known.insert(fs::absolute(file).lexically_normal()).second) {
      files.push_back(file);
    }
  }
  return files;
}

void RefuseFolder(const fs::path& file) {
  if (fs::is_directory(file)) {
    throw InputError(
        Problem{.file = file.string(), .message = "the folder has no scenarios (*.yaml, *.yml)"});
  }
}

}  // namespace trackbed
