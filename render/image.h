#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace trackbed::render {

/// An image with 8-bit RGB pixels; rows from the top, no padding.
struct Image {
  int width = 0;   ///< [px]
  int height = 0;  ///< [px]
  std::vector<std::uint8_t> rgb;

  void Resize(int new_width, int new_height) {
    width = new_width;
    height = new_height;
    rgb.resize(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  }
  [[nodiscard]] std::uint8_t* Pixel(int x, int y) { return rgb.data() + Offset(x, y); }
  [[nodiscard]] const std::uint8_t* Pixel(int x, int y) const { return rgb.data() + Offset(x, y); }

 private:
  [[nodiscard]] std::size_t Offset(int x, int y) const {
    return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                static_cast<std::size_t>(x));
  }
};

/// Color as red, green and blue in [0, 1].
struct Color {
  float r = 0;
  float g = 0;
  float b = 0;
};

}  // namespace trackbed::render
