#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/core/table.h"

namespace trackbed::render {

/// A table whose first column is the time. Values at times between two rows are interpolated
/// linearly.
class TimedTable {
 public:
  /// Reads the table from `file`. Throws InputError naming the file if the file is missing, broken
  /// or has no rows. All cells of the table must be finite, and the times must increase.
  explicit TimedTable(const std::filesystem::path& file);

  [[nodiscard]] double begin() const { return times_.front(); }
  [[nodiscard]] double end() const { return times_.back(); }
  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  [[nodiscard]] const Table& table() const { return table_; }

  /// Returns the index of the column with the given name. Throws InputError naming the file and the
  /// column if the column is missing.
  [[nodiscard]] std::size_t Require(const std::string& column) const;
  /// Returns the index of the column with the given name; nullopt if the column is missing.
  [[nodiscard]] std::optional<std::size_t> Find(const std::string& column) const;

  /// Position of a time between two rows of the table. The interpolated value of a column is (1 -
  /// part) times the value in row `row` plus `part` times the value in row `next`.
  struct Place {
    std::size_t row = 0;
    std::size_t next = 0;
    double part = 0;
  };
  /// Returns the position of a time between two rows. A time before the first row or after the last
  /// row is clamped.
  [[nodiscard]] Place At(double time) const;
  [[nodiscard]] double Value(const Place& place, std::size_t column) const;

 private:
  std::filesystem::path file_;
  Table table_;
  std::vector<double> times_;
};

}  // namespace trackbed::render
