#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "trackbed/core/angle.h"
#include "trackbed/planning/avoidance/avoidance.h"

namespace trackbed {

/// An obstacle in a turn, varied as in Skackauskas (dissertation), listing F.2.
struct ObstacleCase {
  PassingSideChoice passing_side;  ///< on which side to pass: kInner or kOuter
  double side;                     ///< direction of the turn: 1 to the left, -1 to the right
  double reduction;                ///< the turn is smaller than a right angle by this [rad]
  int sixth;                       ///< position of the obstacle on the arc in sixths, 1 to 5
};

inline std::vector<ObstacleCase> AllObstacleCases() {
  std::vector<ObstacleCase> cases;
  for (const PassingSideChoice passing_side :
       {PassingSideChoice::kInner, PassingSideChoice::kOuter}) {
    for (const double side : {1.0, -1.0}) {
      for (const double reduction : {0.0, kPi / 12.0}) {
        for (int sixth = 1; sixth <= 5; ++sixth) {
          cases.push_back({passing_side, side, reduction, sixth});
        }
      }
    }
  }
  return cases;
}

inline std::string CaseName(const testing::TestParamInfo<ObstacleCase>& info) {
  const ObstacleCase& c = info.param;
  return std::string(c.passing_side == PassingSideChoice::kInner ? "Inner" : "Outer") +
         (c.side > 0.0 ? "Left" : "Right") + (c.reduction > 0.0 ? "75" : "90") + "At" +
         std::to_string(c.sixth);
}

}  // namespace trackbed
