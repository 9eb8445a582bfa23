#include "trackbed/core/csv_rows.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/temp_folder.h"
#include "trackbed/core/error.h"

/// Tables of other programs: delimiters, comments and headers.
namespace trackbed {
namespace {

using ::testing::HasSubstr;

/// The names and rows of a table, one a line, each after the number of its line.
std::string TableText(const std::string& text, char delimiter = kFindDelimiter) {
  const TempFolder folder;
  std::string read;
  const auto take = [&](const std::vector<std::string>& cells, int line) {
    read += fmt::format("{}:{}\n", line, fmt::join(cells, "|"));
  };
  ProblemList problems;
  const bool has_names =
      ReadCsvTable(folder.Write("t.csv", text), {.delimiter = delimiter}, problems, take, take);
  try {
    problems.ThrowIfAny();
  } catch (const InputError& error) {
    return error.what();
  }
  return has_names ? read : "no names";
}

TEST(ReadCsvTable, FindsTheDelimiterInTheFirstLine) {
  EXPECT_EQ(TableText("a,b\n1,2\n"), "1:a|b\n2:1|2\n");
  EXPECT_EQ(TableText("a;b\n1;2\n"), "1:a|b\n2:1|2\n");
  EXPECT_EQ(TableText("a\tb\r\n1\t2\r\n"), "1:a|b\n2:1|2\n");
  EXPECT_EQ(TableText("# x, y, z\na; b\n1; 2"), "2:a|b\n3:1|2\n");
  EXPECT_EQ(TableText("a;b\n1;2\n", ','), "1:a;b\n2:1;2\n");
}

TEST(ReadCsvTable, TakesNamesFromACommentBeforeNumbers) {
  EXPECT_EQ(TableText("# hash\n# a; b ;c\n# more\n1;2;3\n"), "2:a|b|c\n4:1|2|3\n");
  EXPECT_EQ(TableText("\xEF\xBB\xBF#a,b\n\n1,2\n"), "1:a|b\n3:1|2\n");
  EXPECT_THAT(TableText("1,2\n3,4\n"), HasSubstr("no column names"));
  EXPECT_THAT(TableText("# only a comment\n1,2\n"), HasSubstr("no column names"));
  EXPECT_EQ(TableText("# a,b\n"), "no names");
  EXPECT_EQ(TableText(" # a,b\n1,2\n"), "1:a|b\n2:1|2\n");
  EXPECT_EQ(TableText("\xEF\xBB\xBF# x, y, z\n# a;b\n1;2\n"), "2:a|b\n3:1|2\n");
}

// A comment may contain quotes, which begin a quoted cell outside of comments.
TEST(ReadCsvTable, SkipsCommentsWhateverTheyContain) {
  EXPECT_EQ(TableText("# made by \"me\n# it's \"so\", yes\na,b\n1,2\n# \"\n3,4\n# end"),
            "3:a|b\n4:1|2\n6:3|4\n");
  EXPECT_EQ(TableText("a,b\n\"1\n#2\",3\n4,5\n"), "1:a|b\n2:1\n#2|3\n4:4|5\n");
  EXPECT_THAT(TableText("a,b\n#" + std::string(70000, 'x') + "\n1,2\n"),
              HasSubstr("a comment of more than 65536 characters"));
}

TEST(ReadCsvTable, DropsEmptyCellsAtTheEnd) {
  EXPECT_EQ(TableText("a,b,\n1,2,\n3,4\n5,,\n"), "1:a|b\n2:1|2\n3:3|4\n4:5|\n");
  EXPECT_EQ(TableText("# a,b\n1,2,\n"), "1:a|b\n2:1|2\n");
}

}  // namespace
}  // namespace trackbed
