#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "trackbed/core/file.h"
#include "trackbed/core/table.h"

namespace trackbed {

/// Called with the cells of a row, which it may move from, and the line where the row begins, from
/// 1.
using TakeCsvRow = std::function<void(std::vector<std::string>& cells, int line)>;

/// How a CSV file is written, and how much of one is read.
struct CsvLimits {
  std::size_t most_cells = 50'000'000;
  std::size_t most_bytes = kLargestFile;
  char delimiter = ',';
};

/// Reads a CSV file row by row (RFC 4180 through libcsv), the header first. Empty lines, spaces
/// around cells and a byte order mark are skipped. The file is read as a stream.
///
/// Adds a problem and reads no further where the file is no CSV, where a row has more than 4096
/// cells, a cell more than 64 KiB, or all rows more than `most_cells`, so that memory is bounded
/// however long the file is. A file without a row is a problem, too. RunError as ReadBlocks.
void ReadCsvRows(const std::filesystem::path& file, const CsvLimits& limits, ProblemList& problems,
                 const TakeCsvRow& take);

}  // namespace trackbed
