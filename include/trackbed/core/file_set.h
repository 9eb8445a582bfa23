#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace trackbed {

/// The files of one result, which replace those of an earlier one in a folder.
///
/// Each is written beside its final name under a temporary one. Only when all are on the disk does
/// Commit remove the earlier result's files and rename the new ones, the one that tells of a
/// complete result last. So a full disk, or a process that is killed while it writes, leaves the
/// earlier result as it was; one that is killed within Commit leaves files without that last one.
/// Files of other names are not touched.
///
/// Does not: call fsync. After a power failure the file system decides what is there.
class FileSet {
 public:
  /// Creates the folder if it is missing; RunError when that is not possible.
  explicit FileSet(std::filesystem::path folder);
  FileSet(const FileSet&) = delete;
  FileSet& operator=(const FileSet&) = delete;
  /// Removes what was not committed.
  ~FileSet();

  /// Writes a file. RunError naming its final name when that fails.
  void Add(const std::string& name, std::string_view content);

  /// Puts the files in their places: `last`, one of them, at the end. Those of `earlier` that were
  /// not added again are removed. RunError when a file cannot be renamed.
  void Commit(const std::vector<std::string>& earlier, const std::string& last);

 private:
  struct Staged {
    std::string name;
    std::filesystem::path temporary;
  };

  std::filesystem::path folder_;
  std::vector<Staged> staged_;
};

}  // namespace trackbed
