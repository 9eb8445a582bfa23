#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tests/audit/shapes.h"
#include "trackbed/core/table.h"

/// What a run leaves behind, as plain numbers: the tables of its folder and what its scenario and
/// its car's file say. The checker looks at nothing else.
namespace audit {

/// The car, from its own file.
struct Car {
  double length = 0.0;            ///< [m]
  double width = 0.0;             ///< [m]
  double rear_overhang = 0.0;     ///< rear axle to the rear end [m]
  double wheelbase = 0.0;         ///< [m]
  double steering_limit = 0.0;    ///< [rad]
  double steering_rate = 0.0;     ///< [rad/s]
  double friction = 0.0;          ///< largest coefficient of its tyres, either tyre law
  double brake_deceleration = 0;  ///< what all brakes together can hold [m/s^2]

  [[nodiscard]] Rectangle footprint() const {
    return {-rear_overhang, length - rear_overhang, width};
  }
};

/// What was asked.
struct Mission {
  TimedPose start;                          ///< rear axle at t = 0
  double start_speed = 0.0;                 ///< [m/s]
  double start_steering = 0;                ///< [rad]
  std::optional<Point> goal{};              ///< the last waypoint; none: the plan has its own end
  std::optional<double> goal_heading{};     ///< [rad]
  double acceleration = 0.0;                ///< no plan speeds up faster [m/s^2]
  double time_limit = 0.0;                  ///< [s]
  double timestep = 0.0;                    ///< [s]
  double control_period = 0.0;              ///< [s]
  std::optional<double> max_cross_track{};  ///< expected [m]
  std::optional<double> min_clearance{};    ///< likewise [m]
  std::optional<double> max_time{};         ///< likewise [s]
  /// A payload beside the middle leans the car, by 0.05 rad at most, and what leans on a slope of
  /// 0.1 looks another way from above than it is told to.
  bool leans_on_slope = false;
  double road_friction = 1.0;  ///< largest factor on the tyres' coefficient
  std::vector<Box> obstacles{};
  std::vector<std::size_t> planned_around{};  ///< of them, those that the plan has to keep clear of
};

/// One plant's drive.
struct Drive {
  std::string plant;
  bool has_wheels = false;           ///< moved by forces: they are a little soft
  trackbed::Table log{{"t_s"}};      ///< <plant>.csv
  trackbed::Table steps{{"t_s"}};    ///< <plant>.state.csv with a row at every physics step
  trackbed::Table changes{{"t_s"}};  ///< <plant>.plan.csv; without rows if there were none
  nlohmann::json metrics{};          ///< its entry in metrics.json
};

struct Record {
  std::string name;
  bool plan_ok = false;
  std::string blocked{};          ///< why the plan ends before the goal; else empty
  trackbed::Table plan{{"s_m"}};  ///< plan.csv
  bool passed = false;            ///< the verdict
  std::vector<Drive> drives{};
  Car car{};
  Mission mission{};
};

}  // namespace audit
