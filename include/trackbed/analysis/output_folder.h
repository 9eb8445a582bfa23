#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trackbed/core/file.h"

/// Output folders. Only one process writes to a folder at a time. A result consists of several
/// files, which are replaced together. If a process is killed or a disk fills up, the folder holds
/// either the earlier result or the new one, never a mixture.
namespace trackbed {

struct Manifest;

/// An output folder, which is locked for this process while the object exists.
///
/// The lock uses flock, which leaves no lock file and is released when the process ends. A second
/// process that opens a locked folder gets an error at once. If a killed process left a complete
/// result, the result is moved into place; incomplete results are removed. On file systems without
/// locks, and between machines that share a folder over NFS, several processes may write to a
/// folder at the same time. The hashes in the manifest then reveal a mixture of results.
class OutputFolder {
 public:
  enum class For {
    kResult,  ///< Exclusive use, to write a result.
    /// Adds a page or film to an existing result; other processes may add at the same time.
    kAddition,
  };
  /// Creates and locks the folder; for an addition, the folder must exist. RunError if the folder
  /// cannot be created or locked, or if another process holds the lock ("... is being written by
  /// another trackbed (process 123)"). For a result, throws the errors of RequireNoForeignFiles
  /// with the names of a run folder (run_folder::AllNames). The constructor is not explicit, so
  /// that callers can pass a path.
  // NOLINTNEXTLINE(google-explicit-constructor)
  OutputFolder(std::filesystem::path path, For use = For::kResult);
  /// Creates and locks the folder for a result whose files may have the given names, such as those
  /// of FileNamesOfVerb. Throws the same RunErrors as the constructor above.
  OutputFolder(std::filesystem::path path, const std::vector<std::string>& names);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Whether the locked folder still exists under its name.
  [[nodiscard]] bool IsStillThere() const;

 private:
  void Open(For use);
  void Lock(For use);

  std::filesystem::path path_;
  Descriptor lock_;
};

/// Locks a folder to write `file`, a page or a film of the result in the folder `result`. If `file`
/// lies in that folder, returns the folder, opened for an addition. Otherwise returns nullopt and
/// removes temporary files that killed processes left next to `file`.
std::optional<OutputFolder> LockFolderOf(const std::filesystem::path& file,
                                         const std::filesystem::path& result);

/// Returns the elements of `names` that exist in the folder but were not written by Trackbed, in
/// their order. Trackbed's files are listed in manifest.json, carry a mark (HasMark), or contain
/// records. Links and folders count as foreign. InputError if manifest.json is invalid.
std::vector<std::string> ForeignNames(const std::filesystem::path& folder,
                                      const std::vector<std::string>& names);

/// Throws RunError listing the ForeignNames, if there are any: Trackbed must not replace files that
/// it did not write.
void RequireNoForeignFiles(const std::filesystem::path& folder,
                           const std::vector<std::string>& names);

/// Throws RunError unless `file` is absent, or is a page, picture or video that Trackbed wrote.
void RequireNoForeignFile(const std::filesystem::path& file);

/// Returns the subfolder `below` of an output folder, such as rows/3. RunError if a part of `below`
/// is a link or a file: Trackbed does not write or remove through links.
std::filesystem::path FolderBelow(const std::filesystem::path& folder,
                                  const std::filesystem::path& below);

/// Removes all results of a folder: the files listed in its manifest, and the pages, pictures and
/// videos that Trackbed made of them. Also removes the folder if it becomes empty. Files that
/// Trackbed did not write stay, and a folder without a manifest stays unchanged. RunError if the
/// folder is a link, or if a file cannot be removed.
void RemoveResults(const std::filesystem::path& folder);

/// The entry of a file in manifest.json.
struct ManifestEntry {
  std::size_t size = 0;  ///< Size in bytes.
  std::string sha256;    ///< SHA-256 in hexadecimal.

  bool operator==(const ManifestEntry&) const = default;
};

/// Writes the files of one or several results, first to a hidden folder inside the output folder.
/// Commit moves all files into place. Without Commit, the output folder does not change.
///
/// The file manifest.json lists names, sizes and SHA-256 of the files. The function
/// run_folder::RequireFile rejects files that differ from the manifest. The manifest drops results
/// whose files were overwritten by another result. Files that belong to no result are not touched.
class ResultWriter {
 public:
  /// Recreates the output folder if it was removed. Throws the same RunErrors as OutputFolder.
  explicit ResultWriter(const OutputFolder& folder);
  ResultWriter(const ResultWriter&) = delete;
  ResultWriter& operator=(const ResultWriter&) = delete;
  ~ResultWriter();

  /// Adds a file. RunError naming the file if it cannot be written, or if `name` is not a plain
  /// file name (IsFileName). RunError if the output folder has a file of that name that Trackbed
  /// did not write.
  void Add(const std::string& name, std::string_view content);
  /// Adds a file in parts: `next` returns one part after another, and an empty part at the end.
  void Add(const std::string& name, const std::function<std::string()>& next);

  /// Makes a result named `result` (run_folder::kRun, ...) of the files added since the last call.
  /// The list AllResultNames must contain the result and its file names. Commit then removes the
  /// files of an earlier result of the same name, and the files in `obsolete` that Trackbed wrote.
  /// Commit keeps files that were added again.
  void EndResult(const std::string& result, std::vector<std::string> obsolete);
  /// Moves all ended results into place at once. RunError if a folder or link has the name of a new
  /// file, or if the disk is full. After an error, the earlier results remain.
  void Commit();
  /// Calls EndResult, then Commit.
  void Commit(const std::string& result, std::vector<std::string> obsolete);

 private:
  struct CompletedResult {
    std::string result;
    std::map<std::string, ManifestEntry> files;
    std::vector<std::string> obsolete;
  };

  [[nodiscard]] std::vector<std::string> ObsoleteFiles() const;

  std::optional<OutputFolder> new_folder_;
  std::filesystem::path folder_;
  std::shared_ptr<const Manifest> before_;      // Manifest of the earlier results; null if none.
  std::optional<NewFile> written_;              // File that stores `names_`.
  std::vector<std::string> names_;              // Names of all files.
  std::map<std::string, ManifestEntry> files_;  // Files added since the last EndResult.
  std::vector<CompletedResult> ended_;
};

}  // namespace trackbed
