#pragma once

#include <optional>
#include <vector>

namespace trackbed {

/// Heights on a grid [m], in rows along x; none where they are not known.
struct HeightGrid {
  int columns = 0;
  int rows = 0;
  std::vector<std::optional<double>> heights;
};

/// Smooth heights everywhere that are those known where there are any: a coarser grid of means
/// gives what is between, which is then relaxed toward the mean of its neighbors. 0 without any
/// known. Cost: O(grid), about 2 us for each height.
std::vector<double> FillHeights(const HeightGrid& known);

}  // namespace trackbed
