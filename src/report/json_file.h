#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

namespace trackbed {

/// The file itself; InputError when it is not there.
inline std::filesystem::path Needed(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) {
    throw InputError(Problem{.file = file.string(), .message = "missing from the run folder"});
  }
  return file;
}

/// Calls `read` with the JSON in `file`; what is not there as Trackbed wrote it is an InputError.
template <typename Read>
auto WithJson(const std::filesystem::path& file, const Read& read) {
  try {
    return read(nlohmann::ordered_json::parse(ReadFile(Needed(file))));
  } catch (const nlohmann::json::exception& error) {
    throw InputError(Problem{.file = file.string(), .message = error.what()});
  }
}

}  // namespace trackbed
