#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// Which files of an output folder Trackbed has written, and may replace or remove.
namespace trackbed {

struct Manifest;

/// Whether nothing has this name in the folder, or a regular file that Trackbed has written: the
/// manifest (null: none) lists it, it carries a mark (HasMark), or it is a file of records.
bool IsOwnOrAbsent(const std::filesystem::path& folder, const std::string& name,
                   const Manifest* manifest);

/// RunError saying what has the name that IsOwnOrAbsent refuses.
[[noreturn]] void FailAsForeign(const std::filesystem::path& file);

/// Removes the regular files of these names, and the folder. RunError for a link, and listing the
/// files of others, which stay. Absent folders are fine.
void RemoveHiddenFolder(const std::filesystem::path& folder, const std::vector<std::string>& names);

}  // namespace trackbed
