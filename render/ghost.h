#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "render/recording.h"
#include "render/ribbon.h"

/// What FilmScene draws of cars beside the first one's shapes.
namespace trackbed::render {

/// The line that a car leaves: narrower than those it covers, like the lines of a transport map.
RibbonStyle TrailStyle(std::size_t car, double scale);

/// Around a rectangle, on the ground.
std::vector<Point> Outline(const Recording& recording, const std::array<Vec2, 4>& corners);

}  // namespace trackbed::render
