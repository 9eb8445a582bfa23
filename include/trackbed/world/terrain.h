#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "trackbed/geometry/pose.h"

namespace trackbed {

/// Smooth ground over a rectangle of square blocks, with level ground around the rectangle. The
/// height of the ground is that of a coarse surface; in some blocks, fine height differences are
/// added.
///
/// The coarse surface is a uniform cubic B-spline of the control heights. The fine differences are
/// interpolated by cubic convolution (Keys 1981), which is exact for quadratic polynomials. Height
/// and slope of the ground are continuous. A Terrain cannot represent overhangs, steps, and details
/// smaller than a cell.
///
/// A Terrain needs 8 bytes for each control height, and 36 kB for each block with fine differences.
class Terrain {
 public:
  static constexpr double kBlock = 32.0;      ///< Length of a block's side [m].
  static constexpr double kCoarseCell = 8.0;  ///< Distance between neighboring control heights [m].
  /// Distance between the points at which fine differences are given [m].
  static constexpr double kCell = 0.5;

  /// Number of coarse cells, and number of fine cells, along the side of a block.
  static constexpr int kCoarseCells = static_cast<int>(kBlock / kCoarseCell);
  static constexpr int kCells = static_cast<int>(kBlock / kCell);

  struct Size {
    Vec2 low{0.0, 0.0};  ///< Corner of the terrain's rectangle with the smallest x and y [m].
    int columns = 1;     ///< Number of blocks along x, > 0.
    int rows = 1;        ///< Number of blocks along y, > 0.
    double base = 0.0;   ///< Height of the ground outside of the terrain's rectangle [m].

    /// Return the number of control heights along x and along y. Each corner of a coarse cell has a
    /// control height.
    [[nodiscard]] int CoarseColumns() const { return columns * kCoarseCells + 1; }
    [[nodiscard]] int CoarseRows() const { return rows * kCoarseCells + 1; }
  };

  struct Point {
    double height = 0.0;      ///< Height z [m].
    Vec2 slope = {0.0, 0.0};  ///< Slopes dz/dx and dz/dy of the ground.
  };

  /// Makes a terrain from the control heights `coarse` [m], in rows along x. Control heights within
  /// two cells of the terrain's border are replaced by the height `base` of the surroundings.
  /// Throws InternalError unless the number of heights matches `size`.
  Terrain(const Size& size, std::vector<double> coarse);

  /// Sets the fine height differences of a block, at the corners of the block's cells and one cell
  /// beyond the block. Call Refine for every block in which a difference is nonzero; otherwise the
  /// ground has steps at the borders of blocks.
  void Refine(int column, int row,
              const std::function<double(const Vec2& point_W, double coarse)>& difference);

  [[nodiscard]] const Size& size() const { return size_; }
  [[nodiscard]] bool IsRefined(int column, int row) const;

  /// Returns the height and slope of the ground at any point. Outside of the terrain's rectangle,
  /// and for points that are not finite, At returns the height `base` of the surroundings. A call
  /// of At takes about 0.1 us.
  [[nodiscard]] Point At(const Vec2& point_W) const;

 private:
  // Number of points with fine differences along the side of a block, including one point beyond
  // each end.
  static constexpr int kNodes = kCells + 3;

  [[nodiscard]] Point CoarseAt(const Vec2& place) const;
  [[nodiscard]] double Control(int column, int row) const;

  Size size_;
  std::vector<double> coarse_;
  // Index in `fine_` of each block; -1 if the block has no fine differences.
  std::vector<int> index_;
  std::vector<std::vector<double>> fine_;
};

}  // namespace trackbed
