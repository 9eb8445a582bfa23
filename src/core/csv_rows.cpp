#include "trackbed/core/csv_rows.h"

#include <csv.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "src/core/csv_delimiter.h"
#include "src/core/csv_head.h"
#include "src/core/csv_number.h"
#include "src/core/markup.h"
#include "src/core/vbo.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/foreign_content.h"
#include "trackbed/core/text_table.h"

// Reads rows of CSV files with libcsv, within limits of cells, columns and cell lengths.
// 1. CommentFilter removes lines that begin with '#', before libcsv interprets quotes.
// 2. RowReader collects the cells of a row, and passes each row with its line number to the caller.
// 3. NamedRows skips a preamble (src/core/csv_head.h), and finds the names of columns in the
// header, or in a comment before rows of numbers. NamedRows rewrites numbers such as "+1" and
// "0,5", and the cells of VBO files (src/core/vbo.h).
namespace trackbed {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
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
    if (!any_row && !cells.empty() &&
        (cells.front().starts_with("File created on ") || cells.front() == "[header]")) {
      Stop(
          "a VBO file of Racelogic whose first 64 KiB have no table: expected a line of names in "
          "the section [column names], and the section [data]");
    }
    if (!cells.empty() && !stopped) {
      any_row = true;
      take(cells, line);
    }
    cells.clear();
    // Count only line feeds: libcsv also ends a row at a carriage return, but a carriage return
    // does not increase the line number.
    line += std::exchange(endings, 0) + (ending == '\n' ? 1 : 0);
  }
};

/// Splits the blocks of a file into comments and other text. Passes all text outside of comments to
/// `parse`, in parts that end at the end of a line or of the block.
class CommentFilter {
 public:
  /// CommentFilter also removes the first `preamble` lines of the file.
  CommentFilter(RowReader& reader, const csv_parser& parser, int preamble)
      : reader_(reader), parser_(parser), preamble_(preamble) {}

  /// Processes a block of the file; returns false if reading must stop.
  template <typename Parse>
  bool Take(std::string_view block, const Parse& parse) {
    while (!block.empty()) {
      if (preamble_ > 0) {
        const std::size_t end = block.find('\n');
        if (end == std::string_view::npos) {
          return true;
        }
        block.remove_prefix(end + 1);
        --preamble_;
        ++reader_.line;
        continue;
      }
      if (at_line_start_ && block.front() == '#') {
        in_comment_ = true;
      }
      const std::size_t end = block.find_first_of("\r\n");
      at_line_start_ = false;
      if (in_comment_) {
        comment_ += block.substr(0, end);
        if (comment_.size() > kMaxCellLength) {
          reader_.Stop(fmt::format("a comment of more than {} characters", kMaxCellLength));
          return false;
        }
        if (end == std::string_view::npos) {
          return true;
        }
        Finish();
        block.remove_prefix(end);  // the parser receives the comment as an empty line
        continue;
      }
      const std::size_t size = end == std::string_view::npos ? block.size() : end + 1;
      if (!parse(block.substr(0, size))) {
        return false;
      }
      at_line_start_ = end != std::string_view::npos && parser_.quoted == 0;
      block.remove_prefix(size);
    }
    return true;
  }

  /// Processes a comment at the end of the file that has no line feed.
  void Finish() {
    if (std::exchange(in_comment_, false)) {
      reader_.Cell(comment_);
      if (!reader_.stopped) {
        reader_.any_row = true;
        reader_.take(reader_.cells, reader_.line);
        reader_.cells.clear();
      }
    }
    comment_.clear();
  }

 private:
  RowReader& reader_;
  const csv_parser& parser_;
  int preamble_;
  bool at_line_start_ = true;
  bool in_comment_ = false;
  std::string comment_;
};

/// Explains an error of libcsv.
std::string ParserError(csv_parser& parser) {
  return csv_error(&parser) == CSV_EPARSE ? "a quote within a cell, as in 48\xC2\xB0"
                                            "07'30\"; write decimal numbers, or put the whole "
                                            "cell in quotes and double the quotes in it"
                                          : csv_strerror(csv_error(&parser));
}

}  // namespace

namespace {

/// Reads a file as ReadCsvRows does, without its first `preamble` lines.
void ReadRowsBehind(int preamble, const std::filesystem::path& file, const CsvLimits& limits,
                    ProblemList& problems, const TakeCsvRow& take) {
  RowReader reader{.file = file, .max_cells = limits.max_cells, .problems = problems, .take = take};
  csv_parser parser{};
  TRACKBED_CHECK(csv_init(&parser, CSV_STRICT | CSV_STRICT_FINI | CSV_REPALL_NL) == 0,
                 "libcsv did not start");
  const std::unique_ptr<csv_parser, void (*)(csv_parser*)> guard(&parser, csv_free);
  const char delimiter =
      limits.delimiter == kFindDelimiter ? FindDelimiter(file) : limits.delimiter;
  const bool has_blanks = delimiter == kBlanks;
  csv_set_delim(&parser, static_cast<unsigned char>(has_blanks ? '\t' : delimiter));
  const auto cell = [](void* data, std::size_t size, void* self) {
    static_cast<RowReader*>(self)->Cell({static_cast<const char*>(data), size});
  };
  const auto row = [](int ending, void* self) { static_cast<RowReader*>(self)->EndOfRow(ending); };
  bool at_begin = true;
  // Parse the file in blocks, so that reading can stop between blocks. The parser libcsv cannot be
  // stopped within a block, and buffers a cell until the cell ends.
  BlankRuns blanks;
  std::string replaced;
  const auto parse = [&](std::string_view part) {
    if (has_blanks) {
      replaced = blanks.Replace(part);
      part = replaced;
    }
    if (csv_parse(&parser, part.data(), part.size(), cell, row, &reader) != part.size()) {
      reader.Stop(ParserError(parser));
    } else if (parser.entry_pos > kMaxCellLength) {
      reader.Stop(fmt::format("a cell of more than {} characters", kMaxCellLength));
    }
    return !reader.stopped;
  };
  CommentFilter comments(reader, parser, preamble);
  const auto take_block = [&](std::string_view block) {
    if (std::exchange(at_begin, false)) {
      if (std::string problem = block.empty() ? "" : ForeignBytes(block); !problem.empty()) {
        reader.Stop(std::move(problem));
        return false;
      }
      if (block.starts_with(kByteOrderMark)) {
        block.remove_prefix(kByteOrderMark.size());
      }
      if (std::string problem = MarkupProblem(block); !problem.empty()) {
        reader.Stop(std::move(problem));
        return false;
      }
    }
    return limits.comments ? comments.Take(block, parse) : parse(block);
  };
  ReadBlocks(file, take_block, limits.max_bytes);
  comments.Finish();
  if (!reader.stopped && csv_fini(&parser, cell, row, &reader) != 0) {
    reader.Stop(ParserError(parser));
  }
  if (!reader.any_row && problems.empty()) {
    reader.Stop("empty file; expected a header line of column names");
  }
}

}  // namespace

void ReadCsvRows(const std::filesystem::path& file, const CsvLimits& limits, ProblemList& problems,
                 const TakeCsvRow& take) {
  ReadRowsBehind(0, file, limits, problems, take);
}

namespace {

void DropEmptyEnd(std::vector<std::string>& cells, std::size_t least) {
  while (cells.size() > least && cells.back().empty()) {
    cells.pop_back();
  }
}

/// Splits a comment, without the '#', into cells.
std::vector<std::string> CommentCells(std::string_view comment, char delimiter) {
  std::vector<std::string> cells;
  comment.remove_prefix(std::min(comment.find_first_not_of('#'), comment.size()));
  std::string replaced;
  if (delimiter == kBlanks) {
    replaced = BlankRuns().Replace(comment);
    comment = replaced;
    delimiter = '\t';
  }
  for (bool more = true; more;) {
    const std::size_t end = comment.find(delimiter);
    more = end != std::string_view::npos;
    std::string_view cell = comment.substr(0, end);
    constexpr std::string_view kSpaces = " \t\r";
    cell.remove_prefix(std::min(cell.find_first_not_of(kSpaces), cell.size()));
    cells.emplace_back(cell.substr(0, cell.find_last_not_of(kSpaces) + 1));
    comment.remove_prefix(more ? end + 1 : comment.size());
  }
  DropEmptyEnd(cells, 1);
  return cells;
}

/// Appends a number to repeated column names, as in "speed [m/s] (2)". Loggers repeat a name if
/// several sensors measure the same quantity.
void NumberRepeats(std::vector<std::string>& names) {
  std::map<std::string, int> counts;
  for (std::string& name : names) {
    const int count = ++counts[name];
    name += count > 1 ? fmt::format(" ({})", count) : "";
  }
}

/// Finds the column names of a CSV table, and passes names and rows to the caller.
class NamedRows {
 public:
  NamedRows(const std::filesystem::path& file, const CsvLimits& limits, const CsvHead& head,
            ProblemList& problems, const TakeCsvNames& take_names, const TakeCsvRow& take)
      : file_(file),
        head_(head),
        delimiter_(limits.delimiter),
        numbers_columns_(limits.numbers_columns),
        problems_(problems),
        take_names_(take_names),
        take_(take) {}

  void Take(std::vector<std::string>& cells, int line) {
    if (cells.front().starts_with('#')) {
      // Ignore comments after the first row, because only earlier comments can contain the column
      // names.
      if (columns_ == 0 && !is_broken_) {
        // A comment that begins with spaces was already split into cells, so join its cells again.
        const std::string text = fmt::format("{}", fmt::join(cells, std::string(1, delimiter_)));
        comments_.push_back({CommentCells(text, delimiter_), line});
        constexpr std::size_t kMaxComments = 100;
        comments_.erase(comments_.begin(), comments_.end() - static_cast<std::ptrdiff_t>(std::min(
                                                                 comments_.size(), kMaxComments)));
      }
      return;
    }
    for (std::string& cell : cells) {
      NormalizeNumber(cell, head_.has_decimal_commas);
    }
    if (columns_ == 0 && !is_broken_ && TakeNames(cells, line)) {
      return;
    }
    if (!is_broken_ && line >= head_.first_row) {
      DropEmptyEnd(cells, columns_);
      // Skip lines that contain only delimiters, as spreadsheets write them after the last row.
      if (std::all_of(cells.begin(), cells.end(), [](const auto& cell) { return cell.empty(); })) {
        return;
      }
      if (const std::string problem = vbo_ ? vbo_->Convert(cells) : ""; !problem.empty()) {
        problems_.Add({.file = file_.string(), .line = line, .message = problem});
      }
      take_(cells, line);
    }
  }

  [[nodiscard]] bool is_empty() const { return columns_ == 0 && !is_broken_; }

 private:
  struct Comment {
    std::vector<std::string> cells;
    int line;
  };

  /// Reads the column names from the table's first row or from a comment above it. TakeNames
  /// returns whether `row` contains the names.
  bool TakeNames(std::vector<std::string>& row, int line) {
    const bool is_data = std::all_of(row.begin(), row.end(), [](const std::string& cell) {
      return cell.empty() || CellNumber(cell).has_value();
    });
    if (!is_data) {
      DropEmptyEnd(row, 1);
      columns_ = row.size();
      for (std::size_t i = 0; i < std::min(row.size(), head_.units.size()); ++i) {
        row[i] = NameWithUnit(row[i], head_.units[i]);
      }
      if (!head_.units.empty()) {
        NumberRepeats(row);
      }
      if (head_.is_vbo) {
        vbo_.emplace(row);
      }
      take_names_(row, line);
      return true;
    }
    std::vector<std::string> used = row;
    DropEmptyEnd(used, 1);
    const auto found =
        std::find_if(comments_.rbegin(), comments_.rend(), [&](const Comment& comment) {
          return comment.cells.size() == used.size() || comment.cells.size() == row.size();
        });
    if (found == comments_.rend() && numbers_columns_) {
      std::vector<std::string> numbers;
      for (std::size_t i = 1; i <= used.size(); ++i) {
        numbers.push_back(std::to_string(i));
      }
      columns_ = numbers.size();
      take_names_(numbers, line);
      return false;
    }
    if (found == comments_.rend()) {
      problems_.Add({.file = file_.string(),
                     .line = line,
                     .message = "no column names before the first row; expected a header line such "
                                "as x_m,y_m"});
      is_broken_ = true;
      return false;
    }
    columns_ = found->cells.size();
    take_names_(found->cells, found->line);
    return false;
  }

  const std::filesystem::path& file_;
  const CsvHead& head_;
  char delimiter_;
  bool numbers_columns_;
  ProblemList& problems_;
  const TakeCsvNames& take_names_;
  const TakeCsvRow& take_;
  std::optional<VboCells> vbo_;    // Converts the cells of a VBO file.
  std::vector<Comment> comments_;  // The last comments before the first row of the table.
  std::size_t columns_ = 0;        // Number of columns; 0 before the column names are known.
  bool is_broken_ = false;
};

}  // namespace

bool ReadCsvTable(const std::filesystem::path& file, CsvLimits limits, ProblemList& problems,
                  const TakeCsvNames& take_names, const TakeCsvRow& take) {
  limits.comments = true;
  if (limits.delimiter == kFindDelimiter) {
    limits.delimiter = FindDelimiter(file);
  }
  const CsvHead head = FindCsvHead(file, limits.delimiter);
  limits.delimiter = head.delimiter;
  NamedRows rows(file, limits, head, problems, take_names, take);
  ReadRowsBehind(head.preamble_lines, file, limits, problems,
                 [&](std::vector<std::string>& cells, int line) { rows.Take(cells, line); });
  return !rows.is_empty();
}

}  // namespace trackbed
