#include "trackbed/core/text_table.h"

#include <csv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>

#include "tests/support/temp_folder.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

using Rows = std::vector<std::vector<std::string>>;

/// The rows that libcsv reads from a text with strict rules for quotes.
Rows ReadBack(const std::string& text) {
  Rows rows(1);
  csv_parser parser{};
  csv_init(&parser, CSV_STRICT | CSV_STRICT_FINI);
  const auto cell = [](void* data, std::size_t size, void* out) {
    static_cast<Rows*>(out)->back().emplace_back(static_cast<const char*>(data), size);
  };
  const auto row = [](int, void* out) { static_cast<Rows*>(out)->emplace_back(); };
  EXPECT_EQ(csv_parse(&parser, text.data(), text.size(), cell, row, &rows), text.size());
  EXPECT_EQ(csv_fini(&parser, cell, row, &rows), 0);
  csv_free(&parser);
  rows.pop_back();  // the empty row begun after the last line
  return rows;
}

TEST(TextTable, WritesCellsAsTheyAre) {
  TextTable table({"mission.speed", "status"});
  table.AddRow({"2.5", "passed"});
  table.AddRow({"", "failed"});
  EXPECT_EQ(table.ToCsv(), "mission.speed,status\n2.5,passed\n,failed\n");
}

TEST(TextTable, QuotesWhatWouldBeTakenForSomethingElse) {
  const Rows rows{{"drive.plants", "say \"why\""},
                  {"[kinematic, mujoco]", "two\nlines"},
                  {"\"", ",\r\n"},
                  {"", ""}};
  TextTable table(rows[0]);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    table.AddRow(rows[i]);
  }
  EXPECT_TRUE(table.ToCsv().starts_with(
      "drive.plants,\"say \"\"why\"\"\"\n\"[kinematic, mujoco]\",\"two\nlines\"\n"));
  EXPECT_EQ(ReadBack(table.ToCsv()), rows);
}

TEST(TextTable, KeepsARowOfOneEmptyCell) {
  TextTable table({"mission.speed"});
  table.AddRow({""});
  EXPECT_EQ(ReadBack(table.ToCsv()), (Rows{{"mission.speed"}, {""}}));
}

TEST(TextTable, RefusesRowsOfAnotherWidth) {
  TextTable table({"a", "b"});
  EXPECT_THROW(table.AddRow({"1"}), InternalError);
  EXPECT_THROW(TextTable({}), InternalError);
}

TEST(CellNumber, IsTheWholeCellOrNothing) {
  EXPECT_EQ(CellNumber("-1.5e3"), -1500.0);
  EXPECT_EQ(CellNumber(ShortestText(1.0 / 3.0)), 1.0 / 3.0);
  for (const char* text : {"", " ", "1 m", " 1", "1,5", "nan", "inf", "-inf", "1e999", "0x10"}) {
    EXPECT_EQ(CellNumber(text), std::nullopt) << text;
  }
}

TEST(FormatDistinct, TakesTheDigitsThatItTakes) {
  using Texts = std::pair<std::string, std::string>;
  EXPECT_EQ(FormatDistinct(0.1, 0.12345678), Texts("0.1", "0.1235"));
  EXPECT_EQ(FormatDistinct(0.03703, 0.0370349), Texts("0.03703", "0.037035"));
  EXPECT_EQ(FormatDistinct(1.0, std::nextafter(1.0, 2.0)), Texts("1", "1.0000000000000002"));
  EXPECT_EQ(FormatDistinct(0.5, 0.5), Texts("0.5", "0.5"));
}

TEST(ShortestText, ReadsBackToTheSameNumber) {
  EXPECT_EQ(ShortestText(0.1), "0.1");
  EXPECT_EQ(ShortestText(3.0), "3");
  EXPECT_EQ(ShortestText(-0.0), "0");
  for (const double number : {1.0 / 3.0, 1e300, std::numeric_limits<double>::denorm_min(), -2e-7}) {
    EXPECT_EQ(std::strtod(ShortestText(number).c_str(), nullptr), number);
  }
}

TEST(ReadTextCsv, IsTheInverseOfToCsv) {
  const TempFolder folder;
  TextTable table({"drive.plants", "status, of \"it\"", "empty"});
  table.AddRow({"[kinematic, mujoco]", "two\nlines", ""});
  table.AddRow({"\"", "", ""});
  const TextTable read = ReadTextCsv(folder.Write("sweep.csv", "\xEF\xBB\xBF" + table.ToCsv()));
  EXPECT_EQ(read.columns(), table.columns());
  EXPECT_EQ(read.rows(), table.rows());
}

TEST(ReadTextCsv, NamesFileAndLineOfWhatIsWrong) {
  const TempFolder folder;
  const auto error = [&](const std::string& text) -> std::string {
    try {
      ReadTextCsv(folder.Write("sweep.csv", text));
    } catch (const InputError& problem) {
      return problem.what();
    }
    return "no error";
  };
  using testing::EndsWith;
  EXPECT_THAT(error("a,b\n1,2\n\n3\n"), EndsWith("sweep.csv:4: 1 cell, the header has 2"));
  // A cell that spans two lines is part of one row.
  EXPECT_THAT(error("a,b\n\"1\n2\",2\n3,4,5\n"),
              EndsWith("sweep.csv:4: 3 cells, the header has 2"));
  EXPECT_THAT(error("a,a\n"), EndsWith("sweep.csv:1: repeated column 'a'"));
  EXPECT_THAT(error("a,,b\n"), EndsWith("sweep.csv:1: cell 2: the column has no name"));
  EXPECT_THAT(error("a,b\n\"1\"2,3\n"), testing::HasSubstr("sweep.csv:2: "));
  EXPECT_THAT(error(""), testing::HasSubstr("empty file"));
  EXPECT_THROW(ReadTextCsv(folder.path() / "missing.csv"), RunError);
}

}  // namespace
}  // namespace trackbed
