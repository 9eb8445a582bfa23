#pragma once

#include <yaml-cpp/mark.h>

#include <string>
#include <string_view>
#include <vector>

#include "trackbed/core/error.h"

namespace trackbed {

/// State that all readers of one file share.
struct ReaderContext {
  std::string file;
  std::vector<std::string> overridden;  // dotted keys set by --set
  std::vector<Problem> problems;
  // Dotted keys whose value could not be read because of a problem.
  std::vector<std::string> unread;

  /// Adds a problem of the key at position `mark`. If the option --set has overridden the key, the
  /// problem is reported for --set instead of the file position.
  void AddError(const YAML::Mark& mark, const std::string& dotted, std::string message);

  /// Returns whether the key was read; for a list, whether every element was read.
  [[nodiscard]] bool Read(std::string_view dotted) const;
};

}  // namespace trackbed
