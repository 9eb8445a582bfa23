#include "trackbed/core/foreign_content.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "src/core/markup.h"

// Recognizes file types by their first bytes ("magic numbers"), as the program `file` does.
namespace trackbed {
namespace {

using std::string_view_literals::operator""sv;

struct Kind {
  std::string_view begin;
  std::string_view explanation;
};

constexpr std::string_view kNmea =
    "sentences of NMEA 0183; convert them first: gpsbabel -i nmea -f FILE -o gpx -F FILE.gpx";

constexpr std::array kKinds{
    Kind{"\x1F\x8B"sv, "compressed by gzip; decompress it first: gunzip FILE"},
    Kind{"BZh"sv, "compressed by bzip2; decompress it first: bunzip2 FILE"},
    Kind{"\xFD"
         "7zXZ"sv,
         "compressed by xz; decompress it first: unxz FILE"},
    Kind{"\x28\xB5\x2F\xFD"sv, "compressed by zstd; decompress it first: zstd -d FILE"},
    Kind{"\x04\x22\x4D\x18"sv, "compressed by lz4; decompress it first: lz4 -d FILE"},
    Kind{"PK\x03\x04"sv,
         "a ZIP archive, as spreadsheets (.xlsx, .ods) and .kmz are; export the table as CSV, or "
         "unpack the archive: unzip FILE"},
    Kind{"7z\xBC\xAF\x27\x1C"sv, "a 7-Zip archive; unpack it first: 7z x FILE"},
    Kind{"\xD0\xCF\x11\xE0"sv, "a file of Microsoft Office; export the table as CSV"},
    Kind{"\x89HDF"sv, "HDF5 (also MATLAB 7.3); export the table as CSV"},
    Kind{"MATLAB 5.0 MAT-file"sv, "a MAT-file of MATLAB; export the table as CSV, by writetable"},
    Kind{"PAR1"sv, "Parquet; export the table as CSV"},
    Kind{"\x93NUMPY"sv, "an array of NumPy; export it as CSV, by numpy.savetxt"},
    Kind{"SQLite format 3"sv, "an SQLite database; bags need a name that ends with .db3"},
    Kind{"\x89MCAP0"sv, "MCAP; bags need a name that ends with .mcap"},
    Kind{"#ROSBAG V2"sv,
         "a bag of ROS 1; convert it first: rosbags-convert --src FILE --dst FOLDER"},
    Kind{"$GP"sv, kNmea},
    Kind{"$GN"sv, kNmea},
    Kind{"$GL"sv, kNmea},
    Kind{"$GA"sv, kNmea},
    Kind{"$GB"sv, kNmea},
    Kind{"$BD"sv, kNmea},
    Kind{"$PUBX,"sv, kNmea},
    Kind{"%PDF-"sv, "a PDF document"},
    Kind{"\x89PNG"sv, "a picture (PNG)"},
    Kind{"\xFF\xD8\xFF"sv, "a picture (JPEG)"},
    Kind{"\xFF\xFE"sv, "text in UTF-16; save it as UTF-8, as by: iconv -f UTF-16 -t UTF-8"},
    Kind{"\xFE\xFF"sv, "text in UTF-16; save it as UTF-8, as by: iconv -f UTF-16 -t UTF-8"},
};

/// Describes an error of tinyxml2 by its name.
std::string_view XmlErrorText(std::string_view name) {
  constexpr std::array kTexts{
      std::pair{"XML_ERROR_MISMATCHED_ELEMENT"sv,
                "element not closed, or closed by another name"sv},
      std::pair{"XML_ERROR_PARSING_ATTRIBUTE"sv,
                "attribute not of the form name=\"value\", given twice, or cut off"sv},
      std::pair{"XML_ERROR_PARSING_TEXT"sv, "text without a following element"sv},
      std::pair{"XML_ERROR_PARSING_COMMENT"sv, "comment not closed by -->"sv},
      std::pair{"XML_ERROR_PARSING_CDATA"sv, "CDATA section not closed by ]]>"sv},
      std::pair{"XML_ERROR_PARSING_DECLARATION"sv,
                "declaration <?...?> not closed or not at the start"sv},
      std::pair{"XML_ERROR_PARSING_UNKNOWN"sv, "declaration <!...> not closed"sv},
      std::pair{"XML_ELEMENT_DEPTH_EXCEEDED"sv, "elements are nested too deeply"sv},
      std::pair{"XML_ERROR_EMPTY_DOCUMENT"sv, "no element"sv},
  };
  for (const auto& [own, text] : kTexts) {
    if (own == name) {
      return text;
    }
  }
  return "element not of the form <name attribute=\"value\">";
}

}  // namespace

std::string ForeignBytes(std::string_view content) {
  for (const Kind& kind : kKinds) {
    if (content.starts_with(kind.begin)) {
      return std::string(kind.explanation);
    }
  }
  if (const std::size_t at = content.find('\0'); at != std::string_view::npos) {
    return fmt::format("binary data, not text: byte {} is 0", at);
  }
  return "";
}

std::string ForeignContent(std::string_view content) {
  if (content.empty()) {
    return "the file is empty";
  }
  return IsWebPage(content) ? "a web page; download the file itself" : ForeignBytes(content);
}

std::string ParseProblem(std::string_view content, std::string_view format,
                         std::string_view error) {
  const std::string foreign = ForeignContent(content);
  return foreign.empty() ? fmt::format("not {}: {}", format, error) : foreign;
}

std::string XmlProblem(std::string_view content, std::string_view error_name) {
  return ParseProblem(content, "XML", XmlErrorText(error_name));
}

}  // namespace trackbed
