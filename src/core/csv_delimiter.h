#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace trackbed {

/// Replaces runs of spaces and tabs by a tab, and removes spaces and tabs at the ends of lines. The
/// text may be passed to Replace in parts.
class BlankRuns {
 public:
  std::string Replace(std::string_view part);

 private:
  bool is_line_start_ = true;
  bool is_pending_ = false;
};

/// Returns the delimiter of the file, as described at CsvLimits::delimiter for kFindDelimiter.
char FindDelimiter(const std::filesystem::path& file);

}  // namespace trackbed
