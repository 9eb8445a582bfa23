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

/// Output folders. One process writes to a folder at a time, and each result, which consists of
/// several files, is replaced as a whole. If a process is killed or a disk fills up, the folder
/// holds either the earlier result or the new one, never a mixture.
namespace trackbed {

struct Manifest;

/// A folder that this process writes to, as long as the object lives.
///
/// The folder is locked by flock, which leaves no file and ends with the process: a second process
/// that asks for the folder is refused at once. Leftovers of a killed process are removed, or moved
/// into place if its result was complete. On file systems without locks, and between machines that
/// share a folder over NFS, no process is refused; the hashes of the manifest then reveal a
/// mixture.
class OutputFolder {
 public:
  enum class For {
    kResult,    ///< exclusive use
    kAddition,  ///< for a page or film added to an existing result: other processes may add, too
  };
  /// Makes the folder, unless it is for an addition. RunError when that fails; when another process
  /// holds it ("... is being written by another trackbed (process 123)"); and, for a result, as
  /// RequireNoForeignFiles with the names of a run folder (run_folder::AllNames). Not explicit, so
  /// that a caller that writes everything in one call can pass a path.
  // NOLINTNEXTLINE(google-explicit-constructor)
  OutputFolder(std::filesystem::path path, For use = For::kResult);
  /// For a result whose files may have these names, such as those of FileNamesOfVerb. RunError
  /// likewise.
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

/// For work that ends with `file`, a page or a film of the result in the folder `result`. If `file`
/// lies in that folder, returns the folder, opened for an addition. Otherwise returns nothing and
/// only removes leftovers of killed processes beside `file`.
std::optional<OutputFolder> LockFolderOf(const std::filesystem::path& file,
                                         const std::filesystem::path& result);

/// The names of `names` that Trackbed has not written in the folder, in their order: manifest.json
/// does not list them, and neither a mark (HasMark) nor the content of records tells of Trackbed.
/// Links and folders count as well. InputError naming an invalid manifest.
std::vector<std::string> ForeignNames(const std::filesystem::path& folder,
                                      const std::vector<std::string>& names);

/// RunError listing the ForeignNames, if there are any: Trackbed must not replace them.
void RequireNoForeignFiles(const std::filesystem::path& folder,
                           const std::vector<std::string>& names);

/// RunError unless `file` is absent or a page, picture or video of Trackbed's.
void RequireNoForeignFile(const std::filesystem::path& file);

/// The folder `below` in an output folder, such as rows/3. RunError when a part of `below` exists
/// and is a link or a file: nothing is written or removed through links.
std::filesystem::path FolderBelow(const std::filesystem::path& folder,
                                  const std::filesystem::path& below);

/// Removes all results of a folder: the files that its manifest lists, the pages, pictures and
/// videos that Trackbed made of them, and the folder if it is empty then. Files of others stay, and
/// so does a folder without a manifest. RunError for a link, and when a file cannot be removed.
void RemoveResults(const std::filesystem::path& folder);

/// The entry of a file in manifest.json.
struct ManifestEntry {
  std::size_t size = 0;  ///< [bytes]
  std::string sha256;    ///< hexadecimal

  bool operator==(const ManifestEntry&) const = default;
};

/// Writes the files of one or several results, first to a hidden folder inside the output folder.
/// Commit moves all of them into place; without it, nothing changes.
///
/// The file manifest.json then has their names, sizes and SHA-256; run_folder::RequireFile rejects
/// files that differ from it. The manifest drops results whose files were overwritten by another
/// result. Files that belong to no result are not touched.
class ResultWriter {
 public:
  /// Makes the folder again if it was removed. RunError as OutputFolder.
  explicit ResultWriter(const OutputFolder& folder);
  ResultWriter(const ResultWriter&) = delete;
  ResultWriter& operator=(const ResultWriter&) = delete;
  ~ResultWriter();

  /// Adds a file. RunError naming the file in the output folder when it cannot be written, when
  /// `name` is no plain file name (IsFileName), or when Trackbed has not written the file there.
  void Add(const std::string& name, std::string_view content);
  /// Adds a file in parts: `next` returns one part after the other, and an empty one at the end.
  void Add(const std::string& name, const std::function<std::string()>& next);

  /// Makes the files that were added since the last call the result of this name
  /// (run_folder::kRun, ...), which AllResultNames must list with them. Commit then removes the
  /// files of an earlier result of that name, and Trackbed's files of `obsolete`, unless they were
  /// added.
  void EndResult(const std::string& result, std::vector<std::string> obsolete);
  /// Moves all ended results into place at once. RunError when a name is taken by something that is
  /// not a file, or when the disk is full: the earlier results then remain.
  void Commit();
  /// EndResult, then Commit.
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
  std::shared_ptr<const Manifest> before_;      // null: none
  std::optional<NewFile> written_;              // the list of `names_`
  std::vector<std::string> names_;              // of all files
  std::map<std::string, ManifestEntry> files_;  // of the result that has not ended
  std::vector<CompletedResult> ended_;
};

}  // namespace trackbed
