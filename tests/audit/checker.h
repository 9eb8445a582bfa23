#pragma once

#include <string>
#include <vector>

#include "tests/audit/record.h"

/// Checks whether the reported results of a run are true, by computing the results again from the
/// recorded tables.
namespace audit {

/// A discrepancy between a reported and a computed result.
struct Finding {
  std::string kind;  ///< "contact", "plan_braking", …
  std::string text;  ///< a message with the numbers
};

/// Tolerances of the checks. The comment on each default derives it.
struct Tolerances {
  /// A car has arrived if its distance from the goal is at most this fraction of its length.
  double goal_position = 0.1;
  /// A car has arrived only if its heading differs by at most this from the mission's goal heading
  /// [rad].
  double goal_heading = 0.2;
  double at_rest = 0.02;  ///< [m/s]; twice the program's threshold of standstill
  /// A plan begins at the car's state, up to rounding, because the state is computed, not measured.
  double plan_position = 1e-6;  ///< [m]
  double plan_heading = 1e-6;   ///< [rad]
  double plan_speed = 1e-6;     ///< [m/s]
  double plan_steering = 1e-3;  ///< [rad]; 0.02 m of lateral deviation after at most 10 m
  /// Overlap of footprints above which a contact counts [m]. Poses are interpolated linearly
  /// between steps, with an error of v^2 kappa dt^2/8 (0.14 mm at 15 m/s, 0.2 /m and 5 ms), and
  /// SweptGap has a resolution of 1 mm.
  double contact = 1e-3;
  /// Fractions by which a plan may exceed a limit. The columns of a plan are sampled every 0.1 m,
  /// so the checks use means over this interval instead of values.
  double plan_limit = 0.02;
  double plan_rate = 0.05;  ///< for the steering rate, a difference of curvatures
  /// Fraction by which the actuator may exceed its rate limit. The fraction allows for rounding.
  double actuator_rate = 1e-6;
  /// Fraction by which measured wheel angles may exceed the rate limit, because tie rods yield a
  /// little under load. In 34 passed runs on MuJoCo, with three cars and both tyre laws, the
  /// largest excess was 0.43 %.
  double wheel_rate = 0.03;
  /// Largest excess of measured wheel angles over the steering limit [rad]. Toe angles and
  /// compliant tie rods cause this excess, which was at most 0.007 rad.
  double wheel_angle = 0.02;
};

/// All findings, in the order of the checks; empty if the run is consistent.
std::vector<Finding> Check(const Record& record, const Tolerances& tolerances = {});

/// Checks one plan. `rows`: as in plan.csv. `taken_up_in`: the run that adopted this plan as a
/// replan; null for the mission's initial plan. `kept`: whether a note says that the plan was kept
/// although it exceeds a limit. If so, the limits of the car and the road are not checked.
std::vector<Finding> CheckPlan(const trackbed::Table& rows, const Record& record,
                               const Drive* taken_up_in, bool kept, const Tolerances& tolerances);

/// Checks one run.
std::vector<Finding> CheckDrive(const Drive& drive, const Record& record,
                                const Tolerances& tolerances);

}  // namespace audit
