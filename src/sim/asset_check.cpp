#include "src/sim/asset_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>

namespace trackbed {
namespace {

// Maximum width and height of a texture image [px].
constexpr std::uint32_t kMaxPixels = 8192;
// Maximum number of rows and of columns of a height field.
constexpr std::uint32_t kMaxHeightSamples = 4096;
// Maximum number of faces of an STL file, equal to MuJoCo's own limit.
constexpr std::uint32_t kMaxFaces = 200000;
// Maximum number of facets along one side of a drawn sphere or plane.
constexpr std::uint32_t kMaxFacets = 256;
/// Maximum length of a word (a name or number) in the model file; the length is limited because
/// MuJoCo copies words of the model file into error messages, in a buffer of about 500 characters.
constexpr std::size_t kMaxWordLength = 200;

std::string LowerExtension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

template <typename Number>
std::optional<Number> ReadNumber(std::string_view content, std::size_t offset) {
  Number number{};
  if (content.size() < offset + sizeof number) {
    return std::nullopt;
  }
  std::memcpy(&number, content.data() + offset, sizeof number);
  return number;
}

/// Reads a big-endian unsigned integer, as used in PNG files.
std::optional<std::uint32_t> ReadBigEndian(std::string_view content, std::size_t offset) {
  if (content.size() < offset + 4) {
    return std::nullopt;
  }
  std::uint32_t number = 0;
  for (const char byte : content.substr(offset, 4)) {
    number = number << 8U | static_cast<unsigned char>(byte);
  }
  return number;
}

/// Checks the header of a PNG file (W3C, Portable Network Graphics, Second Edition, sections 5.2
/// and 11.2.2).
std::string PngError(std::string_view content) {
  constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n", 8);
  if (!content.starts_with(kSignature) || content.size() < 16 || content.substr(12, 4) != "IHDR") {
    return "is no PNG picture";
  }
  const auto width = ReadBigEndian(content, 16);
  const auto height = ReadBigEndian(content, 20);
  if (!width || !height || *width == 0 || *height == 0) {
    return "is a PNG picture without a size";
  }
  if (*width > kMaxPixels || *height > kMaxPixels) {
    return fmt::format("has {} x {} pixels; must have at most {} on a side", *width, *height,
                       kMaxPixels);
  }
  return "";
}

/// Checks an STL file, which consists of a header of 80 bytes, the number of triangles, and 50
/// bytes per triangle.
std::string StlError(std::string_view content) {
  constexpr std::size_t kHeader = 84;
  constexpr std::size_t kFace = 50;
  const auto faces = ReadNumber<std::uint32_t>(content, 80);
  if (!faces || *faces == 0 || *faces > kMaxFaces || content.size() != kHeader + kFace * *faces) {
    return fmt::format("is no binary STL file of 1 to {} triangles", kMaxFaces);
  }
  return "";
}

/// Checks a file in MuJoCo's height field format, which consists of the numbers of rows and
/// columns, followed by the heights.
std::string HeightFieldError(std::string_view content) {
  const auto rows = ReadNumber<std::int32_t>(content, 0);
  const auto columns = ReadNumber<std::int32_t>(content, 4);
  const auto bad = [](const std::optional<std::int32_t>& count) {
    return !count || *count < 2 || *count > static_cast<std::int32_t>(kMaxHeightSamples);
  };
  if (bad(rows) || bad(columns)) {
    return fmt::format("is no height field of 2 to {} rows and columns", kMaxHeightSamples);
  }
  const std::size_t samples = static_cast<std::size_t>(*rows) * static_cast<std::size_t>(*columns);
  if (content.size() != 8 + 4 * samples) {
    return fmt::format("has {} bytes; {} x {} heights take {}", content.size(), *rows, *columns,
                       8 + 4 * samples);
  }
  for (std::size_t i = 0; i < samples; ++i) {
    if (!std::isfinite(*ReadNumber<float>(content, 8 + 4 * i))) {
      return fmt::format("has a height that is not finite, in row {}",
                         i / static_cast<std::size_t>(*columns) + 1);
    }
  }
  return "";
}

/// Returns the length of the longest word in the value of an XML attribute. The value of an
/// attribute is either a list of words, such as numbers, or a name.
std::size_t LongestWord(std::string_view text) {
  std::size_t longest = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(" \t\r\n"), text.size());
    longest = std::max(longest, end);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return longest;
}

}  // namespace

std::string AssetError(std::string_view kind, const std::filesystem::path& file,
                       std::string_view content) {
  const std::string extension = LowerExtension(file);
  if (content.empty()) {
    return "is empty";
  }
  if (kind == "texture") {
    return extension == ".png" ? PngError(content) : "must be a .png file";
  }
  if (kind == "hfield") {
    return extension == ".png" ? PngError(content) : HeightFieldError(content);
  }
  if (kind == "mesh") {
    return extension == ".stl"   ? StlError(content)
           : extension == ".obj" ? ""
                                 : "must be a .obj or binary .stl file";
  }
  return fmt::format("is not read: files of <{}> are not supported", kind);
}

std::string ElementError(const tinyxml2::XMLElement& element) {
  for (const tinyxml2::XMLAttribute* attribute = element.FirstAttribute(); attribute != nullptr;
       attribute = attribute->Next()) {
    const std::string_view value = attribute->Value();
    const bool is_file = std::string_view(attribute->Name()).starts_with("file");
    const std::size_t length = is_file ? value.size() : LongestWord(value);
    if (length > kMaxWordLength) {
      return fmt::format("a word of {} has {} characters; must have at most {}", attribute->Name(),
                         length, kMaxWordLength);
    }
  }
  struct Count {
    std::string_view element;
    const char* attribute;
    std::uint32_t most;
  };
  static constexpr std::array kCounts{
      Count{"texture", "width", kMaxPixels},      Count{"texture", "height", kMaxPixels},
      Count{"hfield", "nrow", kMaxHeightSamples}, Count{"hfield", "ncol", kMaxHeightSamples},
      Count{"quality", "numslices", kMaxFacets},  Count{"quality", "numstacks", kMaxFacets},
      Count{"quality", "numquads", kMaxFacets}};
  for (const Count& own : kCounts) {
    std::int64_t count = 0;
    if (own.element == element.Name() &&
        element.QueryInt64Attribute(own.attribute, &count) == tinyxml2::XML_SUCCESS &&
        (count < 0 || count > own.most)) {
      return fmt::format("{} is {}; must be from 0 to {}", own.attribute, count, own.most);
    }
  }
  return "";
}

}  // namespace trackbed
