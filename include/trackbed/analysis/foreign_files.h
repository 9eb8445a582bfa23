#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// Keeps files in output folders that Trackbed did not write.
namespace trackbed {

/// Returns the elements of `names` that exist in the folder but were not written by Trackbed, in
/// the order of `names`. A file counts as Trackbed's if it is listed in manifest.json, contains a
/// mark of Trackbed (HasMark), or contains records of a study. Links and folders always count as
/// not written by Trackbed. Throws InputError if manifest.json is invalid.
std::vector<std::string> ForeignNames(const std::filesystem::path& folder,
                                      const std::vector<std::string>& names);

/// Throws RunError if the folder has files that ForeignNames returns, because Trackbed must not
/// replace files that Trackbed did not write. The error message lists the files that Trackbed did
/// not write.
void RequireNoForeignFiles(const std::filesystem::path& folder,
                           const std::vector<std::string>& names);

/// Throws RunError unless `file` is absent, or is a page, picture or video that Trackbed wrote.
void RequireNoForeignFile(const std::filesystem::path& file);

/// Returns the result, such as "run", that lists the file in the manifest.json of the file's
/// folder. Returns "" if no result lists the file, or if the folder has no manifest.json that
/// Trackbed can read.
std::string ResultThatLists(const std::filesystem::path& file);

/// Returns the subfolder `below` of an output folder, such as rows/3. Throws RunError if a part of
/// the path `below` is a link or a file, because Trackbed does not follow links to write or remove
/// files.
std::filesystem::path FolderBelow(const std::filesystem::path& folder,
                                  const std::filesystem::path& below);

/// Removes all results from a folder: the files listed in manifest.json, and the pages, pictures
/// and videos that Trackbed made of the results. RemoveResults also removes the folder if the
/// folder becomes empty. Files that Trackbed did not write remain, and a folder without
/// manifest.json remains unchanged. Throws RunError if the folder is a link, or if a file cannot be
/// removed.
void RemoveResults(const std::filesystem::path& folder);

}  // namespace trackbed
