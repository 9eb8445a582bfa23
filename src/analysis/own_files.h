#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// Decides which files of an output folder Trackbed has written, and may replace or remove.
namespace trackbed {

struct Manifest;

/// Whether the name is free in the folder or belongs to a regular file that Trackbed has written.
/// Trackbed has written a file that the manifest (null: none) lists, that carries a mark (HasMark),
/// or that is a file of records.
bool IsOwnOrAbsent(const std::filesystem::path& folder, const std::string& name,
                   const Manifest* manifest);

/// Throws RunError that describes the file for which IsOwnOrAbsent returns false.
[[noreturn]] void FailAsForeign(const std::filesystem::path& file);

/// Removes the regular files with these names, then the folder. RemoveHiddenFolder throws RunError
/// for a link. RemoveHiddenFolder throws RunError listing the files that Trackbed has not written,
/// which stay. RemoveHiddenFolder ignores absent folders.
void RemoveHiddenFolder(const std::filesystem::path& folder, const std::vector<std::string>& names);

}  // namespace trackbed
