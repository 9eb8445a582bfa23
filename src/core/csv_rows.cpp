#include "trackbed/core/csv_rows.h"

#include <csv.h>
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

namespace trackbed {
namespace {

constexpr std::size_t kMaxColumns = 4096;
constexpr std::size_t kMaxCellLength = std::size_t{1} << 16U;

/// Receives cells and rows through the callbacks of libcsv.
struct RowReader {
  const std::filesystem::path& file;
  std::size_t max_cells;
  ProblemList& problems;
  const TakeCsvRow& take;
  std::vector<std::string> cells{};
  std::size_t all_cells = 0;
  bool any_row = false;
  bool stopped = false;
  int line = 1;     // Line of the file on which the current row begins.
  int endings = 0;  // Number of line feeds in the quoted cells of the current row.

  void Stop(std::string message) {
    if (!stopped) {
      problems.Add({.file = file.string(), .line = line, .message = std::move(message)});
    }
    stopped = true;
  }

  void Cell(std::string_view cell) {
    if (cell.size() > kMaxCellLength) {
      Stop(fmt::format("a cell of more than {} characters", kMaxCellLength));
    } else if (cells.size() == kMaxColumns) {
      Stop(fmt::format("more than {} cells in a row", kMaxColumns));
    } else if (++all_cells > max_cells) {
      Stop(fmt::format("more than {} cells in the file", max_cells));
    }
    if (stopped) {
      return;
    }
    endings += static_cast<int>(std::count(cell.begin(), cell.end(), '\n'));
    cells.emplace_back(cell);
  }

  /// Handles the end of a row. The argument `ending` is the character that ended the row, or -1 at
  /// the end of the file.
  void EndOfRow(int ending) {
    if (stopped) {
      return;
    }
    if (!cells.empty()) {
      any_row = true;
      take(cells, line);
    }
    cells.clear();
    // Count only line feeds: libcsv also ends a row at a carriage return, but a carriage return
    // does not increase the line number.
    line += std::exchange(endings, 0) + (ending == '\n' ? 1 : 0);
  }
};

}  // namespace

void ReadCsvRows(const std::filesystem::path& file, const CsvLimits& limits, ProblemList& problems,
                 const TakeCsvRow& take) {
  RowReader reader{.file = file, .max_cells = limits.max_cells, .problems = problems, .take = take};
  csv_parser parser{};
  TRACKBED_CHECK(csv_init(&parser, CSV_STRICT | CSV_STRICT_FINI | CSV_REPALL_NL) == 0,
                 "libcsv did not start");
  const std::unique_ptr<csv_parser, void (*)(csv_parser*)> guard(&parser, csv_free);
  csv_set_delim(&parser, static_cast<unsigned char>(limits.delimiter));
  const auto cell = [](void* data, std::size_t size, void* self) {
    static_cast<RowReader*>(self)->Cell({static_cast<const char*>(data), size});
  };
  const auto row = [](int ending, void* self) { static_cast<RowReader*>(self)->EndOfRow(ending); };
  bool at_begin = true;
  // Parse the file in blocks, so that reading can stop between blocks. libcsv itself cannot be
  // stopped, and buffers a cell until the cell ends.
  const auto parse = [&](std::string_view part) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (std::exchange(at_begin, false) && part.starts_with(kByteOrderMark)) {
      part.remove_prefix(kByteOrderMark.size());
    }
    if (csv_parse(&parser, part.data(), part.size(), cell, row, &reader) != part.size()) {
      reader.Stop(csv_strerror(csv_error(&parser)));
    } else if (parser.entry_pos > kMaxCellLength) {
      reader.Stop(fmt::format("a cell of more than {} characters", kMaxCellLength));
    }
    return !reader.stopped;
  };
  ReadBlocks(file, parse, limits.max_bytes);
  if (!reader.stopped && csv_fini(&parser, cell, row, &reader) != 0) {
    reader.Stop(csv_strerror(csv_error(&parser)));
  }
  if (!reader.any_row && problems.empty()) {
    reader.Stop("empty file; expected a header line of column names");
  }
}

}  // namespace trackbed
