#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace trackbed::cli {

/// A column of a printed table: a heading above texts, all right-aligned.
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

  /// Number of leading columns that fit into `width` characters.
  [[nodiscard]] std::size_t CountWithin(std::size_t width) const;
  /// The heading lines of the first `count` columns, then one line per row.
  [[nodiscard]] std::vector<std::string> Lines(std::size_t count) const;
  [[nodiscard]] std::vector<std::string> Lines() const { return Lines(columns_.size()); }

  /// Indent before each line and each column.
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
