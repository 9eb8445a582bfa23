#pragma once

#include <optional>
#include <vector>

namespace trackbed {

/// Heights on a grid [m], stored in rows along x; unknown heights are nullopt.
struct HeightGrid {
  int columns = 0;
  int rows = 0;
  std::vector<std::optional<double>> heights;
};

/// Interpolates the unknown heights smoothly between the known heights, which stay unchanged. The
/// unknown heights start from a recursively filled grid of half the resolution. The unknown heights
/// then relax toward the mean of the neighboring heights. If no height is known, all heights are 0.
/// Cost: proportional to the number of heights, about 2 us per height.
std::vector<double> FillHeights(const HeightGrid& known);

}  // namespace trackbed
