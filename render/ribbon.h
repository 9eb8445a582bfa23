#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "render/image.h"
#include "render/recording.h"

namespace trackbed::render {

/// A line painted on the ground, drawn as flat pieces that cast no shadow.
struct RibbonStyle {
  Color color;
  double width = 0.2;  ///< [m]
  /// Above the ground [m]; one per ribbon, a millimeter or more apart, or they flicker.
  double height = 0.01;
};

/// A polyline thinned to few pieces: indices of the points kept, the first and the last among them.
///
/// Guarantees: no left-out point is farther than the tolerance from the piece that replaces it, nor
/// a fifth of that above or below it: paint must not sink into the ground. The tolerance is
/// `tolerance` [m], doubled until at most `most` pieces are left. Cost O(n) for roads; a piece
/// never spans more than 512 points.
std::vector<std::size_t> Thin(const std::vector<Point>& points, double tolerance, std::size_t most);

/// Appends one straight piece to the scene, a little longer than from `a` to `b` so that the
/// corners between pieces are closed. `normal` is that of the ground between them. Nothing when the
/// points coincide or the scene is full.
void AddRibbonPiece(mjvScene& scene, const Point& a, const Point& b, const RibbonStyle& style,
                    const Eigen::Vector3d& normal = Eigen::Vector3d::UnitZ());

}  // namespace trackbed::render
