#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace trackbed {

/// Image of a map, as gray values.
struct MapImage {
  int columns = 0;
  int rows = 0;
  double white = 255.0;  ///< Gray value of white.
  /// Gray values of the pixels from 0 (black) to `white`, row by row from the top.
  std::vector<float> gray;
  /// Opacity of the pixels in the order of `gray`; 0 for a transparent pixel; empty if all pixels
  /// are opaque.
  std::vector<std::uint8_t> opaque;
};

/// Reads a map image from the content of a PGM (P2, P5) or PNG file. If the image is invalid,
/// ReadMapImage throws InputError naming `file`.
MapImage ReadMapImage(const std::string& content, const std::string& file);

}  // namespace trackbed
