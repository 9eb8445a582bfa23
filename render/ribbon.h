#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "render/image.h"
#include "render/recording.h"

namespace trackbed::render {

/// Style of a line on the ground, which is drawn as flat pieces that cast no shadow.
struct RibbonStyle {
  Color color;
  double width = 0.2;  ///< Width of the line [m].
  /// Height of the ribbon above the ground [m]; ribbons whose heights differ by less than a
  /// millimeter flicker.
  double height = 0.01;
};

/// Thins a polyline to a few straight pieces. Returns the indices of the kept points of the
/// polyline, which include both ends.
///
/// The distance between an omitted point and the piece that replaces it is at most the tolerance.
/// The vertical distance between an omitted point and the piece that replaces it is at most a fifth
/// of the tolerance. The small vertical tolerance keeps paint from sinking into the ground. The
/// tolerance of the thinning starts at `tolerance` [m] and is doubled until at most `max_pieces`
/// pieces are left. The run time of Thin is proportional to the number of points, since a piece
/// never spans more than 512 points.
std::vector<std::size_t> Thin(const std::vector<Point>& points, double tolerance,
                              std::size_t max_pieces);

/// Appends one straight piece of a line to the scene. The piece extends slightly beyond `a` and
/// `b`, so that there are no gaps between pieces at corners. The argument `normal` is the ground's
/// normal between `a` and `b`. AddRibbonPiece does nothing if the points coincide or the scene is
/// full.
void AddRibbonPiece(mjvScene& scene, const Point& a, const Point& b, const RibbonStyle& style,
                    const Eigen::Vector3d& normal = Eigen::Vector3d::UnitZ());

}  // namespace trackbed::render
