#pragma once

#include <array>
#include <vector>

#include "render/overlay.h"
#include "render/ribbon.h"

/// Functions for lines that are painted on the ground of a recorded world.
namespace trackbed::render {

/// Returns the indices of the points to keep when a line on the ground is thinned. The thinned line
/// deviates from the original by at most a twentieth of the narrowest ribbon's width.
std::vector<std::size_t> KeptPoints(const std::vector<Point>& line);

/// Returns the points of a line that remain after thinning by KeptPoints.
std::vector<Point> Thinned(const std::vector<Point>& line);

/// Returns the number of points of all lines, which bounds the number of shapes that AddLine adds
/// for these lines.
std::size_t PointCount(const std::vector<std::vector<Point>>& lines);

/// Returns the outline of a rectangle on the ground, as a closed line.
std::vector<Point> Outline(const Recording& recording, const std::array<Vec2, 4>& corners);

/// Adds one straight piece of a line to the scene. AddPiece omits a piece that is so far from the
/// camera's target that the line would be thinner than a pixel.
void AddPiece(SceneContext& context, const World& world, const Point& a, const Point& b,
              const RibbonStyle& style);

/// Adds a straight piece between each two consecutive points to the scene.
void AddLine(SceneContext& context, const World& world, const std::vector<Point>& points,
             const RibbonStyle& style);

}  // namespace trackbed::render
