#include "trackbed/core/folder_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

namespace trackbed {

FolderLock::FolderLock(const std::filesystem::path& folder, Access access)
    : descriptor_(
          ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0) {
    return;  // who writes or reads there will tell
  }
  const int kind = access == Access::kWrite ? LOCK_EX : LOCK_SH;
  if (::flock(descriptor_, kind | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(descriptor_);
    throw RunError(fmt::format("{} is in use: another process {} it", folder.string(),
                               access == Access::kWrite ? "reads or writes" : "writes"));
  }
  if (access == Access::kWrite) {
    RemoveAbandonedTemporaries(folder);
  }
}

FolderLock::FolderLock(FolderLock&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
  }
}

}  // namespace trackbed
