#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// Determines which files of an output folder Trackbed has written and may therefore replace or
/// remove.
namespace trackbed {

struct Manifest;

/// Returns whether the folder has no file with this name, or a regular file that Trackbed has
/// written. A file counts as written by Trackbed if the manifest (null: none) lists the file, if
/// the file carries a mark (HasMark), or if the file contains the records of a study.
bool IsOwnOrAbsent(const std::filesystem::path& folder, const std::string& name,
                   const Manifest* manifest);

/// Throws a RunError that names a file which Trackbed has not written and must not replace.
[[noreturn]] void FailAsForeign(const std::filesystem::path& file);

/// Removes the regular files with these names from a hidden folder, then removes the folder.
/// RemoveHiddenFolder throws RunError if the folder is a link. If the folder contains files that
/// Trackbed has not written, RemoveHiddenFolder keeps these files and throws a RunError that lists
/// them. RemoveHiddenFolder ignores absent folders.
void RemoveHiddenFolder(const std::filesystem::path& folder, const std::vector<std::string>& names);

}  // namespace trackbed
