#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "trackbed/core/file.h"
#include "trackbed/core/table.h"

namespace trackbed {

/// Called for each row with its cells, which the callee may move from, and with the line (from 1)
/// on which the row begins.
using TakeCsvRow = std::function<void(std::vector<std::string>& cells, int line)>;

/// The delimiter of a CSV file, and limits on reading it.
struct CsvLimits {
  std::size_t max_cells = 50'000'000;
  std::size_t max_bytes = kMaxFileBytes;
  char delimiter = ',';
};

/// Reads a CSV file row by row (RFC 4180 through libcsv), the header first. Empty lines, spaces
/// around cells and a byte order mark are skipped. The file is read as a stream.
///
/// Adds a problem and stops reading if the file is not CSV. The limits are 4096 cells per row, 64
/// KiB per cell and `max_cells` cells in all rows, so that memory is bounded for a file of any
/// length. A file without a row is also a problem. Throws the RunErrors of ReadBlocks.
void ReadCsvRows(const std::filesystem::path& file, const CsvLimits& limits, ProblemList& problems,
                 const TakeCsvRow& take);

}  // namespace trackbed
