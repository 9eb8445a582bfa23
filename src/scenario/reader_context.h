#pragma once

#include <yaml-cpp/mark.h>

#include <string>
#include <string_view>
#include <vector>

#include "trackbed/core/error.h"

namespace trackbed {

/// What all readers of one file share.
struct ReaderContext {
  std::string file;
  std::vector<std::string> overridden;  // dotted keys that --set put in
  std::vector<Problem> problems;
  std::vector<std::string> unread;  // dotted keys whose value is not known for a problem of theirs

  /// Adds a problem of the key, placed at `mark`, or at --set if that is where the key comes from.
  void AddError(const YAML::Mark& mark, const std::string& dotted, std::string message);

  /// Whether the key, or some element of it if it is a list, is among what could not be read.
  [[nodiscard]] bool Read(std::string_view dotted) const;
};

}  // namespace trackbed
