#pragma once

#include <vector>

#include "trackbed/geometry/pose.h"
#include "trackbed/road_network/road_network.h"

namespace trackbed {

/// A line of paint on a road, seen from above. Dashes are lines of their own.
struct PaintedLine {
  std::vector<Vec2> points;  ///< [m], at least two
  double width = 0.0;        ///< [m], > 0
  bool yellow = false;       ///< else white
};

/// A stretch of paved road, seen from above: its borders at the same stations.
struct PavedBand {
  std::vector<Vec2> left;  ///< [m], at least two
  std::vector<Vec2> right;
};

/// What a road network looks like.
struct RoadPaint {
  std::vector<PavedBand> bands;
  std::vector<PaintedLine> lines;
};

/// The lanes' surface and road marks of a network, for pictures: points at most `spacing` [m]
/// apart, or so far that there are some 10^5 of them. Neighboring lanes of each section that are
/// paved (all but sidewalks, borders, curbs and "none") are one band. Solid lines and dashes of 3 m
/// every 9 m; double lines are two, 0.1 m apart; marks of other types ("grass", "curb", "edge",
/// "custom", "botts dots") are solid lines, "none" is none. Heights and superelevation are left
/// out. InternalError unless the spacing is positive.
RoadPaint PaintRoads(const RoadNetwork& network, double spacing);

}  // namespace trackbed
