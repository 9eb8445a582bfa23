#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trackbed/core/file.h"

/// Folders that results are written to: one process at a time, and each result, which is several
/// files, as a whole. Where another process is killed at any moment, or a disk is full, the earlier
/// result or the new one is there, never some files of each.
namespace trackbed {

/// A folder that this process writes to, as long as the object lives.
///
/// It is locked (flock on the folder, which leaves no file, and ends with its process): a second
/// process that asks for it is refused at once. What a killed process left is removed, or moved
/// into place if its result was complete. On file systems without locks, and between the machines
/// that share one over NFS, all are let in; the hashes of the manifest then tell a mixture.
class OutputFolder {
 public:
  enum class For {
    kResult,    ///< alone
    kAddition,  ///< for a page or a film of a result that is there: others may add, too
  };
  /// Makes the folder, unless it is for an addition. RunError when that fails, "... is being
  /// written by another trackbed (process 123)", and, for a result, when the folder has files of
  /// names that results have, but no manifest.json that tells of a result: they are not Trackbed's
  /// to replace. Not explicit: where one call writes all, a path will do.
  // NOLINTNEXTLINE(google-explicit-constructor)
  OutputFolder(std::filesystem::path path, For use = For::kResult);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Whether the folder of that name is still the one that was locked.
  [[nodiscard]] bool IsStillThere() const;

 private:
  void Lock(For use);

  std::filesystem::path path_;
  Descriptor lock_;
};

/// For work that ends with `file`, a page or a film: if it is to lie in `result`, the folder of
/// what it shows, that folder for an addition; elsewhere none, and only what killed processes left
/// beside it is removed.
std::optional<OutputFolder> UseFolderOf(const std::filesystem::path& file,
                                        const std::filesystem::path& result);

/// What manifest.json has of a file.
struct ManifestEntry {
  std::size_t size = 0;  ///< [bytes]
  std::string sha256;    ///< hexadecimal

  bool operator==(const ManifestEntry&) const = default;
};

/// Writes the files of one result, first to a hidden folder inside the output folder. Commit makes
/// them the folder's at once; without it, nothing has changed.
///
/// The file manifest.json then has their names, sizes and SHA-256; run_folder::RequireFile refuses
/// files that are not those it names. Of results whose files were replaced by others it has
/// nothing. Files that are of no result are not touched.
class ResultWriter {
 public:
  /// Makes the folder anew if it is gone. RunError as OutputFolder.
  explicit ResultWriter(const OutputFolder& folder);
  ResultWriter(const ResultWriter&) = delete;
  ResultWriter& operator=(const ResultWriter&) = delete;
  ~ResultWriter();

  /// RunError naming the file in the output folder.
  void Add(const std::string& name, std::string_view content);
  /// Likewise, of content in parts: `next` gives one after the other, and an empty one at the end.
  void Add(const std::string& name, const std::function<std::string()>& next);

  /// The files become the result of this name (run_folder::kRun, ...). Those of an earlier one and
  /// those of `obsolete` that the new one does not have are removed. RunError when a name is taken
  /// by something that is no file, or when the disk is full: the earlier result is still there
  /// then.
  void Commit(const std::string& result, std::vector<std::string> obsolete);

 private:
  std::optional<OutputFolder> anew_;
  std::filesystem::path folder_;
  std::vector<std::string> names_;
  std::map<std::string, ManifestEntry> files_;
};

}  // namespace trackbed
