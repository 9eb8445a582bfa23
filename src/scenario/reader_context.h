#pragma once

#include <yaml-cpp/mark.h>

#include <string>
#include <string_view>
#include <vector>

#include "trackbed/core/error.h"

namespace trackbed {

/// State shared by all readers of one file.
struct ReaderContext {
  std::string file;
  std::vector<std::string> overridden;  // dotted keys set by --set
  std::vector<Problem> problems;
  std::vector<std::string> unread;  // dotted keys whose value is unknown because of a problem

  /// Adds a problem of the key at `mark`. If the key was overridden, the problem is reported at
  /// --set.
  void AddError(const YAML::Mark& mark, const std::string& dotted, std::string message);

  /// Whether the key was read; for a list, whether every element was read.
  [[nodiscard]] bool Read(std::string_view dotted) const;
};

}  // namespace trackbed
