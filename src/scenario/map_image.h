#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace trackbed {

/// Gray values of the image of a map.
struct MapImage {
  int columns = 0;
  int rows = 0;
  double white = 255.0;              ///< The value of white.
  std::vector<float> gray;           ///< Gray values from 0 to `white`, row by row from the top.
  std::vector<std::uint8_t> opaque;  ///< Opacity in the same order, 0 where transparent; empty: all
                                     ///< opaque.
};

/// Reads a map image from the content of a PGM (P2, P5) or PNG file. ReadMapImage throws InputError
/// naming `file`.
MapImage ReadMapImage(const std::string& content, const std::string& file);

}  // namespace trackbed
