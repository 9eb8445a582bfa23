#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "trackbed/geometry/pose.h"

namespace trackbed {

/// Smooth ground over a rectangle of square blocks, with level ground around the rectangle. The
/// ground is a coarse surface plus, in some blocks, fine differences from that surface.
///
/// The coarse surface is a uniform cubic B-spline of its control heights; the differences are
/// interpolated by cubic convolution (Keys 1981), which is exact for quadratic polynomials. Height
/// and slope are continuous. Overhangs, steps and details smaller than a cell cannot be
/// represented.
///
/// Memory: 8 bytes for each control height, 36 kB for each block with differences.
class Terrain {
 public:
  static constexpr double kBlock = 32.0;      ///< Side of a block [m].
  static constexpr double kCoarseCell = 8.0;  ///< Distance between control heights [m].
  /// Distance between the points of the fine differences [m].
  static constexpr double kCell = 0.5;

  /// Number of coarse cells, and of fine cells, along the side of a block.
  static constexpr int kCoarseCells = static_cast<int>(kBlock / kCoarseCell);
  static constexpr int kCells = static_cast<int>(kBlock / kCell);

  struct Size {
    Vec2 low{0.0, 0.0};  ///< Corner with the smallest x and y [m].
    int columns = 1;     ///< Number of blocks along x, > 0.
    int rows = 1;        ///< Number of blocks along y, > 0.
    double base = 0.0;   ///< Height outside of the rectangle [m].

    /// Number of control heights along x and y. Each corner of a coarse cell has a control height.
    [[nodiscard]] int CoarseColumns() const { return columns * kCoarseCells + 1; }
    [[nodiscard]] int CoarseRows() const { return rows * kCoarseCells + 1; }
  };

  struct Point {
    double height = 0.0;      ///< Height z [m].
    Vec2 slope = {0.0, 0.0};  ///< Slopes dz/dx and dz/dy.
  };

  /// Makes a terrain from the control heights `coarse` [m], in rows along x. Heights within two
  /// cells of the rectangle's border are replaced by `base`. InternalError unless the number of
  /// heights matches `size`.
  Terrain(const Size& size, std::vector<double> coarse);

  /// Sets the differences from the coarse surface at the corners of a block's cells and one cell
  /// beyond the block. Call Refine for every block with a nonzero difference, otherwise the surface
  /// has steps.
  void Refine(int column, int row,
              const std::function<double(const Vec2& point_W, double coarse)>& difference);

  [[nodiscard]] const Size& size() const { return size_; }
  [[nodiscard]] bool IsRefined(int column, int row) const;

  /// Height and slope at any point. Outside of the rectangle, and for points that are not finite,
  /// the height is `base`. Cost: about 0.1 us.
  [[nodiscard]] Point At(const Vec2& point_W) const;

 private:
  static constexpr int kNodes = kCells + 3;  // Nodes along a side, plus one beyond each end.

  [[nodiscard]] Point CoarseAt(const Vec2& place) const;
  [[nodiscard]] double Control(int column, int row) const;

  Size size_;
  std::vector<double> coarse_;
  std::vector<int> index_;  // Index of each block in fine_; -1: not refined.
  std::vector<std::vector<double>> fine_;
};

}  // namespace trackbed
