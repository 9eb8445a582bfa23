#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "render/image.h"
#include "render/recording.h"

namespace trackbed::render {

/// Style of a line painted on the ground, drawn as flat pieces without shadow.
struct RibbonStyle {
  Color color;
  double width = 0.2;  ///< Width of the line [m].
  /// Height above the ground [m]; ribbons whose heights differ by less than a millimeter flicker.
  double height = 0.01;
};

/// Thins a polyline to a few straight pieces. Thin() returns the indices of the points kept,
/// including both ends.
///
/// Every omitted point is within the tolerance of the piece that replaces it. Vertically, every
/// omitted point is within a fifth of the tolerance, so that paint does not sink into the ground.
/// The tolerance is `tolerance` [m], doubled until at most `max_pieces` pieces are left. Thinning
/// costs O(n) for roads; a piece never spans more than 512 points.
std::vector<std::size_t> Thin(const std::vector<Point>& points, double tolerance,
                              std::size_t max_pieces);

/// Appends one straight piece to the scene. The piece extends slightly beyond `a` and `b` to close
/// the corners between pieces. `normal` is the ground's normal between `a` and `b`. AddRibbonPiece
/// does nothing if the points coincide or the scene is full.
void AddRibbonPiece(mjvScene& scene, const Point& a, const Point& b, const RibbonStyle& style,
                    const Eigen::Vector3d& normal = Eigen::Vector3d::UnitZ());

}  // namespace trackbed::render
