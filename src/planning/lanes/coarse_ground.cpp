#include "src/planning/lanes/coarse_ground.h"

#include <algorithm>
#include <cstddef>

namespace trackbed {
namespace {

std::size_t Index(const HeightGrid& grid, int column, int row) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns) +
         static_cast<std::size_t>(column);
}

/// Returns a height grid of half the resolution. Each height of the coarse grid is the mean of up
/// to four known heights of the original grid.
HeightGrid Halved(const HeightGrid& grid) {
  HeightGrid half{.columns = (grid.columns + 1) / 2, .rows = (grid.rows + 1) / 2, .heights = {}};
  for (int row = 0; row < half.rows; ++row) {
    for (int column = 0; column < half.columns; ++column) {
      double sum = 0.0;
      int count = 0;
      for (int j = 2 * row; j < std::min(2 * row + 2, grid.rows); ++j) {
        for (int i = 2 * column; i < std::min(2 * column + 2, grid.columns); ++i) {
          if (const auto& height = grid.heights[Index(grid, i, j)]) {
            sum += *height;
            ++count;
          }
        }
      }
      half.heights.push_back(count > 0 ? std::optional(sum / count) : std::nullopt);
    }
  }
  return half;
}

/// Performs one relaxation step, which replaces each unknown height by the mean of its four
/// neighbors.
void Relax(const HeightGrid& known, std::vector<double>& heights) {
  const std::vector<double> last = heights;
  for (int row = 0; row < known.rows; ++row) {
    for (int column = 0; column < known.columns; ++column) {
      const std::size_t at = Index(known, column, row);
      if (known.heights[at]) {
        continue;
      }
      const auto neighbor = [&](int i, int j) {
        return last[Index(known, std::clamp(i, 0, known.columns - 1),
                          std::clamp(j, 0, known.rows - 1))];
      };
      heights[at] = 0.25 * (neighbor(column - 1, row) + neighbor(column + 1, row) +
                            neighbor(column, row - 1) + neighbor(column, row + 1));
    }
  }
}

}  // namespace

std::vector<double> FillHeights(const HeightGrid& known) {
  std::vector<double> heights(known.heights.size(), 0.0);
  const bool complete = std::all_of(known.heights.begin(), known.heights.end(),
                                    [](const auto& height) { return height.has_value(); });
  std::vector<double> coarser;
  HeightGrid half;
  if (!complete && known.heights.size() > 1) {
    half = Halved(known);
    coarser = FillHeights(half);
  }
  for (int row = 0; row < known.rows; ++row) {
    for (int column = 0; column < known.columns; ++column) {
      const std::size_t at = Index(known, column, row);
      if (known.heights[at]) {
        heights[at] = *known.heights[at];
      } else if (!coarser.empty()) {
        heights[at] = coarser[Index(half, column / 2, row / 2)];
      }
    }
  }
  // Number of relaxation steps per grid. A few relaxation steps are enough, because large-scale
  // height variations have already been smoothed on the coarser grids.
  constexpr int kSteps = 12;
  for (int i = 0; i < kSteps && !complete; ++i) {
    Relax(known, heights);
  }
  return heights;
}

}  // namespace trackbed
