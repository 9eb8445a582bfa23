#include "src/core/csv_delimiter.h"

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <cstddef>
#include <utility>

#include "src/core/csv_number.h"
#include "trackbed/core/csv_rows.h"
#include "trackbed/core/file.h"
#include "trackbed/core/text_table.h"

// Finds the delimiter of a CSV file in its first lines: comma, semicolon, tab or blanks.
namespace trackbed {
namespace {

/// Returns the next line that is neither empty nor a comment, and removes it from `rest`.
std::string_view NextLine(std::string_view& rest) {
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find_first_of("\r\n"), rest.size());
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (!line.empty() && line.front() != '#') {
      return line;
    }
  }
  return {};
}

/// Splits a line at blanks and returns the number of cells. Sets `numbers` to the number of cells
/// that are numbers.
std::size_t CountCells(std::string_view line, std::size_t& numbers) {
  std::size_t count = 0;
  numbers = 0;
  std::string rest = BlankRuns().Replace(line);
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\t'), rest.size());
    ++count;
    numbers += CellNumber(rest.substr(0, end)) ? 1U : 0U;
    rest.erase(0, end + 1);
  }
  return count;
}

/// Returns whether blanks are the delimiter of a CSV file. Blanks must separate numbers in `line`,
/// or names in `line` and equally many numbers in the next line.
bool HasBlanks(std::string_view line, std::string_view rest) {
  std::size_t numbers = 0;
  const std::size_t count = CountCells(line, numbers);
  if (count < 2 || numbers == count) {
    return count > 1;
  }
  std::size_t below = 0;
  return CountCells(NextLine(rest), below) == count && below == count;
}

/// Returns whether all cells of a line are numbers; the numbers may have decimal commas.
bool AreNumbers(std::string_view line, char delimiter) {
  for (bool more = true; more;) {
    const std::size_t end = line.find(delimiter);
    more = end != std::string_view::npos;
    std::string cell = boost::trim_copy(std::string(line.substr(0, end)));
    NormalizeNumber(cell, true);
    if (!CellNumber(cell)) {
      return false;
    }
    line.remove_prefix(more ? end + 1 : line.size());
  }
  return true;
}

}  // namespace

std::string BlankRuns::Replace(std::string_view part) {
  std::string text;
  for (const char c : part) {
    if (c == ' ' || c == '\t') {
      is_pending_ = !is_line_start_;
      continue;
    }
    const bool is_end = c == '\r' || c == '\n';
    if (std::exchange(is_pending_, false) && !is_end) {
      text += '\t';
    }
    text += c;
    is_line_start_ = is_end;
  }
  return text;
}

char FindDelimiter(const std::filesystem::path& file) {
  std::string begin;
  ReadBlocks(file, [&](std::string_view block) {
    begin = block;
    return false;
  });
  std::string_view rest = begin;
  if (constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
      rest.starts_with(kByteOrderMark)) {
    rest.remove_prefix(kByteOrderMark.size());
  }
  const std::string_view line = NextLine(rest);
  char delimiter = ',';
  std::ptrdiff_t most = 0;
  for (const char candidate : {',', ';', '\t'}) {
    const auto count = std::count(line.begin(), line.end(), candidate);
    if (count > most) {
      most = count;
      delimiter = candidate;
    }
  }
  for (const char candidate : {';', '\t'}) {
    if (delimiter == ',' && line.find(candidate) != std::string_view::npos &&
        AreNumbers(line, candidate)) {
      delimiter = candidate;
    }
  }
  return most == 0 && HasBlanks(line, rest) ? kBlanks : delimiter;
}

}  // namespace trackbed
