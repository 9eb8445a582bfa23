#pragma once

#include <optional>
#include <vector>

namespace trackbed {

/// Heights on a grid [m], in rows along x; a height is none if it is unknown.
struct HeightGrid {
  int columns = 0;
  int rows = 0;
  std::vector<std::optional<double>> heights;
};

/// Fills in unknown heights smoothly and keeps the known heights. A coarser grid of mean heights
/// gives the initial values of the unknown heights. The unknown heights then relax toward the mean
/// of the neighboring heights. If no height is known, all heights are 0. Cost: O(grid), about 2 us
/// per height.
std::vector<double> FillHeights(const HeightGrid& known);

}  // namespace trackbed
