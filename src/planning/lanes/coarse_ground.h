#pragma once

#include <optional>
#include <vector>

namespace trackbed {

/// Heights on a grid [m], in rows along x; none if unknown.
struct HeightGrid {
  int columns = 0;
  int rows = 0;
  std::vector<std::optional<double>> heights;
};

/// Fills in unknown heights smoothly and keeps the known ones. A coarser grid of means gives the
/// initial heights, which then relax toward the mean of their neighbors. All are 0 if none is
/// known. Cost: O(grid), about 2 us per height.
std::vector<double> FillHeights(const HeightGrid& known);

}  // namespace trackbed
