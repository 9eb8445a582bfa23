#include "trackbed/core/csv_columns.h"

#include <cstddef>
#include <limits>
#include <utility>

#include "src/core/number_reader.h"
#include "trackbed/core/csv_rows.h"
#include "trackbed/core/error.h"

namespace trackbed {

void ReadCsvColumns(const std::filesystem::path& file, const std::vector<std::string>& columns,
                    char delimiter, const std::string& timestamps,
                    const std::function<void(const std::vector<double>&, int)>& take) {
  TRACKBED_CHECK(!columns.empty(), "numbers need columns");
  NumberReader reader{.file = file.string(),
                      .selection = {.all = false,
                                    .needed = columns,
                                    .optional = {},
                                    .timestamps = timestamps,
                                    .empty = true}};
  std::vector<double> ordered(columns.size());
  // Index of each requested column among the columns that were read from the CSV file.
  std::vector<std::size_t> place;
  reader.take = [&](const std::vector<double>& numbers, int line) {
    if (place.empty()) {
      for (const std::string& column : columns) {
        place.push_back(static_cast<std::size_t>(reader.table->Find(column)));
      }
    }
    for (std::size_t i = 0; i < columns.size(); ++i) {
      ordered[i] = numbers[place[i]];
    }
    take(ordered, line);
  };
  constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();
  const auto take_cells = [&](std::vector<std::string>& cells, int line) {
    reader.Take(cells, line);
  };
  const bool has_names =
      ReadCsvTable(file, {.max_cells = kAny, .max_bytes = kAny, .delimiter = delimiter},
                   reader.problems, take_cells, take_cells);
  if (!has_names && reader.problems.empty()) {
    reader.AddError("", "no rows after the comments");
  }
  reader.problems.ThrowIfAny();
}

std::vector<std::string> ReadCsvNames(const std::filesystem::path& file, std::size_t& rows) {
  std::vector<std::string> found;
  ProblemList problems;
  rows = 0;
  constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();
  ReadCsvTable(
      file, {.max_cells = kAny, .max_bytes = kAny, .delimiter = kFindDelimiter}, problems,
      [&](std::vector<std::string>& names, int) { found = std::move(names); },
      [&](std::vector<std::string>&, int) { ++rows; });
  problems.ThrowIfAny();
  return found;
}

}  // namespace trackbed
