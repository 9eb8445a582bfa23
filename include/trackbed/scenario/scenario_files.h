#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// Finds scenario files by name and in folders.
namespace trackbed {

/// Kinds of files for which a folder is searched.
enum class FolderContent { kScenarios, kScenariosAndStudies };

/// Returns the scenario files (and study files, if `content` asks for studies) that are shipped
/// with Trackbed. The files of each folder precede the files of its subfolders. The list of shipped
/// scenarios excludes scenarios/validation, whose recordings are not installed.
std::vector<std::filesystem::path> ShippedScenarios(FolderContent content);

/// Finds the scenario file or study file that a name refers to. FindScenario returns an existing
/// file, or a name with an extension, unchanged. A name without an extension that is no existing
/// file refers to a shipped scenario or study, such as "three_turns", "studies/robustness" or
/// "robustness". Throws InputError if several shipped files match the name. For an unknown name,
/// FindScenario throws InputError that suggests the most similar name. If shipped files match the
/// name, FindScenario reads only the matching files.
std::filesystem::path FindScenario(const std::filesystem::path& name);

/// Returns the scenario files that `paths` name, without duplicates. FindScenario resolves each of
/// the `paths` that is not a folder. A folder is replaced by all its *.yaml and *.yml files,
/// sorted, with files before subfolders. ScenarioFiles skips hidden files and folders (.git) and
/// links to folders. If a folder contains no scenarios, the returned list contains the folder
/// itself, so that RefuseFolder can report the folder. ScenarioFiles throws RunError if a folder
/// cannot be read.
std::vector<std::filesystem::path> ScenarioFiles(const std::vector<std::string>& paths,
                                                 FolderContent content);

/// Throws InputError if `file` is a folder without scenarios.
void RefuseFolder(const std::filesystem::path& file);

}  // namespace trackbed
