#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trackbed/analysis/foreign_files.h"
#include "trackbed/core/file.h"

/// Output folders. Only one process writes to a folder at a time. A result of Trackbed consists of
/// several files, which are replaced together. If a process is killed or a disk fills up, the
/// folder holds either the earlier or the new result, never a mixture.
namespace trackbed {

struct Manifest;

/// An output folder, which is locked for this process as long as the OutputFolder object exists.
///
/// The lock uses flock, which leaves no lock file and is released when the process ends. If a
/// second process opens a locked folder, the constructor throws an error immediately. If a killed
/// process left a complete result in a hidden folder inside the output folder, the next process
/// that opens the output folder moves that result into place. OutputFolder removes an incomplete
/// result of a killed process. On file systems without locks, and between machines that share a
/// folder over NFS, several processes may write to a folder at the same time. If several processes
/// mix their results in a folder, the hashes in manifest.json reveal the mixture.
class OutputFolder {
 public:
  enum class For {
    kResult,  ///< Writes a result; no other process may use the folder.
    /// Adds a page or video to an existing result; other processes may add files at the same time.
    kAddition,
  };
  /// Creates and locks the output folder. If a page or video is to be added (kAddition), the output
  /// folder must exist. Throws RunError if the folder cannot be created or locked, or if another
  /// process holds the lock ("... is being written by another trackbed (process 123)"). For a
  /// result (kResult), also throws if RequireNoForeignFiles rejects the folder with the file names
  /// of a run (run_folder::AllNames). The constructor is not explicit, so that callers can pass a
  /// path.
  // NOLINTNEXTLINE(google-explicit-constructor)
  OutputFolder(std::filesystem::path path, For use = For::kResult);
  /// Creates and locks the folder for a result whose files may have the names `names`, such as
  /// those that FileNamesOfVerb returns. Throws RunError in the same cases as the constructor
  /// above.
  OutputFolder(std::filesystem::path path, const std::vector<std::string>& names);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Whether the locked folder still exists at `path()`.
  [[nodiscard]] bool IsStillThere() const;

 private:
  void Open(For use);
  void Lock(For use);

  std::filesystem::path path_;
  Descriptor lock_;
};

/// Prepares to write `file`, a page or video of the result in the folder `result`. If `file` lies
/// in the folder `result`, locks and returns the folder, opened for an addition. If `file` lies
/// outside the folder `result`, returns nullopt and removes temporary files that killed processes
/// left next to `file`.
std::optional<OutputFolder> LockFolderOf(const std::filesystem::path& file,
                                         const std::filesystem::path& result);

/// The entry of a file in manifest.json.
struct ManifestEntry {
  std::size_t size = 0;  ///< Size in bytes.
  std::string sha256;    ///< SHA-256 in hexadecimal.

  bool operator==(const ManifestEntry&) const = default;
};

/// Writes the files of one or several results to a hidden folder inside the output folder; Commit
/// then moves all files into place. Without a call of Commit, the existing files of the output
/// folder do not change.
///
/// ResultWriter lists the names, sizes and SHA-256 hashes of the files in manifest.json. The
/// function run_folder::RequireFile rejects files that differ from manifest.json. If a new result
/// overwrites files of an earlier result, the earlier result is removed from manifest.json.
/// ResultWriter leaves files that belong to no result unchanged.
class ResultWriter {
 public:
  /// Recreates the output folder if the folder was removed meanwhile. Throws RunError in the same
  /// cases as the constructor of OutputFolder.
  explicit ResultWriter(const OutputFolder& folder);
  ResultWriter(const ResultWriter&) = delete;
  ResultWriter& operator=(const ResultWriter&) = delete;
  ~ResultWriter();

  /// Adds a file. Throws RunError, naming the file, if the file cannot be written, or if `name` is
  /// not a plain file name (IsFileName). Throws RunError if the output folder already has a file
  /// `name` that Trackbed did not write.
  void Add(const std::string& name, std::string_view content);
  /// Adds a file whose content is returned in parts by repeated calls of `next`; an empty part ends
  /// the file.
  void Add(const std::string& name, const std::function<std::string()>& next);

  /// Groups the files added since the last call of EndResult as the result named `result`, such as
  /// run_folder::kRun. AllResultNames must list the result and its file names. When Commit is
  /// called, it removes the files of an earlier result with the same name, and those files in
  /// `obsolete` that Trackbed wrote. Commit keeps files of the earlier result that were added
  /// again.
  void EndResult(const std::string& result, std::vector<std::string> obsolete);
  /// Moves the files of all results for which EndResult was called into place, in one step. Throws
  /// RunError if a folder or link has the name of a new file, or if the disk is full. If Commit
  /// throws, the earlier results remain in the folder.
  void Commit();
  /// Calls EndResult with the same arguments, then Commit without arguments.
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
  // Manifest of the earlier results; null if there are no earlier results.
  std::shared_ptr<const Manifest> before_;
  std::optional<NewFile> written_;              // File that stores the elements of `names_`.
  std::vector<std::string> names_;              // Names of all files added to the writer.
  std::map<std::string, ManifestEntry> files_;  // Files added since the last EndResult.
  std::vector<CompletedResult> ended_;
};

}  // namespace trackbed
