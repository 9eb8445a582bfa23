#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/core/table.h"

namespace trackbed::render {

/// A table whose first column is time, read between its rows.
class TimedTable {
 public:
  /// Reads `file`. InputError naming it when it is missing, broken, has no rows, a cell that is not
  /// finite, or times that do not increase.
  explicit TimedTable(const std::filesystem::path& file);

  [[nodiscard]] double begin() const { return times_.front(); }
  [[nodiscard]] double end() const { return times_.back(); }
  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  [[nodiscard]] const Table& table() const { return table_; }

  /// Index of a column; InputError naming the file and the column when there is none.
  [[nodiscard]] std::size_t Require(const std::string& column) const;
  /// Index of a column, if there is one.
  [[nodiscard]] std::optional<std::size_t> Find(const std::string& column) const;

  /// Where a moment lies between two rows: value = (1 - part) * row + part * next.
  struct Place {
    std::size_t row = 0;
    std::size_t next = 0;
    double part = 0;
  };
  /// Moments before the first and after the last row are held there.
  [[nodiscard]] Place At(double time) const;
  [[nodiscard]] double Value(const Place& place, std::size_t column) const;

 private:
  std::filesystem::path file_;
  Table table_;
  std::vector<double> times_;
};

}  // namespace trackbed::render
