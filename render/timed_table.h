#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/core/table.h"

namespace trackbed::render {

/// A table whose first column is time, with interpolation between rows.
class TimedTable {
 public:
  /// Reads `file`. Throws InputError naming the file if the file is missing, broken or has no rows.
  /// Cells must be finite and times must increase.
  explicit TimedTable(const std::filesystem::path& file);

  [[nodiscard]] double begin() const { return times_.front(); }
  [[nodiscard]] double end() const { return times_.back(); }
  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  [[nodiscard]] const Table& table() const { return table_; }

  /// Index of a column; throws InputError naming the file and the column if it is missing.
  [[nodiscard]] std::size_t Require(const std::string& column) const;
  /// Index of a column; none if it is missing.
  [[nodiscard]] std::optional<std::size_t> Find(const std::string& column) const;

  /// Position of a time between two rows: value = (1 - part) * row + part * next.
  struct Place {
    std::size_t row = 0;
    std::size_t next = 0;
    double part = 0;
  };
  /// Clamps times before the first row and after the last row.
  [[nodiscard]] Place At(double time) const;
  [[nodiscard]] double Value(const Place& place, std::size_t column) const;

 private:
  std::filesystem::path file_;
  Table table_;
  std::vector<double> times_;
};

}  // namespace trackbed::render
