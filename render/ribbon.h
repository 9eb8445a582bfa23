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
  double width = 0.2;  ///< [m]
  /// Above the ground [m]; ribbons must differ by at least a millimeter, or they flicker.
  double height = 0.01;
};

/// Thins a polyline to few pieces. Returns the indices of the points kept, including both ends.
///
/// Guarantee: every omitted point is within the tolerance of the piece that replaces it, and within
/// a fifth of it vertically, so that paint does not sink into the ground. The tolerance is
/// `tolerance` [m], doubled until at most `max_pieces` pieces are left. Cost O(n) for roads; a
/// piece never spans more than 512 points.
std::vector<std::size_t> Thin(const std::vector<Point>& points, double tolerance,
                              std::size_t max_pieces);

/// Appends one straight piece to the scene, slightly longer than from `a` to `b` to close the
/// corners between pieces. `normal` is the ground's normal between them. Does nothing if the points
/// coincide or the scene is full.
void AddRibbonPiece(mjvScene& scene, const Point& a, const Point& b, const RibbonStyle& style,
                    const Eigen::Vector3d& normal = Eigen::Vector3d::UnitZ());

}  // namespace trackbed::render
