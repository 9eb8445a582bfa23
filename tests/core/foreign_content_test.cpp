#include "trackbed/core/foreign_content.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

// The first bytes of other kinds of files are those of the programs that write them: gzip, bzip2,
// xz, zstd, lz4, zip, 7z, LibreOffice, MATLAB, SQLite, mcap, rosbag.
namespace trackbed {
namespace {

using ::testing::HasSubstr;
using std::string_literals::operator""s;

TEST(ForeignContent, NamesOtherKindsOfFilesAndARemedy) {
  const std::vector<std::pair<std::string, std::string>> kinds{
      {"", "the file is empty"},
      {"\x1F\x8B\x08\0\0\0\0\0"s, "gunzip"},
      {"BZh91AY&SY", "bunzip2"},
      {"\xFD"
       "7zXZ\0"s,
       "unxz"},
      {"\x28\xB5\x2F\xFD\x04", "zstd -d"},
      {"\x04\x22\x4D\x18\x64", "lz4 -d"},
      {"PK\x03\x04\x14\0\x06\0"s, "export the table as CSV"},
      {"7z\xBC\xAF\x27\x1C", "7z x"},
      {"\xD0\xCF\x11\xE0\xA1\xB1", "Microsoft Office"},
      {"\x89HDF\r\n", "HDF5"},
      {"MATLAB 5.0 MAT-file, Platform: GLNXA64", "writetable"},
      {"PAR1", "Parquet"},
      {"\x93NUMPY\x01", "numpy.savetxt"},
      {"SQLite format 3\0"s, ".db3"},
      {"\x89MCAP0\r\n", ".mcap"},
      {"#ROSBAG V2.0\n", "rosbags-convert"},
      {"$GPRMC,102233.000,A,4815.7,N,01140.0,E", "gpsbabel -i nmea"},
      {"$GNGGA,102233.000,4815.7,N,01140.0,E", "gpsbabel -i nmea"},
      {"$GLGSV,3,1,09,65,,,", "gpsbabel -i nmea"},
      {"$PUBX,00,102233.00,4815.7,N", "gpsbabel -i nmea"},
      {"%PDF-1.4", "PDF"},
      {"\x89PNG\r\n", "PNG"},
      {"\xFF\xD8\xFF\xE0", "JPEG"},
      {"\xFF\xFE<\0"s, "iconv -f UTF-16"},
      {"\xFE\xFF\0<"s, "iconv -f UTF-16"},
      {"\n<!DOCTYPE html>\n<html lang=\"en\">", "web page"},
      {"x,y\n1,\0"s, "byte 6 is 0"},
  };
  for (const auto& [content, explanation] : kinds) {
    EXPECT_THAT(ForeignContent(content), HasSubstr(explanation));
  }
}

TEST(ForeignContent, KnowsNothingAgainstText) {
  for (const std::string& text :
       {"x,y\n0,0\n"s, "\xEF\xBB\xBFx;y\n"s, "<?xml version=\"1.0\"?><gpx/>"s, "{\"type\": 1}"s,
        "PKX1 = 20"s, "BZ,1"s, "PARAMETERS\n"s, "7.5,3\n"s, "\xE9,\xFC\n"s}) {
    EXPECT_EQ(ForeignContent(text), "") << text;
  }
}

TEST(ForeignContent, TheErrorOfAParserIsForText) {
  EXPECT_EQ(ParseProblem("<a>", "XML", "no end"), "not XML: no end");
  EXPECT_THAT(ParseProblem("\x1F\x8B", "XML", "no end"), HasSubstr("gunzip"));
  EXPECT_EQ(XmlProblem("<a></b>", "XML_ERROR_MISMATCHED_ELEMENT"),
            "not XML: element not closed, or closed by another name");
  EXPECT_EQ(XmlProblem(" ", "XML_ERROR_EMPTY_DOCUMENT"), "not XML: no element");
}

}  // namespace
}  // namespace trackbed
