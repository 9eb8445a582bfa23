#pragma once

#include <optional>
#include <vector>

#include "src/planning/curves/leg_speeds.h"

/// Finds legs of continuous curvature that are driven in little time.
///
/// A leg consists of pieces, on which the steering angle and the speed are linear over the time.
/// The steering angles and speeds between the pieces and the times of the pieces are the variables
/// of a smooth program. In the fastest leg, the car slows down where its wheels turn.
namespace trackbed {

/// A leg to be driven in the least time, with the limits on its motion.
struct FastestLeg {
  std::vector<Segment> start;     ///< Initial leg of the search, in one direction of motion.
  std::vector<double> lengths{};  ///< Lengths of the leg's parts, each within one segment [m].
  std::vector<double> speeds{};   ///< Speeds between the parts, with those at both ends [m/s].
  double curvature = 1.0;         ///< Largest curvature [1/m].
  double min_speed = 0.1;         ///< Lowest speed between the parts [m/s], > 0.
  double held_speed = 0.1;        ///< Lowest speed at which the car steers near a stop [m/s].
  LegLimits limits;
};

/// Returns a leg at a local minimum of the driving time near `leg.start`; nullopt if the search
/// finds none. At both ends, the returned leg has the same pose and curvature as `leg.start`, to
/// 1e-10 m and rad. Near an end at which the car is at rest, the curvature stays constant below
/// `leg.held_speed`. The search takes 1 to 140 ms for 7 to 16 parts.
std::optional<std::vector<Segment>> FindFasterLeg(const FastestLeg& leg);

}  // namespace trackbed
