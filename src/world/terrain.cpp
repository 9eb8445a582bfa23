#include "trackbed/world/terrain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Interpolation weights of four neighboring terrain cells, and the derivatives of these weights
/// with respect to the position u between the middle two cells.
struct Weights {
  std::array<double, 4> value;
  std::array<double, 4> slope;
};

/// Returns the interpolation weights of the uniform cubic B-spline.
Weights SplineWeights(double u) {
  const double v = 1.0 - u;
  return {{v * v * v / 6.0, (3.0 * u * u * u - 6.0 * u * u + 4.0) / 6.0,
           (3.0 * v * v * v - 6.0 * v * v + 4.0) / 6.0, u * u * u / 6.0},
          {-0.5 * v * v, (1.5 * u - 2.0) * u, -(1.5 * v - 2.0) * v, 0.5 * u * u}};
}

/// Returns the weights of cubic convolution, which interpolates the values with slopes from central
/// differences.
Weights ConvolutionWeights(double u) {
  const double uu = u * u;
  return {{0.5 * u * (-1.0 + 2.0 * u - uu), 1.0 + 0.5 * uu * (3.0 * u - 5.0),
           0.5 * u * (1.0 + 4.0 * u - 3.0 * uu), 0.5 * uu * (u - 1.0)},
          {-0.5 + 2.0 * u - 1.5 * uu, u * (4.5 * u - 5.0), 0.5 + 4.0 * u - 4.5 * uu,
           u * (1.5 * u - 1.0)}};
}

/// Returns the weighted sum of the heights of sixteen neighboring terrain cells. The arguments of
/// `at(i, j)` are the cell index i along x and the cell index j along y.
template <typename At>
Terrain::Point Sum(const Weights& x, const Weights& y, double cell, const At& at) {
  Terrain::Point sum;
  for (std::size_t j = 0; j < 4; ++j) {
    double value = 0.0;
    double slope = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      const double z = at(static_cast<int>(i), static_cast<int>(j));
      value += x.value[i] * z;
      slope += x.slope[i] * z;
    }
    sum.height += y.value[j] * value;
    sum.slope += Vec2(y.value[j] * slope, y.slope[j] * value) / cell;
  }
  return sum;
}

/// Returns the index of the cell at a coordinate, and the relative position of the coordinate
/// within this cell.
std::pair<int, double> CellAt(double place, double cell, int count) {
  const int index = std::clamp(static_cast<int>(place / cell), 0, count - 1);
  return {index, place / cell - index};
}

}  // namespace

Terrain::Terrain(const Size& size, std::vector<double> coarse)
    : size_(size), coarse_(std::move(coarse)) {
  TRACKBED_CHECK(size.columns > 0 && size.rows > 0 &&
                     coarse_.size() == static_cast<std::size_t>(size.CoarseColumns()) *
                                           static_cast<std::size_t>(size.CoarseRows()),
                 "{} heights for {} x {} blocks", coarse_.size(), size.columns, size.rows);
  index_.assign(static_cast<std::size_t>(size.columns) * static_cast<std::size_t>(size.rows), -1);
}

double Terrain::Control(int column, int row) const {
  constexpr int kBorder = 2;
  const int columns = size_.CoarseColumns();
  if (column <= kBorder || row <= kBorder || column >= columns - 1 - kBorder ||
      row >= size_.CoarseRows() - 1 - kBorder) {
    return size_.base;
  }
  return coarse_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                 static_cast<std::size_t>(column)];
}

Terrain::Point Terrain::CoarseAt(const Vec2& place) const {
  const auto [cell_column, u] = CellAt(place.x(), kCoarseCell, size_.columns * kCoarseCells);
  const auto [cell_row, v] = CellAt(place.y(), kCoarseCell, size_.rows * kCoarseCells);
  return Sum(SplineWeights(u), SplineWeights(v), kCoarseCell,
             [&, column = cell_column, row = cell_row](int i, int j) {
               return Control(column + i - 1, row + j - 1);
             });
}

void Terrain::Refine(int column, int row,
                     const std::function<double(const Vec2& point_W, double coarse)>& difference) {
  std::vector<double> nodes;
  nodes.reserve(std::size_t{kNodes} * kNodes);
  bool any = false;
  for (int j = -1; j < kNodes - 1; ++j) {
    for (int i = -1; i < kNodes - 1; ++i) {
      const Vec2 place(kBlock * column + kCell * i, kBlock * row + kCell * j);
      nodes.push_back(difference(size_.low + place, CoarseAt(place).height));
      any = any || nodes.back() != 0.0;
    }
  }
  if (any) {
    index_[static_cast<std::size_t>(row) * static_cast<std::size_t>(size_.columns) +
           static_cast<std::size_t>(column)] = static_cast<int>(fine_.size());
    fine_.push_back(std::move(nodes));
  }
}

bool Terrain::IsRefined(int column, int row) const {
  return index_[static_cast<std::size_t>(row) * static_cast<std::size_t>(size_.columns) +
                static_cast<std::size_t>(column)] >= 0;
}

Terrain::Point Terrain::At(const Vec2& point_W) const {
  const Vec2 place = point_W - size_.low;
  // This condition is written such that a NaN coordinate counts as outside of the terrain.
  if (!(place.x() >= 0.0 && place.y() >= 0.0 && place.x() <= kBlock * size_.columns &&
        place.y() <= kBlock * size_.rows)) {
    return {size_.base, Vec2::Zero()};
  }
  Point point = CoarseAt(place);
  const auto [block_column, in_column] = CellAt(place.x(), kBlock, size_.columns);
  const auto [block_row, in_row] = CellAt(place.y(), kBlock, size_.rows);
  const int index =
      index_[static_cast<std::size_t>(block_row) * static_cast<std::size_t>(size_.columns) +
             static_cast<std::size_t>(block_column)];
  if (index >= 0) {
    const std::vector<double>& nodes = fine_[static_cast<std::size_t>(index)];
    const auto [column, u] = CellAt(in_column * kBlock, kCell, kCells);
    const auto [row, v] = CellAt(in_row * kBlock, kCell, kCells);
    const std::size_t first =
        static_cast<std::size_t>(row) * kNodes + static_cast<std::size_t>(column);
    const Point own = Sum(ConvolutionWeights(u), ConvolutionWeights(v), kCell, [&](int i, int j) {
      return nodes[first + static_cast<std::size_t>(j) * kNodes + static_cast<std::size_t>(i)];
    });
    point.height += own.height;
    point.slope += own.slope;
  }
  return point;
}

}  // namespace trackbed
