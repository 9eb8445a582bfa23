#include "trackbed/core/file_set.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

namespace trackbed {

namespace fs = std::filesystem;

FileSet::FileSet(fs::path folder) : folder_(std::move(folder)) {
  MakeFolder(folder_);
}

FileSet::~FileSet() {
  for (const Staged& file : staged_) {
    std::error_code ignored;
    fs::remove(file.temporary, ignored);
  }
}

void FileSet::Add(const std::string& name, std::string_view content) {
  const fs::path file = folder_ / name;
  std::error_code ignored;
  if (fs::is_directory(file, ignored)) {
    throw RunError(fmt::format("cannot write {}: it is a folder", file.string()));
  }
  WriteTemporary(file, content);
  staged_.push_back({name, TemporaryNameFor(file)});
}

void FileSet::Commit(const std::vector<std::string>& earlier, const std::string& last) {
  const auto end = std::stable_partition(staged_.begin(), staged_.end(),
                                         [&](const Staged& file) { return file.name != last; });
  TRACKBED_REQUIRE(end != staged_.end(), "FileSet: {} was not added", last);
  std::error_code ignored;  // what cannot be removed cannot be replaced either: that will tell
  fs::remove(folder_ / last, ignored);
  for (const std::string& name : earlier) {
    fs::remove(folder_ / name, ignored);
  }
  // Every temporary that is renamed is forgotten first: PublishFile removes one that it cannot.
  while (!staged_.empty()) {
    const Staged file = std::move(staged_.front());
    staged_.erase(staged_.begin());
    PublishFile(file.temporary, folder_ / file.name);
  }
}

}  // namespace trackbed
