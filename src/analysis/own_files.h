#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// Functions that determine which files in an output folder were written by Trackbed; Trackbed may
/// replace or remove only these files.
namespace trackbed {

struct Manifest;

/// Returns the file status of a path; for a link, returns the status of the link and not of its
/// target.
std::filesystem::file_status StatusOf(const std::filesystem::path& path);

/// Returns the kind of a file for messages: "a link", "a folder", "a file".
const char* KindOf(const std::filesystem::file_status& status);

/// Returns the sorted names of the files in a folder; an empty list if the folder cannot be read.
std::vector<std::string> NamesIn(const std::filesystem::path& folder);

/// Removes a file or an empty folder. Throws RunError if the removal fails.
void Remove(const std::filesystem::path& file);

/// Returns true if the folder contains no file with this name, or if the file with this name is a
/// regular file that Trackbed has written. A file counts as written by Trackbed if `manifest` is
/// not null and lists the file, or if the file carries a mark (HasMark). A file that contains the
/// records of a study also counts as written by Trackbed.
bool IsOwnOrAbsent(const std::filesystem::path& folder, const std::string& name,
                   const Manifest* manifest);

/// Throws RunError with the message that Trackbed has not written `file` and therefore does not
/// replace it.
[[noreturn]] void FailAsForeign(const std::filesystem::path& file);

/// Removes the regular files with these names from a hidden folder, then removes the folder.
/// RemoveHiddenFolder throws RunError if the folder is a link. If the folder contains files that
/// Trackbed has not written, RemoveHiddenFolder keeps these files and throws a RunError that lists
/// them. RemoveHiddenFolder does nothing if the folder does not exist.
void RemoveHiddenFolder(const std::filesystem::path& folder, const std::vector<std::string>& names);

}  // namespace trackbed
