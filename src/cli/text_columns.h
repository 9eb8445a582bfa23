#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace trackbed::cli {

/// A column of a table that is printed: its heading above its texts, both flush right.
struct TextColumn {
  std::vector<std::string> words;  ///< of the heading, which is broken between them
  std::string unit;                ///< below them in brackets; empty for what has none
  std::vector<std::string> texts;  ///< one per row
};

/// Columns of a printed table, side by side, each no wider than its longest text or word, but at
/// least nine characters.
class TextColumns {
 public:
  void Add(TextColumn column);

  /// How many of the first columns fit into `width` characters.
  [[nodiscard]] std::size_t CountWithin(std::size_t width) const;
  /// Lines of the heading of the first `count` columns, then one line for each row.
  [[nodiscard]] std::vector<std::string> Lines(std::size_t count) const;
  [[nodiscard]] std::vector<std::string> Lines() const { return Lines(columns_.size()); }

  /// Before each line, and before each column.
  static constexpr const char* kIndent = " ";

 private:
  struct Laid {
    std::vector<std::string> heading;  ///< lines
    std::vector<std::string> texts;
    std::size_t width;
  };

  std::vector<Laid> columns_;
};

}  // namespace trackbed::cli
