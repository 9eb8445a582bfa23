#pragma once

#include <array>
#include <vector>

#include "render/overlay.h"
#include "render/ribbon.h"

/// Lines painted on the ground of a recorded world.
namespace trackbed::render {

/// The indices of the points to keep of a line on the ground, so few that their pieces can be drawn
/// and so many that none is a twentieth of the narrowest ribbon off.
std::vector<std::size_t> KeptPoints(const std::vector<Point>& line);

/// Those points.
std::vector<Point> Thinned(const std::vector<Point>& line);

/// Around a rectangle, on the ground.
std::vector<Point> Outline(const Recording& recording, const std::array<Vec2, 4>& corners);

/// Adds one straight piece; nothing where it is so far from where the camera looks that it would be
/// thinner than a pixel.
void AddPiece(SceneContext& context, const World& world, const Point& a, const Point& b,
              const RibbonStyle& style);

/// Adds the pieces between the points.
void AddLine(SceneContext& context, const World& world, const std::vector<Point>& points,
             const RibbonStyle& style);

}  // namespace trackbed::render
