#pragma once

#include <Eigen/Core>
#include <map>
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

/// Finds legs that are driven in less time, and keeps the solutions of their programs. A planner
/// that plans a route several times solves the program of each leg only once. The memory grows by
/// 1 kB for each program.
class FasterLegs {
 public:
  /// Returns a leg at a local minimum of the driving time near `leg.start`; nullopt if the search
  /// finds none. At both ends, the returned leg has the same pose and curvature as `leg.start`, to
  /// 1e-10 m and rad. Near an end at which the car is at rest, the curvature stays constant below
  /// `leg.held_speed`. The result does not depend on earlier calls. The search takes 1 to 140 ms
  /// for 7 to 16 parts, and 0.1 ms if the solution of the leg's program is known.
  std::optional<std::vector<Segment>> Find(const FastestLeg& leg);

  /// Returns the number of solved programs.
  [[nodiscard]] std::size_t size() const { return solutions_.size(); }

 private:
  /// Solutions by the values that define a program; empty if the program has no solution.
  std::map<std::vector<double>, Eigen::VectorXd> solutions_;
};

}  // namespace trackbed
