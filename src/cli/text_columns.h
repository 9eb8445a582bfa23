#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace trackbed::cli {

/// A column of a printed table: a heading, and below the heading one text per row, all
/// right-aligned.
struct TextColumn {
  /// Words of the column's heading; a line break is possible between two words.
  std::vector<std::string> words;
  /// Unit of the column's values, printed in brackets below the heading; empty for dimensionless
  /// values.
  std::string unit;
  std::vector<std::string> texts;  ///< Text of the column in each row.
};

/// A printed table. Each column is as wide as its longest text or heading word, but at least nine
/// characters wide.
class TextColumns {
 public:
  void Add(TextColumn column);

  /// Returns how many columns of the table, counted from the left, fit into `width` characters.
  [[nodiscard]] std::size_t CountWithin(std::size_t width) const;
  /// Returns the lines of a table with the first `count` columns: heading lines, then one line per
  /// row.
  [[nodiscard]] std::vector<std::string> Lines(std::size_t count) const;
  [[nodiscard]] std::vector<std::string> Lines() const { return Lines(columns_.size()); }

  /// Text printed before each line and between two columns.
  static constexpr const char* kIndent = " ";

 private:
  struct LaidOutColumn {
    std::vector<std::string> heading;  ///< heading, split into lines
    std::vector<std::string> texts;
    std::size_t width;
  };

  std::vector<LaidOutColumn> columns_;
};

}  // namespace trackbed::cli
