#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace trackbed::cli {

/// A column of a printed table: a heading and the texts below, all right-aligned.
struct TextColumn {
  std::vector<std::string> words;  ///< Words of the heading, between which it may be broken.
  std::string unit;                ///< Unit in brackets below the heading; empty if dimensionless.
  std::vector<std::string> texts;  ///< Texts, one per row.
};

/// A table printed in columns. Each column is as wide as its longest text or word, but at least
/// nine characters.
class TextColumns {
 public:
  void Add(TextColumn column);

  /// Returns how many columns, counted from the left, fit into `width` characters.
  [[nodiscard]] std::size_t CountWithin(std::size_t width) const;
  /// Returns the lines of a table with the first `count` columns: heading lines, then one line per
  /// row.
  [[nodiscard]] std::vector<std::string> Lines(std::size_t count) const;
  [[nodiscard]] std::vector<std::string> Lines() const { return Lines(columns_.size()); }

  /// Space before each line and between columns.
  static constexpr const char* kIndent = " ";

 private:
  struct LaidOutColumn {
    std::vector<std::string> heading;  ///< as lines
    std::vector<std::string> texts;
    std::size_t width;
  };

  std::vector<LaidOutColumn> columns_;
};

}  // namespace trackbed::cli
