#include "trackbed/core/table.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "tests/support/temp_folder.h"
#include "trackbed/core/csv_columns.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

// Tests tables and CSV files: bit-exact round trips, quoting, errors with their lines, and size
// limits.
namespace trackbed {
namespace {

using ::testing::ElementsAre;

Table RoundTrip(const Table& table) {
  const TempFolder folder;
  const std::filesystem::path file = folder.path() / "t.csv";
  WriteFileAtomically(file, table.ToCsv());
  return ReadCsv(file);
}

/// The InputError text for reading `content` as "t.csv", without the folder.
std::string ErrorMessages(const std::string& content, const std::vector<std::string>& needed = {}) {
  const TempFolder folder;
  const std::string file = (folder.path() / "t.csv").string();
  WriteFileAtomically(file, content);
  try {
    if (needed.empty()) {
      ReadCsv(file);
    } else {
      ReadCsvExcerpt(file, needed);
    }
  } catch (const InputError& error) {
    std::string text = error.what();
    for (auto at = text.find(file); at != std::string::npos; at = text.find(file)) {
      text.replace(at, file.size(), "t.csv");
    }
    return text;
  }
  return "no InputError";
}

Table Read(const std::string& content) {
  const TempFolder folder;
  const std::filesystem::path file = folder.path() / "t.csv";
  WriteFileAtomically(file, content);
  return ReadCsv(file);
}

TEST(Table, HoldsRowsOfNamedColumns) {
  Table table({"t_s", "x_m"});
  EXPECT_EQ(table.rows(), 0U);
  table.AddRow({0.0, 1.0});
  table.AddRow({0.5, 2.0});
  EXPECT_EQ(table.rows(), 2U);
  EXPECT_EQ(table.at(1, 0), 0.5);
  EXPECT_EQ(table.Find("x_m"), 1);
  EXPECT_EQ(table.Find("y_m"), -1);
  EXPECT_THAT(table.Column("x_m"), ElementsAre(1.0, 2.0));
}

TEST(Table, NamesAMissingColumn) {
  try {
    (void)Table({"a"}).Column("b");
    FAIL() << "did not throw";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "b: no such column");
  }
}

TEST(Table, ChecksItsRows) {
  Table table({"a", "b"});
  EXPECT_THROW(table.AddRow({1.0}), InternalError);
  EXPECT_THROW(table.AddRow({1.0, 2.0, 3.0}), InternalError);
  EXPECT_THROW(Table({}), InternalError);
}

TEST(ToCsv, IsShortAndHasNoNegativeZero) {
  Table table({"a", "b"});
  table.AddRow({0.1, -0.0});
  table.AddRow({-2.0, 1e300});
  EXPECT_EQ(table.ToCsv(), "a,b\n0.1,0\n-2,1e+300\n");
}

TEST(ToCsv, ReadsBackBitForBit) {
  Table table({"x"});
  using Limits = std::numeric_limits<double>;
  for (const double x :
       {0.1, 1.0 / 3.0, Limits::denorm_min(), -Limits::denorm_min(), Limits::min(),
        std::nextafter(Limits::min(), 0.0), Limits::max(), Limits::lowest(), Limits::epsilon(),
        9007199254740993.0, 1e22, 5e-324, Limits::infinity(), -Limits::infinity()}) {
    table.AddRow({x});
  }
  std::mt19937_64 engine(81);
  while (table.rows() < 20000) {
    const double x = std::bit_cast<double>(static_cast<std::uint64_t>(engine()));  // any double
    if (!std::isnan(x) && x != 0.0) {
      table.AddRow({x});
    }
  }
  const Table back = RoundTrip(table);
  ASSERT_EQ(back.rows(), table.rows());
  for (std::size_t row = 0; row < table.rows(); ++row) {
    ASSERT_EQ(std::bit_cast<std::uint64_t>(back.at(row, 0)),
              std::bit_cast<std::uint64_t>(table.at(row, 0)))
        << "row " << row << ", " << table.at(row, 0);
  }
}

TEST(ToCsv, ReadsBackNotANumber) {
  Table table({"x"});
  table.AddRow({std::nan("")});
  EXPECT_TRUE(std::isnan(RoundTrip(table).at(0, 0)));
}

TEST(ToCsv, ReadsBackATableWithoutRows) {
  const Table back = RoundTrip(Table({"a", "b"}));
  EXPECT_THAT(back.columns(), ElementsAre("a", "b"));
  EXPECT_EQ(back.rows(), 0U);
}

TEST(ReadCsv, SkipsEmptyLinesAndTakesWindowsEndings) {
  const Table table = Read("a,b\r\n1,2\r\n\r\n3,4\r\n");
  EXPECT_THAT(table.columns(), ElementsAre("a", "b"));
  EXPECT_THAT(table.Column("b"), ElementsAre(2.0, 4.0));
}

TEST(ReadCsv, SkipsAByteOrderMarkAndSpacesAroundCells) {
  const Table table = Read("\xEF\xBB\xBF a ,\tb\n 1 ,\t2 \n");
  EXPECT_THAT(table.columns(), ElementsAre("a", "b"));
  EXPECT_EQ(table.at(0, 0), 1.0);
  EXPECT_EQ(table.at(0, 1), 2.0);
}

TEST(ReadCsv, TakesALastLineWithoutItsEnd) {
  EXPECT_THAT(Read("a\n1\n2").Column("a"), ElementsAre(1.0, 2.0));
}

TEST(ReadCsv, TakesQuotedCells) {
  EXPECT_THAT(Read("\"a,b\",c\n\"1\",2\n").columns(), ElementsAre("a,b", "c"));
}

TEST(ReadCsv, PlacesACellThatIsNoNumber) {
  EXPECT_EQ(ErrorMessages("a,b\n1,2\n3,x\n"), "t.csv:3: cell 2 (b): 'x' is not a number");
  EXPECT_EQ(ErrorMessages("a,b\n1,\n"), "t.csv:2: cell 2 (b): '' is not a number");
  EXPECT_EQ(ErrorMessages("a,b\n1.5m,2\n"), "t.csv:2: cell 1 (a): '1.5m' is not a number");
}

TEST(ReadCsv, CountsEmptyLinesAndWindowsEndings) {
  EXPECT_EQ(ErrorMessages("a\n\n\n1\nx\n"), "t.csv:5: cell 1 (a): 'x' is not a number");
  EXPECT_EQ(ErrorMessages("a\r\n1\r\nx\r\n"), "t.csv:3: cell 1 (a): 'x' is not a number");
}

TEST(ReadCsv, ListsEveryProblem) {
  EXPECT_EQ(ErrorMessages("a,b\nx,y\n1\n"),
            "t.csv:2: cell 1 (a): 'x' is not a number\nt.csv:2: cell 2 (b): 'y' is not a "
            "number\nt.csv:3: cell 2 (b): missing; 1 cell, the header has 2");
}

TEST(ReadCsv, StopsListingAfterTwenty) {
  std::string content = "a\n";
  for (int i = 0; i < 1000; ++i) {
    content += "x\n";
  }
  const std::string problems = ErrorMessages(content);
  EXPECT_EQ(std::count(problems.begin(), problems.end(), '\n'), 20);
  EXPECT_TRUE(
      problems.ends_with("t.csv:21: cell 1 (a): 'x' is not a number\n"
                         "t.csv: and 980 more problems"))
      << problems;
}

TEST(ReadCsv, RefusesRowsOfAnotherLength) {
  EXPECT_EQ(ErrorMessages("a,b\n1,2,3\n"), "t.csv:2: 3 cells, the header has 2");
  EXPECT_EQ(ErrorMessages("a,b,c,d\n1,2\n"),
            "t.csv:2: cell 3 (c): missing; 2 cells, the header has 4");
}

TEST(ReadCsv, RefusesBadHeaders) {
  EXPECT_EQ(ErrorMessages("a,a\n1,2\n"), "t.csv:1: cell 2 (a): repeated column");
  EXPECT_EQ(ErrorMessages("a,,c\n1,2,3\n"), "t.csv:1: cell 2: the column has no name");
  EXPECT_EQ(ErrorMessages(""), "t.csv:1: empty file; expected a header line of column names");
  EXPECT_EQ(ErrorMessages("\n\n"), "t.csv:3: empty file; expected a header line of column names");
}

TEST(ReadCsv, RefusesAnOpenQuote) {
  EXPECT_NE(ErrorMessages("a\n\"1\n"), "no InputError");
  EXPECT_NE(ErrorMessages("a\n1\"2\n"), "no InputError");
}

// Returns at once, because nothing beyond the limits is read.
TEST(ReadCsv, RefusesAMillionColumnsAndEndlessCells) {
  std::string wide;
  for (int i = 0; i < 1'000'000; ++i) {
    wide += fmt::format("{}{}", i == 0 ? "" : ",", i);
  }
  EXPECT_EQ(ErrorMessages(wide + "\n"), "t.csv:1: more than 4096 cells in a row");
  EXPECT_EQ(ErrorMessages("a\n" + std::string(100'000'000, 'x')),
            "t.csv:2: a cell of more than 65536 characters");
  EXPECT_EQ(ErrorMessages("a\n" + std::string(65'537, 'x') + "\n"),
            "t.csv:2: a cell of more than 65536 characters");
}

TEST(ReadCsv, CutsCellsInMessages) {
  const std::string message = ErrorMessages("a\n" + std::string(60'000, 'x') + "\n");
  EXPECT_LT(message.size(), 4100U);
  EXPECT_TRUE(message.ends_with("x ...")) << message;
}

TEST(ReadCsv, NamesBytesThatAreNoText) {
  EXPECT_EQ(ErrorMessages("a\n\xff\x1b\n"),
            "t.csv:2: cell 1 (a): '<0xFF><U+001B>' is not a number");
}

TEST(ReadCsv, OfAMissingFileIsARunError) {
  EXPECT_THROW(ReadCsv("/nonexistent/t.csv"), RunError);
}

TEST(ReadCsvExcerpt, TakesTheColumnsAskedForAndLooksAtNoOthers) {
  const TempFolder folder;
  const auto file = folder.Write("t.csv",
                                 "note,b,a,,note,inf\n"
                                 "slow,2,1,,x,inf\n"
                                 "\n"
                                 "\"so, so\",4,3,-,,nan\n");
  const CsvExcerpt excerpt = ReadCsvExcerpt(file, {"a"}, {"b", "c"});
  EXPECT_THAT(excerpt.table.columns(), ElementsAre("b", "a"));
  EXPECT_THAT(excerpt.table.Column("a"), ElementsAre(1.0, 3.0));
  EXPECT_THAT(excerpt.table.Column("b"), ElementsAre(2.0, 4.0));
  EXPECT_THAT(excerpt.lines, ElementsAre(2, 4));
}

TEST(ReadCsvExcerpt, NamesWhatIsMissing) {
  EXPECT_EQ(ErrorMessages("time,delta\n1,2\n", {"steering_rad"}),
            "t.csv:1: no column 'steering_rad'; columns: time, delta");
  EXPECT_EQ(ErrorMessages("t_s,stering_rad\n1,2\n", {"t_s", "steering_rad"}),
            "t.csv:1: no column 'steering_rad'; did you mean 'stering_rad'?");
  EXPECT_EQ(ErrorMessages("a,b\n1\n", {"b"}),
            "t.csv:2: cell 2 (b): missing; 1 cell, the header has 2");
  EXPECT_EQ(ErrorMessages("a,a\n1,2\n", {"a"}), "t.csv:1: cell 2 (a): repeated column");
  EXPECT_EQ(ErrorMessages("", {"a"}),
            "t.csv:1: empty file; expected a header line of column names");
}

TEST(ReadCsvExcerpt, WantsFiniteNumbers) {
  EXPECT_EQ(ErrorMessages("a,b\n1,\nnan,2\n-inf,x\n", {"a", "b"}),
            "t.csv:2: cell 2 (b): '' is not a number\n"
            "t.csv:3: cell 1 (a): 'nan' is not a finite number\n"
            "t.csv:4: cell 1 (a): '-inf' is not a finite number\n"
            "t.csv:4: cell 2 (b): 'x' is not a number");
}

TEST(ReadCsvColumns, PassesNoRowsOfAFileWithoutANeededColumn) {
  const TempFolder folder;
  const std::filesystem::path file = folder.Write("t.csv", "a,b\n1,2\n3,x\n");
  int rows = 0;
  try {
    ReadCsvColumns(file, {"a", "b", "c"}, ',', "",
                   [&](const std::vector<double>&, int) { ++rows; });
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("t.csv:1: no column 'c'; columns: a, b"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr("t.csv:3: cell 2 (b): 'x' is not a number"));
  }
  EXPECT_EQ(rows, 0);
}

}  // namespace
}  // namespace trackbed
