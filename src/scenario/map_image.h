#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace trackbed {

/// A gray image of a map file.
struct MapImage {
  int columns = 0;
  int rows = 0;
  double white = 255.0;              ///< the value of white
  std::vector<float> gray;           ///< 0 to `white`, row by row from the top
  std::vector<std::uint8_t> opaque;  ///< likewise, 0 where it is not; empty: everywhere
};

/// The image of a PGM (P2, P5) or PNG file with this content. InputError naming `file`.
MapImage ReadMapImage(const std::string& content, const std::string& file);

}  // namespace trackbed
