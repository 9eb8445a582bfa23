#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace trackbed {

/// Gray image of a map file.
struct MapImage {
  int columns = 0;
  int rows = 0;
  double white = 255.0;              ///< the value of white
  std::vector<float> gray;           ///< from 0 to `white`, row by row from the top
  std::vector<std::uint8_t> opaque;  ///< in the same order, 0 where transparent; empty: all opaque
};

/// Reads the content of a PGM (P2, P5) or PNG file. Throws InputError naming `file`.
MapImage ReadMapImage(const std::string& content, const std::string& file);

}  // namespace trackbed
