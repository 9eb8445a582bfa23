#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace trackbed {

/// The whole file as bytes. RunError naming the file when it cannot be read (missing, a folder, …).
std::string ReadFile(const std::filesystem::path& file);

/// Writes `content` beside `file` under a temporary name and renames it, so that `file` is either
/// what it was or complete. RunError (the temporary is removed) when any step fails, such as a full
/// disk or an unwritable folder.
void WriteFileAtomically(const std::filesystem::path& file, std::string_view content);

/// Checks, before long work, that WriteFileAtomically can write the file. RunError as there: the
/// name is a folder's, or its folder is absent or takes no files. Leaves nothing behind.
void CheckCanWrite(const std::filesystem::path& file);

/// Creates the folder and its parents. RunError when that is not possible.
void MakeFolder(const std::filesystem::path& folder);

/// A temporary name in the folder of `file` for use until the content is complete. It has the same
/// extension, for writers that depend on it, and the number of this process.
std::filesystem::path TemporaryNameFor(const std::filesystem::path& file);

/// Writes `content` under TemporaryNameFor(file). RunError (the temporary is removed) naming
/// `file`.
void WriteTemporary(const std::filesystem::path& file, std::string_view content);

/// Removes the temporaries in a folder whose process is no more: it was killed. What cannot be
/// removed stays.
void RemoveAbandonedTemporaries(const std::filesystem::path& folder);

/// Renames a complete temporary to its final name, or to what a link of that name points to.
/// RunError (the temporary is removed) on failure, and when the name is taken by something that is
/// no regular file.
void PublishFile(const std::filesystem::path& temporary, const std::filesystem::path& file);

/// Why an input that lies in `own` may not have the file `name` read, which is relative to `own`,
/// as the end of a sentence ("lies outside of ..."); empty when it may: it lies in `own`, in one of
/// `others` or below, wherever links lead. An absolute name must lie in one of `others`.
std::string WhyUnreadable(const std::filesystem::path& name, const std::filesystem::path& own,
                          const std::vector<std::filesystem::path>& others);

}  // namespace trackbed
