#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tests/audit/shapes.h"
#include "trackbed/core/table.h"

/// Recorded results of a run as plain numbers: the tables of its folder and data of its scenario
/// and its car's file. The checker uses only these results.
namespace audit {

/// Parameters of the car, from its file.
struct Car {
  double length = 0.0;            ///< [m]
  double width = 0.0;             ///< [m]
  double rear_overhang = 0.0;     ///< rear axle to the rear end [m]
  double wheelbase = 0.0;         ///< [m]
  double steering_limit = 0.0;    ///< [rad]
  double steering_rate = 0.0;     ///< [rad/s]
  double friction = 0.0;          ///< largest tyre friction coefficient of both tyre laws
  double brake_deceleration = 0;  ///< upper limit of all brakes together [m/s^2]

  [[nodiscard]] Rectangle footprint() const {
    return {-rear_overhang, length - rear_overhang, width};
  }
};

/// An area with a different friction.
struct Patch {
  Box area;
  double factor = 1.0;  ///< on the tyre friction
};

/// The task that the scenario sets.
struct Mission {
  TimedPose start;            ///< rear axle at t = 0
  double start_speed = 0.0;   ///< [m/s]
  double start_steering = 0;  ///< [rad]
  std::vector<Point> waypoints{};
  std::vector<double> headings{};           ///< at the waypoints; empty: any [rad]
  double speed = 0.0;                       ///< [m/s]
  std::optional<Point> goal{};              ///< the last waypoint; none: the plan's end
  std::optional<double> goal_heading{};     ///< [rad]
  double acceleration = 0.0;                ///< upper limit of plans [m/s^2]
  double time_limit = 0.0;                  ///< [s]
  double timestep = 0.0;                    ///< [s]
  double control_period = 0.0;              ///< [s]
  std::optional<double> max_cross_track{};  ///< expectation [m]
  std::optional<double> min_clearance{};    ///< expectation [m]
  std::optional<double> max_time{};         ///< expectation [s]
  /// A payload beside the center line rolls the car, by at most 0.05 rad. On a slope of 0.1, the
  /// heading of a rolled car, projected on the ground, differs from the plan's heading.
  bool leans_on_slope = false;
  double road_friction = 1.0;    ///< factor on the tyre friction outside the patches
  std::vector<Patch> patches{};  ///< later ones override earlier ones
  Point grade{};  ///< dz/dx and dz/dy of a ground that is a plane; 0 for any other ground
  std::vector<Box> obstacles{};
  std::vector<std::size_t> planned_around{};  ///< indices of those that the plan must avoid
};

/// One plant's run.
struct Drive {
  std::string plant;
  bool has_wheels = false;                  ///< moved by forces: compliant steering
  trackbed::Table log{{"t_s"}};             ///< <plant>.csv
  trackbed::Table steps{{"t_s"}};           ///< <plant>.state.csv with a row per physics step
  trackbed::Table changes{{"t_s"}};         ///< <plant>.plan.csv; no rows without a replan
  std::optional<double> overspeed_bound{};  ///< bound of the check on the overspeed [m/s]; none:
                                            ///< not checked
  std::vector<bool> kept{};  ///< for each plan in `changes`: whether a note says that it exceeds a
                             ///< limit
  nlohmann::json metrics{};  ///< entry of the plant in metrics.json
};

struct Record {
  std::string name;
  bool plan_ok = false;
  std::string status{};   ///< of the plan, as in plan.json
  std::string reason{};   ///< why there is no plan, or empty
  std::string blocked{};  ///< why the plan ends before the goal, or empty
  std::string partial{};  ///< why the search ended before the goal, or empty
  std::vector<std::string> notes{};
  std::vector<double> stops{};    ///< stations at which the wheels turn at rest [m]
  double planning_time = 0.0;     ///< [s]
  trackbed::Table plan{{"s_m"}};  ///< plan.csv
  bool passed = false;            ///< the verdict
  std::vector<Drive> drives{};
  Car car{};
  Mission mission{};
};

}  // namespace audit
