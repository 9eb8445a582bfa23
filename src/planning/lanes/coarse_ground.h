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
/// initial values of the unknown heights come from a recursively filled grid of half the
/// resolution; relaxation steps then replace each unknown height by the mean of its neighbors. If
/// no height is known, all heights are 0. The computing time is proportional to the number of
/// heights, about 2 us per height.
std::vector<double> FillHeights(const HeightGrid& known);

}  // namespace trackbed
