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
std::string TableText(const std::string& text, char delimiter = kFindDelimiter,
                      bool numbers_columns = false) {
  const TempFolder folder;
  std::string read;
  const auto take = [&](const std::vector<std::string>& cells, int line) {
    read += fmt::format("{}:{}\n", line, fmt::join(cells, "|"));
  };
  ProblemList problems;
  const CsvLimits limits{.delimiter = delimiter, .numbers_columns = numbers_columns};
  const bool has_names = ReadCsvTable(folder.Write("t.csv", text), limits, problems, take, take);
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

TEST(ReadCsvTable, TakesBlanksBetweenNumbersAsDelimiters) {
  EXPECT_EQ(TableText("a  b c\n 1 2   3 \r\n4\t5 6"), "1:a|b|c\n2:1|2|3\n3:4|5|6\n");
  EXPECT_EQ(TableText("#  a  b\n1   2\n3\t 4\n"), "1:a|b\n2:1|2\n3:3|4\n");
  // Names may contain blanks, if the rows below have other delimiters or fewer numbers.
  EXPECT_EQ(TableText("a b\n1\n2\n"), "1:a b\n2:1\n3:2\n");
  EXPECT_EQ(TableText("a b\n1,2\n"), "1:a b\n2:1|2\n");
  EXPECT_EQ(TableText("my a,my b\n1 ,2\n"), "1:my a|my b\n2:1|2\n");
}

// The file is read in blocks; a run of blanks may lie in two of them.
TEST(ReadCsvTable, ReplacesBlanksAcrossTheBlocksOfAFile) {
  std::string text = "a b\n";
  std::string read = "1:a|b\n";
  for (int row = 0; row < 4000; ++row) {
    text += fmt::format("{}{}{}\n", row, std::string(1 + static_cast<std::size_t>(row % 60), ' '),
                        -row);
    read += fmt::format("{}:{}|{}\n", row + 2, row, -row);
  }
  EXPECT_EQ(TableText(text), read);
}

TEST(ReadCsvTable, NumbersTheColumnsOfATableWithoutNames) {
  EXPECT_EQ(TableText("7,8\n9,10\n", kFindDelimiter, true), "1:1|2\n1:7|8\n2:9|10\n");
  EXPECT_EQ(TableText("7 8 9\n", kFindDelimiter, true), "1:1|2|3\n1:7|8|9\n");
  EXPECT_EQ(TableText("# a,b\n7,8\n", kFindDelimiter, true), "1:a|b\n2:7|8\n");
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

// 3120 minutes are 52 degrees; longitudes are positive to the west in the file.
TEST(ReadCsvTable, ReadsVboFiles) {
  const std::string head =
      "File created on 01/03/2016 @ 14:26\r\n\r\n[header]\r\nsatellites\r\ntime\r\nlatitude\r\n"
      "longitude\r\nvelocity mph\r\nYaw rate deg/s\r\n\r\n[comments]\r\nMade by, \"me\r\n"
      "# \r\n[column names]\r\nsats time lat long velocity  YawRate \r\n\r\n[data]\r\n";
  EXPECT_EQ(TableText(head + "014 235959.500 +3120.0 -0060.0 018.0 +1.5\r\n"
                             "015 000000.25 -3120,00 +0090,0 018,0 -1,5\r\n"),
            "15:sats|time [s]|lat [deg]|long [deg]|velocity [mph]|YawRate [deg/s]\n"
            "18:014|86399.500000|52|1|018.0|1.5\n19:015|86400.250000|-52|-1.5|018.0|-1.5\n");
  // RaceChrono writes no first line; without a description, velocities are in km/h.
  EXPECT_EQ(TableText("[column names]\ntime velocity\n[data]\n010203.4 5\n"),
            "2:time [s]|velocity [kmh]\n4:3723.400000|5\n");
  EXPECT_THAT(TableText("[column names]\ntime velocity\n[data]\n017503.4 5\n"),
              HasSubstr("t.csv:4: '017503.4' is no time of day hhmmss"));
  EXPECT_THAT(TableText("File created on 01/03/2016 @ 14:26\r\n\r\n[header]\r\nsats\r\n"),
              HasSubstr("t.csv:1: a VBO file of Racelogic whose first 64 KiB have no table"));
  EXPECT_THAT(TableText("File created,b\n1,2\n"), HasSubstr("1:File created|b"));
}

TEST(ReadCsvTable, ReadsDecimalCommas) {
  EXPECT_EQ(TableText("x;y\n0,5;1,25\n-1,5;+2\n"), "1:x|y\n2:0.5|1.25\n3:-1.5|2\n");
  EXPECT_EQ(TableText("t\tv\n0,5\t1,125\n"), "1:t|v\n2:0.5|1.125\n");
  EXPECT_EQ(TableText("0,5;1,5;2\n1;2,5;3\n", kFindDelimiter, true),
            "1:1|2|3\n1:0.5|1.5|2\n2:1|2.5|3\n");
  EXPECT_EQ(TableText("day;v\n12.05.2024;1,5e-3\n"), "1:day|v\n2:12.05.2024|1.5e-3\n");
  EXPECT_EQ(TableText("Made by a logger\n\nt;v\ns;km/h\n0,5;36,0\n1;36,0\n"),
            "3:t [s]|v [km/h]\n5:0.5|36.0\n6:1|36.0\n");
}

// Such a comma may be between thousands.
TEST(ReadCsvTable, KeepsOtherCommas) {
  EXPECT_EQ(TableText("x;y\n1,000;2,500\n"), "1:x|y\n2:1,000|2,500\n");
  EXPECT_EQ(TableText("x;y\n1,5;2.5\n"), "1:x|y\n2:1,5|2.5\n");
  EXPECT_EQ(TableText("x;y\n1,5;1.234,5\n"), "1:x|y\n2:1,5|1.234,5\n");
  EXPECT_EQ(TableText("x;y\n1,5;1,234,567\n"), "1:x|y\n2:1,5|1,234,567\n");
  EXPECT_EQ(TableText("x,y\n\"1,5\",2\n"), "1:x|y\n2:1,5|2\n");
}

TEST(ReadCsvTable, RemovesTheSignPlus) {
  EXPECT_EQ(TableText("x,y\n+1.5,+.5e+1\n+a,+\n"), "1:x|y\n2:1.5|.5e+1\n3:+a|+\n");
}

TEST(ReadCsvTable, RefusesUtf16) {
  EXPECT_THAT(TableText(std::string("\xFF\xFEx\0,\0y\0\n\0", 10)), HasSubstr("save it as UTF-8"));
}

// Loggers write about the session before the table, in lines with other numbers of cells.
TEST(ReadCsvTable, SkipsThePreambleOfLoggers) {
  const std::string aim = "\"Format\",\"CSV File\"\r\n\"Segment Times\",\"0:10\",\"0:20\"\r\n\r\n";
  EXPECT_EQ(TableText(aim + "\"Time\",\"Speed\",\"X\",\"Y\"\r\n\"s\",\"km/h\",\"\",\"m\"\r\n\r\n"
                            "\"0\",\"36\",\"1\",\"2\"\r\n\"1\",\"36\",\"11\",\"2\"\r\n"),
            "4:Time [s]|Speed [km/h]|X|Y [m]\n7:0|36|1|2\n8:1|36|11|2\n");
  // The line that numbers the columns is no row; in a table without preamble, such a row stays.
  EXPECT_EQ(
      TableText(aim + "Time,Speed,X,Y\r\ns,km/h,,m\r\n1,2,3,4\r\n\r\n0,36,1,2\r\n1,36,11,2\r\n"),
      "4:Time [s]|Speed [km/h]|X|Y [m]\n8:0|36|1|2\n9:1|36|11|2\n");
  EXPECT_EQ(TableText("t,x\ns,m\n1,2\n2,3\n"), "1:t [s]|x [m]\n3:1|2\n4:2|3\n");
  // Units in brackets.
  EXPECT_EQ(TableText("t;x\n[s];[m]\n5;2\n6;3\n"), "1:t [s]|x [m]\n3:5|2\n4:6|3\n");
  // A line of units and one of sources, and a first line without any delimiter.
  EXPECT_EQ(TableText("Made by a logger\nFormat,3\n\nt,lap,x,y\nunix time,,m,m\n,,100: gps,calc\n"
                      "7,1,0,0\n8,1,5,0\n"),
            "4:t [unix time]|lap|x [m]|y [m]\n7:7|1|0|0\n8:8|1|5|0\n");
  // The same quantity of two sensors.
  EXPECT_EQ(TableText("Made by a logger\n\nt,v,v,v\ns,m/s,m/s,km/h\n7,1,2,3\n8,1,2,3\n"),
            "3:t [s]|v [m/s]|v [m/s] (2)|v [km/h]\n5:7|1|2|3\n6:8|1|2|3\n");
  // A preamble that is not valid CSV, and one with another delimiter than the table.
  EXPECT_EQ(
      TableText(
          "\"Track of a game,\"2017-09-03\",0,1,\"v3\"\n\"dist\",\"x\",\"y\"\n0,1,2\n1,2,2\n"),
      "2:dist|x|y\n3:0|1|2\n4:1|2|2\n");
  EXPECT_EQ(TableText("Session, Monday\nx;y\n1.5;2\n2.5;2\n"), "2:x|y\n3:1.5|2\n4:2.5|2\n");
}

// A first line with as many cells as the rows stays the header.
TEST(ReadCsvTable, TakesNoHeaderForAPreamble) {
  EXPECT_EQ(TableText("x,y\n1,2,3\n4,5,6\n"), "1:x|y\n2:1|2|3\n3:4|5|6\n");
  EXPECT_EQ(TableText("x,y\nn/a,n/a\n1,2\n3,4\n"), "1:x|y\n2:n/a|n/a\n3:1|2\n4:3|4\n");
  EXPECT_EQ(TableText("name,y\nab,2\n1,2\n3,4\n"), "1:name|y\n2:ab|2\n3:1|2\n4:3|4\n");
  EXPECT_EQ(TableText("x,y\nft,ft\n1,2\n3,4\n"), "1:x [ft]|y [ft]\n3:1|2\n4:3|4\n");
}

TEST(ReadCsvTable, DropsEmptyCellsAtTheEnd) {
  EXPECT_EQ(TableText("a,b,\n1,2,\n3,4\n5,,\n"), "1:a|b\n2:1|2\n3:3|4\n4:5|\n");
  EXPECT_EQ(TableText("# a,b\n1,2,\n"), "1:a|b\n2:1|2\n");
  EXPECT_EQ(TableText("a,b\n1,2\n,\n,,\n3,4\n"), "1:a|b\n2:1|2\n5:3|4\n");
}

}  // namespace
}  // namespace trackbed
