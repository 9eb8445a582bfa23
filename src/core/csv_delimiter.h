#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace trackbed {

/// Replaces runs of spaces and tabs by a tab, and removes spaces and tabs at the ends of lines. The
/// function Replace accepts the text in several parts.
class BlankRuns {
 public:
  std::string Replace(std::string_view part);

 private:
  bool is_line_start_ = true;
  bool is_pending_ = false;
};

/// Returns the delimiter found in a CSV file, as described at CsvLimits::delimiter for
/// kFindDelimiter.
char FindDelimiter(const std::filesystem::path& file);

}  // namespace trackbed
