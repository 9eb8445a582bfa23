#pragma once

#include <filesystem>

namespace trackbed {

/// Keeps other processes from a folder while a result is made in it: those that write, or, for one
/// that only reads, none but those.
///
/// An advisory lock (flock) on the folder itself: it leaves no file, and ends with the process that
/// holds it, however that ends. It holds between processes on one machine; on file systems without
/// such locks, as some network ones, nothing is locked. Two locks of one process on one folder
/// exclude each other, too.
class FolderLock {
 public:
  enum class Access { kRead, kWrite };

  /// Does not wait: RunError naming the folder when another process holds it. A folder that does
  /// not exist or cannot be opened is not locked. With kWrite, what killed processes left half
  /// written there is removed: RemoveAbandonedTemporaries.
  FolderLock(const std::filesystem::path& folder, Access access);
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&&) = delete;
  ~FolderLock();

 private:
  int descriptor_;
};

}  // namespace trackbed
