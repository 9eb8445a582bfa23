#include "src/scenario/map_image.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <utility>

#include "trackbed/core/error.h"
#include "trackbed/scenario/map_file.h"

namespace trackbed {
namespace {

[[noreturn]] void RefuseImage(const std::string& file, std::string message) {
  throw InputError(Problem{.file = file, .message = std::move(message)});
}

/// Checks the size of an image before memory for the image is allocated.
void CheckSize(const std::string& file, std::uint64_t columns, std::uint64_t rows) {
  if (columns == 0 || rows == 0 || columns > kMaxMapCells || rows > kMaxMapCells ||
      columns * rows > kMaxMapCells) {
    RefuseImage(file, fmt::format("an image of {} x {} pixels; must be 1 to {} pixels", columns,
                                  rows, kMaxMapCells));
  }
}

/// Parses the numbers of a PGM file: the header and, in format P2, the pixels.
class PgmNumbers {
 public:
  PgmNumbers(const std::string& content, const std::string& file) : file_(file), rest_(content) {
    rest_.remove_prefix(2);  // skip the first two characters, which are the format name P2 or P5
  }

  /// Skips white space and comments of the image file, and reads the integer that follows.
  std::uint64_t Next(const char* what) {
    SkipBlanks();
    std::uint64_t number = 0;
    const char* end = rest_.data() + rest_.size();
    const auto [after, error] = std::from_chars(rest_.data(), end, number);
    if (error != std::errc() || (after != end && !IsBlank(*after) && *after != '#')) {
      RefuseImage(file_, fmt::format("no whole number where a PGM file has its {}", what));
    }
    rest_.remove_prefix(static_cast<std::size_t>(after - rest_.data()));
    return number;
  }

  /// Returns the part of the image file after the last number that Next returned and after the
  /// blank that follows this number.
  [[nodiscard]] std::string_view AfterBlank() const {
    return rest_.empty() ? rest_ : rest_.substr(1);
  }

 private:
  static bool IsBlank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

  void SkipBlanks() {
    while (!rest_.empty() && (IsBlank(rest_.front()) || rest_.front() == '#')) {
      const std::size_t skipped =
          rest_.front() == '#' ? std::min(rest_.find('\n'), rest_.size()) : 1;
      rest_.remove_prefix(skipped);
    }
  }

  const std::string& file_;
  std::string_view rest_;
};

MapImage ReadPgm(const std::string& content, const std::string& file) {
  PgmNumbers numbers(content, file);
  const std::uint64_t columns = numbers.Next("width");
  const std::uint64_t rows = numbers.Next("height");
  const std::uint64_t white = numbers.Next("largest value");
  CheckSize(file, columns, rows);
  constexpr std::uint64_t kMaxGray = 65535;
  if (white == 0 || white > kMaxGray) {
    RefuseImage(file, fmt::format("a largest value of {}; must be 1 to {}", white, kMaxGray));
  }
  MapImage image{.columns = static_cast<int>(columns),
                 .rows = static_cast<int>(rows),
                 .white = static_cast<double>(white),
                 .gray = {},
                 .opaque = {}};
  const std::size_t count = columns * rows;
  const bool is_text = content[1] == '2';
  const std::size_t bytes = white > 255 ? 2 : 1;
  const std::string_view pixels = numbers.AfterBlank();
  // In the text format P2, each pixel takes at least one digit and one blank in the file.
  const std::size_t needed = is_text ? 2 * count - 1 : bytes * count;
  if (pixels.size() < needed) {
    RefuseImage(file, fmt::format("ends early: {} x {} pixels take {}{} bytes, found {}", columns,
                                  rows, is_text ? "at least " : "", needed, pixels.size()));
  }
  image.gray.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto byte = [&](std::size_t at) {
      return static_cast<std::uint64_t>(static_cast<unsigned char>(pixels[at]));
    };
    const std::uint64_t gray = is_text      ? numbers.Next("pixels")
                               : bytes == 2 ? 256 * byte(2 * i) + byte(2 * i + 1)
                                            : byte(i);
    if (gray > white) {
      RefuseImage(file, fmt::format("pixel {} of row {} has the value {}; must be at most {}",
                                    i % columns + 1, i / columns + 1, gray, white));
    }
    image.gray.push_back(static_cast<float>(gray));
  }
  return image;
}

/// Image that libpng decodes; the destructor frees the memory of libpng.
struct PngImage {
  PngImage() { image.version = PNG_IMAGE_VERSION; }
  PngImage(const PngImage&) = delete;
  PngImage& operator=(const PngImage&) = delete;
  ~PngImage() { png_image_free(&image); }
  png_image image{};
};

MapImage ReadPng(const std::string& content, const std::string& file) {
  PngImage png;
  if (png_image_begin_read_from_memory(&png.image, content.data(), content.size()) == 0) {
    RefuseImage(file, fmt::format("no PNG image: {}", png.image.message));
  }
  CheckSize(file, png.image.width, png.image.height);
  png.image.format = PNG_FORMAT_RGBA;
  png.image.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
  constexpr std::size_t kChannels = 4;
  std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(png.image));
  if (png_image_finish_read(&png.image, nullptr, pixels.data(), 0, nullptr) == 0) {
    RefuseImage(file, fmt::format("no PNG image: {}", png.image.message));
  }
  MapImage image{.columns = static_cast<int>(png.image.width),
                 .rows = static_cast<int>(png.image.height),
                 // Largest gray value; the gray value of a pixel is the sum of red, green and blue.
                 .white = 3.0 * 255.0,
                 .gray = {},
                 .opaque = {}};
  for (std::size_t i = 0; i < pixels.size(); i += kChannels) {
    image.gray.push_back(static_cast<float>(pixels[i] + pixels[i + 1] + pixels[i + 2]));
    image.opaque.push_back(pixels[i + 3] == 255 ? 1 : 0);
  }
  return image;
}

}  // namespace

MapImage ReadMapImage(const std::string& content, const std::string& file) {
  constexpr std::string_view kPng = "\x89PNG\r\n\x1a\n";
  if (content.starts_with(kPng)) {
    return ReadPng(content, file);
  }
  if (content.starts_with("P2") || content.starts_with("P5")) {
    return ReadPgm(content, file);
  }
  RefuseImage(file, "neither a PGM (P2, P5) nor a PNG image");
}

}  // namespace trackbed
