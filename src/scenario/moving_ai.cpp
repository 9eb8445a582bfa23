#include "trackbed/scenario/moving_ai.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>

#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/scenario/map_file.h"

namespace trackbed {
namespace {

/// Iterates over the lines of a text and counts them.
class Lines {
 public:
  Lines(std::string_view text, std::string file) : rest_(text), file_(std::move(file)) {}

  [[nodiscard]] bool empty() const { return rest_.empty(); }
  [[nodiscard]] int number() const { return number_; }

  /// Returns the next line of the text without its line feed.
  std::string_view Next() {
    ++number_;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    if (!line.empty() && line.back() == '\r') {
      line.remove_suffix(1);
    }
    return line;
  }

  [[noreturn]] void Fail(std::string message, int column = 0) const {
    throw InputError(
        Problem{.file = file_, .line = number_, .column = column, .message = std::move(message)});
  }

 private:
  std::string_view rest_;
  std::string file_;
  int number_ = 0;
};

/// Parses the number in a header line such as "height 512".
int ReadSize(Lines& lines, std::string_view name) {
  const std::string_view line = lines.Next();
  int size = 0;
  const std::string_view value =
      line.size() > name.size() && line.starts_with(name) && line[name.size()] == ' '
          ? line.substr(name.size() + 1)
          : "";
  const char* end = value.data() + value.size();
  const auto [after, error] = std::from_chars(value.data(), end, size);
  if (value.empty() || error != std::errc() || after != end || size < 1 ||
      static_cast<std::size_t>(size) > kMaxMapCells) {
    lines.Fail(fmt::format("expected '{} N' with N from 1 to {}, found '{:.40}'", name,
                           kMaxMapCells, line));
  }
  return size;
}

void ReadWord(Lines& lines, std::string_view word) {
  const std::string_view line = lines.Next();
  if (line != word) {
    lines.Fail(fmt::format("expected '{}', found '{:.40}'", word, line));
  }
}

}  // namespace

bool IsMovingAiMap(const std::filesystem::path& file) {
  return file.extension() == ".map";
}

GridMap ReadMovingAiMap(const std::filesystem::path& file, double cell, const Pose2& X_WM) {
  std::string text;
  try {
    text = ReadFile(file, kMaxMapFileBytes);
  } catch (const RunError& error) {
    throw InputError(Problem{.message = error.what()});
  }
  Lines lines(text, file.string());
  ReadWord(lines, "type octile");
  GridMap map{.X_WM = X_WM, .cell = cell, .columns = 0, .rows = 0, .cells = {}};
  map.rows = ReadSize(lines, "height");
  map.columns = ReadSize(lines, "width");
  ReadWord(lines, "map");
  const auto columns = static_cast<std::size_t>(map.columns);
  const auto rows = static_cast<std::size_t>(map.rows);
  if (columns * rows > kMaxMapCells) {
    lines.Fail(fmt::format("{} x {} cells; must be at most {}", columns, rows, kMaxMapCells));
  }
  if (columns * rows > text.size()) {
    lines.Fail(fmt::format("{} x {} cells, but the file has {} bytes", columns, rows, text.size()));
  }
  map.cells.resize(columns * rows);
  for (std::size_t row = rows; row-- > 0;) {
    const std::string_view line = lines.Next();
    if (line.size() != columns) {
      lines.Fail(fmt::format("a row of {} cells; must be {}", line.size(), columns));
    }
    for (std::size_t column = 0; column < columns; ++column) {
      const char c = line[column];
      if (std::string_view(".G@OTSW").find(c) == std::string_view::npos) {
        lines.Fail(fmt::format("unknown terrain '{}'; must be one of . G @ O T S W", c),
                   static_cast<int>(column) + 1);
      }
      map.cells[row * columns + column] =
          c == '.' || c == 'G' ? MapCell::kFree : MapCell::kOccupied;
    }
  }
  while (!lines.empty()) {
    if (const std::string_view line = lines.Next(); !line.empty()) {
      lines.Fail(fmt::format("'{:.40}' after the last row", line));
    }
  }
  return map;
}

}  // namespace trackbed
