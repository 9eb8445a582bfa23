#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "trackbed/core/file.h"
#include "trackbed/core/table.h"

namespace trackbed {

/// Callback that receives each row of a CSV file. `cells` are the cells of the row, which the
/// callback may move from. `line` is the number (from 1) of the line on which the row begins.
using TakeCsvRow = std::function<void(std::vector<std::string>& cells, int line)>;

/// The delimiter of a CSV file, and limits on the size of the file.
struct CsvLimits {
  std::size_t max_cells = 50'000'000;
  std::size_t max_bytes = kMaxFileBytes;
  char delimiter = ',';
};

/// Reads a CSV file (RFC 4180, with libcsv) and calls `take` for each row, beginning with the
/// header. Skips empty lines, spaces around cells and a byte order mark. The file is read as a
/// stream, so large files need little memory.
///
/// If the file is not valid CSV, adds a problem to `problems` and stops reading. The limits are
/// 4096 cells per row, 64 KiB per cell and `max_cells` cells in all rows, so that memory is bounded
/// for a file of any length. Also adds a problem if the file has no rows. Throws RunError in the
/// same cases as ReadBlocks.
void ReadCsvRows(const std::filesystem::path& file, const CsvLimits& limits, ProblemList& problems,
                 const TakeCsvRow& take);

}  // namespace trackbed
