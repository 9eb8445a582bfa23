#pragma once

#include <string>
#include <vector>

#include "tests/audit/record.h"

/// Whether what a run says of itself is true, computed anew from what it left behind.
namespace audit {

/// Something that is not as the run says.
struct Finding {
  std::string kind;  ///< "contact", "plan_braking", …
  std::string text;  ///< for people, with the numbers
};

/// What counts as kept. Each default is derived where it stands.
struct Tolerances {
  /// A car has arrived that stands within this share of its length from the goal ...
  double goal_position = 0.1;
  /// ... and within this of the heading that the mission asks for there [rad].
  double goal_heading = 0.2;
  double at_rest = 0.02;  ///< [m/s]; twice what the program calls standing
  /// Plans are numbers, not measurements: they begin where the car is but for rounding.
  double plan_position = 1e-6;  ///< [m]
  double plan_heading = 1e-6;   ///< [rad]
  double plan_speed = 1e-6;     ///< [m/s]
  double plan_steering = 1e-3;  ///< [rad]; 0.02 m beside the path after 10 m at most
  /// An overlap of footprints that counts [m]. Between steps poses are interpolated linearly, which
  /// is off by v^2 kappa dt^2/8, 0.14 mm at 15 m/s, 0.2 /m and 5 ms, and SweptGap looks every
  /// millimeter.
  double contact = 1e-3;
  /// Shares by which a plan may exceed a limit: its columns are sampled every 0.1 m, so that means
  /// over such a piece stand for values.
  double plan_limit = 0.02;
  double plan_rate = 0.05;  ///< likewise, of curvature, which is a second difference of positions
  /// Share by which the actuator may turn faster than it can: rounding.
  double actuator_rate = 1e-6;
  /// Likewise measured wheels, which follow through tie rods that give way a little under load. In
  /// 34 drives that passed on MuJoCo, of three cars with either tyre law, the most was 0.43 %.
  double wheel_rate = 0.03;
  /// And how much further they may stand [rad]: toe and the same springs at full lock, where 0.007
  /// was the most.
  double wheel_angle = 0.02;
};

/// Every finding, in the order of the checks; none when the run is as it says.
std::vector<Finding> Check(const Record& record, const Tolerances& tolerances = {});

/// The plan alone: `rows` as plan.csv has them. `taken_up_in`: the run in which it was taken up
/// on the way; null for the mission's own plan.
std::vector<Finding> CheckPlan(const trackbed::Table& rows, const Record& record,
                               const Drive* taken_up_in, const Tolerances& tolerances);

/// One run alone.
std::vector<Finding> CheckDrive(const Drive& drive, const Record& record,
                                const Tolerances& tolerances);

}  // namespace audit
