#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "trackbed/core/file.h"

namespace trackbed {

/// Returns the names of the files and folders directly inside a folder.
inline std::vector<std::string> NamesOfEntries(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  return names;
}

/// Returns the contents of all files in a folder and its subfolders, by their paths relative to the
/// folder. Files with wall-clock times (timing.json) are skipped.
inline std::map<std::string, std::string> BytesOf(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() && entry.path().filename() != "timing.json") {
      files[entry.path().lexically_relative(folder).string()] = ReadFile(entry.path());
    }
  }
  return files;
}

}  // namespace trackbed
