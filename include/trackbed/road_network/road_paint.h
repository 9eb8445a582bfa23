#pragma once

#include <vector>

#include "trackbed/geometry/pose.h"
#include "trackbed/road_network/road_network.h"

namespace trackbed {

/// A painted line on a road, seen from above. Each dash of a broken line is a separate PaintedLine.
struct PaintedLine {
  std::vector<Vec2> points;  ///< Points along the painted line [m], at least two.
  double width = 0.0;        ///< Width of the painted line [m], > 0.
  bool yellow = false;       ///< Whether the painted line is yellow; else the line is white.
};

/// A part of a paved road, seen from above: points of the left and right border at the same
/// stations.
struct PavedBand {
  std::vector<Vec2> left;  ///< Points along the left border [m], at least two.
  std::vector<Vec2> right;
};

/// The visible parts of a road network.
struct RoadPaint {
  std::vector<PavedBand> bands;
  std::vector<PaintedLine> lines;
};

/// Returns the paved surfaces and the road marks of a road network, for drawing. Points of borders
/// and lines are at most `spacing` [m] apart; in large networks, the spacing is increased so that
/// there are at most about 10^5 points. Neighboring paved lanes of each section (all types except
/// sidewalks, borders, curbs and "none") form one band. Broken lines are dashes of 3 m every 9 m.
/// Double lines consist of two lines that are 0.1 m apart. Road marks of other types ("grass",
/// "curb", "edge", "custom", "botts dots") are solid lines. Road marks of the type "none" are not
/// drawn. Superelevation shifts painted lines in the same way as the centers of lanes
/// (SurfaceLineAt). Throws InternalError unless the spacing is positive.
RoadPaint PaintRoads(const RoadNetwork& network, double spacing);

}  // namespace trackbed
