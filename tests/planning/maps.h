#pragma once

#include <numeric>
#include <string>
#include <vector>

#include "trackbed/planning/sampling/rrt_star.h"

namespace trackbed {

/// A named planning problem.
struct Map {
  std::string name;
  RrtStarProblem problem;
};

/// Returns the axis-aligned box between the corners (left, low) and (right, high).
inline OrientedBox Block(double left, double low, double right, double high) {
  return {{std::midpoint(left, right), std::midpoint(low, high), 0.0}, right - left, high - low};
}

/// Returns five maps for a car that is 1.725 m wide. A path must keep half of this width from all
/// obstacles. Walls are 0.5 m thick. Walls at the border of the sampled area extend beyond it.
inline std::vector<Map> Maps() {
  constexpr double kInflation = 0.5 * 1.725;
  const auto problem = [](const Vec2& start, const Vec2& goal, std::vector<OrientedBox> obstacles) {
    return RrtStarProblem{start, goal, {0.0, 0.0}, {40.0, 30.0}, std::move(obstacles), kInflation};
  };
  return {
      {"open_field", problem({3.0, 3.0}, {37.0, 27.0},
                             {{{12.0, 10.0, 0.3}, 6.0, 3.0},
                              {{22.0, 15.0, -0.8}, 5.0, 5.0},
                              {{30.0, 22.0, 1.1}, 7.0, 2.0},
                              {{31.0, 8.0, 0.0}, 4.0, 4.0}})},
      {"clutter", problem({2.0, 15.0}, {38.0, 15.0},
                          {{{7.0, 5.0, 0.2}, 2.5, 2.0},
                           {{7.5, 14.5, 0.9}, 2.0, 2.5},
                           {{7.0, 24.0, -0.4}, 3.0, 1.5},
                           {{13.0, 9.5, 1.3}, 2.0, 2.0},
                           {{13.5, 19.0, 0.1}, 2.5, 2.5},
                           {{19.0, 4.5, -0.7}, 2.0, 3.0},
                           {{19.5, 14.0, 0.5}, 3.0, 2.0},
                           {{19.0, 24.5, 1.0}, 2.0, 2.0},
                           {{25.0, 10.0, -0.2}, 2.5, 2.0},
                           {{25.5, 19.5, 0.8}, 2.0, 2.5},
                           {{31.0, 5.0, 0.4}, 3.0, 2.0},
                           {{31.5, 15.0, -1.1}, 2.0, 3.0},
                           {{31.0, 25.0, 0.6}, 2.0, 2.0},
                           {{35.0, 10.0, 0.0}, 2.0, 2.0}})},
      // The gap of 2.5 m between the walls leaves 0.775 m for the car's center. The map is smaller
      // than the others, because the planner needs samples inside the gap, and the fraction of such
      // samples decreases with the area.
      {"passage",
       {{4.0, 4.0},
        {24.0, 14.0},
        {0.0, 0.0},
        {28.0, 18.0},
        {Block(13.75, -5.0, 14.25, 8.5), Block(13.75, 11.0, 14.25, 23.0)},
        kInflation}},
      // A U-shaped wall, open on the side away from the goal.
      {"trap", problem({20.0, 15.0}, {37.0, 15.0},
                       {Block(10.0, 8.0, 26.5, 8.5), Block(10.0, 21.5, 26.5, 22.0),
                        Block(26.0, 8.0, 26.5, 22.0)})},
      {"slalom", problem({3.0, 15.0}, {37.0, 15.0},
                         {Block(8.0, -5.0, 8.5, 20.0), Block(16.0, 10.0, 16.5, 35.0),
                          Block(24.0, -5.0, 24.5, 20.0), Block(32.0, 10.0, 32.5, 35.0)})},
  };
}

}  // namespace trackbed
