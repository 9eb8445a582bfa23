#pragma once

#include <vector>

#include "trackbed/geometry/pose.h"
#include "trackbed/road_network/road_network.h"

namespace trackbed {

/// A line of paint on a road, seen from above. Each dash is a separate line.
struct PaintedLine {
  std::vector<Vec2> points;  ///< Points [m], at least two.
  double width = 0.0;        ///< Width [m], > 0.
  bool yellow = false;       ///< Whether the line is yellow; otherwise it is white.
};

/// A stretch of paved road, seen from above: the points of both borders at the same stations.
struct PavedBand {
  std::vector<Vec2> left;  ///< Points [m], at least two.
  std::vector<Vec2> right;
};

/// The visible parts of a road network.
struct RoadPaint {
  std::vector<PavedBand> bands;
  std::vector<PaintedLine> lines;
};

/// Returns the paved surface and the road marks of a network, for pictures. Points are at most
/// `spacing` [m] apart; in large networks, the spacing is increased so that there are at most about
/// 10^5 points. Neighboring paved lanes of each section (all types except sidewalks, borders, curbs
/// and "none") form one band. Broken lines are dashes of 3 m every 9 m; double lines are two lines,
/// 0.1 m apart; marks of other types ("grass", "curb", "edge", "custom", "botts dots") are solid
/// lines; "none" is not drawn. Heights and superelevation are ignored. InternalError unless the
/// spacing is positive.
RoadPaint PaintRoads(const RoadNetwork& network, double spacing);

}  // namespace trackbed
