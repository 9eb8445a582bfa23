#include "trackbed/core/temporaries.h"

#include <cerrno>
#include <mutex>
#include <set>
#include <system_error>

namespace trackbed {

namespace fs = std::filesystem;

namespace {

struct List {
  std::mutex mutex;
  std::multiset<fs::path> paths;
};

/// The list of temporary files is never destroyed, because RemoveTemporariesForEver may run while
/// the process exits.
List& TheList() {
  static List* const list = new List;
  return *list;
}

}  // namespace

bool AddTemporary(const fs::path& path, const std::function<bool()>& create) {
  List& list = TheList();
  const std::lock_guard lock(list.mutex);
  const auto place = list.paths.insert(path);
  if (create()) {
    return true;
  }
  const int error = errno;
  list.paths.erase(place);
  errno = error;
  return false;
}

bool DropTemporary(const fs::path& path, const std::function<bool()>& remove) {
  List& list = TheList();
  const std::lock_guard lock(list.mutex);
  if (!remove()) {
    return false;
  }
  if (const auto place = list.paths.find(path); place != list.paths.end()) {
    list.paths.erase(place);
  }
  return true;
}

void RemoveTemporariesForEver() noexcept {
  List& list = TheList();
  list.mutex.lock();  // never unlocked, so that no thread can create a temporary file any more
  for (const fs::path& path : list.paths) {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
}

}  // namespace trackbed
