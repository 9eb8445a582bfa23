// Checks one plan, from the rows of plan.csv, against the car and the mission.
//
// The plan must start at the car's state and end at the goal. Positions and yaws of the rows must
// belong to one curve, which the car can drive without exceeding full lock. Steering angles,
// steering rates, accelerations (friction circle) and braking must stay within the car's limits.
// The footprint along the plan must not overlap obstacles that the planner knows. All quantities
// are computed from differences between rows 0.1 m apart.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tests/audit/checker.h"

namespace audit {
namespace check_plan {

constexpr double kGravity = 9.81;  // [m/s^2]
constexpr double kTurn = 6.283185307179586;

struct PlanRow {
  double s, x, y, yaw, curvature, speed, direction;
};

std::vector<PlanRow> PlanRows(const trackbed::Table& table) {
  const auto column = [&](const char* name) { return table.Column(name); };
  const auto s = column("s_m"), x = column("x_m"), y = column("y_m"), yaw = column("yaw_rad"),
             curvature = column("curvature_radpm"), speed = column("speed_mps"),
             direction = column("direction");
  std::vector<PlanRow> rows;
  for (std::size_t i = 0; i < s.size(); ++i) {
    rows.push_back({s[i], x[i], y[i], yaw[i], curvature[i], speed[i], direction[i]});
  }
  return rows;
}

double AngleBetween(double a, double b) {
  return std::abs(std::remainder(a - b, kTurn));
}

/// The largest value of a quantity and its station.
struct Largest {
  double value = 0.0;
  double s = 0.0;

  void Take(double other, double at) {
    if (other > value) {
      value = other;
      s = at;
    }
  }
};

/// The largest ratio of a required quantity to the available quantity, for example of braking to
/// grip.
class Worst {
 public:
  void Take(double asked, double hold, double s) {
    if (asked > ratio_ * hold) {
      ratio_ = asked / hold;
      asked_ = asked;
      hold_ = hold;
      s_ = s;
    }
  }

  [[nodiscard]] double ratio() const { return ratio_; }

  void Report(const char* kind, const char* what, double more, std::vector<Finding>& found) const {
    if (ratio_ > more) {
      found.push_back({kind, fmt::format("asks {:.4g} m/s^2 {} at s = {:.5g} m; there are {:.4g}",
                                         asked_, what, s_, hold_)});
    }
  }

 private:
  double ratio_ = 0.0;
  double asked_ = 0.0;
  double hold_ = 0.0;
  double s_ = 0.0;
};

class PlanCheck {
 public:
  PlanCheck(const trackbed::Table& table, const Record& record, const Drive* taken_up_in, bool kept,
            const Tolerances& tolerances)
      : rows_(PlanRows(table)),
        record_(record),
        at_start_(taken_up_in == nullptr),
        kept_(kept),
        tolerances_(tolerances),
        // A replan starts with the current wheel angle, which may exceed the limit a little.
        steering_limit_(
            record.car.steering_limit +
            (taken_up_in != nullptr && taken_up_in->has_wheels ? tolerances.wheel_angle : 1e-6)) {}

  std::vector<Finding> Run() {
    if (rows_.empty()) {
      Report("plan_geometry", "a plan without points");
      return findings_;
    }
    CheckGeometry();
    CheckSteering();
    if (!kept_) {
      CheckAccelerations();
    }
    if (at_start_) {
      CheckStart();
      CheckEnd();
      CheckObstacles();
    }
    return findings_;
  }

 private:
  void Report(const char* kind, std::string text) { findings_.push_back({kind, std::move(text)}); }

  /// The columns must belong to one curve: a chord's direction agrees with the yaws at its ends,
  /// and between two points the yaw turns no more than at full lock. The curvatures at the two
  /// points give no bound, as a shorter arc may lie between them.
  void CheckGeometry() {
    const double sharpest = std::tan(steering_limit_) / record_.car.wheelbase;
    Largest apart, aside, turned;
    for (std::size_t i = 0; i + 1 < rows_.size(); ++i) {
      const PlanRow& a = rows_[i];
      const PlanRow& b = rows_[i + 1];
      const double ds = b.s - a.s;
      const double chord = std::hypot(b.x - a.x, b.y - a.y);
      apart.Take(std::max(ds, chord), a.s);
      if (a.direction != b.direction || chord < 1e-9) {
        continue;
      }
      const double heading =
          std::atan2(b.y - a.y, b.x - a.x) + (a.direction < 0 ? 0.5 * kTurn : 0.0);
      aside.Take(AngleBetween(heading, a.yaw) - sharpest * ds, a.s);
      turned.Take(AngleBetween(b.yaw, a.yaw) - sharpest * ds, a.s);
    }
    if (apart.value > 0.1 + 1e-9) {
      Report("plan_geometry",
             fmt::format("points {:.6g} m apart at s = {:.5g} m", apart.value, apart.s));
    }
    constexpr double kRounding = 1e-4;  // [rad]; from rounding of positions over a short chord
    if (aside.value > kRounding || turned.value > kRounding) {
      Report("plan_geometry", fmt::format("turns more than at full lock: its chord by {:.4g} rad "
                                          "at s = {:.5g} m, its yaw by {:.4g} rad at s = {:.5g} m",
                                          aside.value, aside.s, turned.value, turned.s));
    }
  }

  [[nodiscard]] double Steering(const PlanRow& row) const {
    return std::atan(record_.car.wheelbase * row.curvature);
  }

  void CheckSteering() {
    Largest angle, rate;
    for (const PlanRow& row : rows_) {
      angle.Take(std::abs(Steering(row)), row.s);
    }
    if (angle.value > steering_limit_) {
      Report("plan_steering_angle", fmt::format("asks {:.4f} rad of {:.4f} rad at s = {:.5g} m",
                                                angle.value, record_.car.steering_limit, angle.s));
    }
    // A continuous change of curvature has the same sign over several points. A step between two
    // segments shows only between two points, or between three if one lies in its middle.
    const auto rate_in = [&](std::size_t i) {
      const PlanRow& a = rows_[i];
      const PlanRow& b = rows_[i + 1];
      const double ds = b.s - a.s;
      if (a.direction != b.direction || ds <= 0.0) {
        return 0.0;
      }
      return std::min(std::abs(a.speed), std::abs(b.speed)) * (Steering(b) - Steering(a)) / ds;
    };
    for (std::size_t i = 1; i + 2 < rows_.size(); ++i) {
      const double r[] = {rate_in(i - 1), rate_in(i), rate_in(i + 1)};
      if (r[0] * r[1] > 0.0 && r[1] * r[2] > 0.0) {
        rate.Take(std::min({std::abs(r[0]), std::abs(r[1]), std::abs(r[2])}), rows_[i].s);
      }
    }
    if (rate.value > record_.car.steering_rate * (1.0 + tolerances_.plan_rate)) {
      Report("plan_steering_rate", fmt::format("asks {:.4g} rad/s of {:.4g} rad/s at s = {:.5g} m",
                                               rate.value, record_.car.steering_rate, rate.s));
    }
  }

  /// Checks the longitudinal acceleration v dv/ds, as a mean over each interval, the lateral
  /// acceleration v^2 kappa at the points, and both combined by the friction circle. The component
  /// of gravity is added if it pulls against the car.
  void CheckAccelerations() {
    const double more = 1.0 + tolerances_.plan_limit;
    Worst driving, braking, lateral, combined, held;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const PlanRow& a = rows_[i];
      const Ground ground = GroundAt(i);
      const double pull = a.curvature > 0.0 ? ground.left : -ground.left;
      const double across_a = a.speed * a.speed * std::abs(a.curvature);
      lateral.Take(across_a + std::max(0.0, pull), ground.grip, a.s);
      held.Take(std::hypot(ground.up, ground.left), ground.grip, a.s);
      if (i + 1 == rows_.size() || rows_[i + 1].s <= a.s) {
        continue;
      }
      const PlanRow& b = rows_[i + 1];
      const double along = 0.5 * (b.speed * b.speed - a.speed * a.speed) / (b.s - a.s);
      driving.Take(along, record_.mission.acceleration, a.s);
      const double brakes = std::min(ground.grip, record_.car.brake_deceleration);
      if (along < 0.0) {
        braking.Take(-along + std::max(0.0, -ground.up), brakes, a.s);
      } else {
        held.Take(along + std::max(0.0, ground.up), ground.grip, a.s);
      }
      // On either side of a curvature step, only the smaller value is certain.
      const double across = std::min(across_a, b.speed * b.speed * std::abs(b.curvature));
      combined.Take(std::hypot(along, across), ground.grip, a.s);
    }
    lateral.Report("plan_lateral", "across", more, findings_);
    braking.Report("plan_braking", "to brake", more, findings_);
    driving.Report("plan_acceleration", "to speed up", more, findings_);
    held.Report("plan_hold", "on its slope", more, findings_);
    if (lateral.ratio() <= more && braking.ratio() <= more) {
      combined.Report("plan_combined", "along and across together", more, findings_);
    }
  }

  /// Grip of the road and pull of gravity at a row [m/s^2].
  struct Ground {
    double grip = 0.0;
    double up = 0.0;    ///< pull of gravity against the direction of travel
    double left = 0.0;  ///< pull of gravity toward the right of the car
  };

  /// At the edge of a patch, the grip of the better neighboring row counts: the plan's own samples
  /// may lie on either side.
  [[nodiscard]] Ground GroundAt(std::size_t i) const {
    const Mission& mission = record_.mission;
    double factor = FactorAt(rows_[i]);
    if (i > 0) {
      factor = std::max(factor, FactorAt(rows_[i - 1]));
    }
    if (i + 1 < rows_.size()) {
      factor = std::max(factor, FactorAt(rows_[i + 1]));
    }
    const PlanRow& row = rows_[i];
    const double x = std::cos(row.yaw);
    const double y = std::sin(row.yaw);
    const double along = row.direction * (mission.grade.x * x + mission.grade.y * y);
    const double across = mission.grade.y * x - mission.grade.x * y;
    const double cosine = 1.0 / std::sqrt(1.0 + along * along + across * across);
    return {record_.car.friction * factor * kGravity * cosine,
            kGravity * along / std::hypot(1.0, along), kGravity * across / std::hypot(1.0, across)};
  }

  /// Returns the friction factor under the more slippery axle.
  [[nodiscard]] double FactorAt(const PlanRow& row) const {
    const double wheelbase = record_.car.wheelbase;
    return std::min(FactorAt(row.x, row.y), FactorAt(row.x + wheelbase * std::cos(row.yaw),
                                                     row.y + wheelbase * std::sin(row.yaw)));
  }

  [[nodiscard]] double FactorAt(double x, double y) const {
    double factor = record_.mission.road_friction;
    for (const Patch& patch : record_.mission.patches) {
      const TimedPose& center = patch.area.center;
      const double dx = x - center.x;
      const double dy = y - center.y;
      const double ahead = dx * std::cos(center.yaw) + dy * std::sin(center.yaw);
      const double aside = dy * std::cos(center.yaw) - dx * std::sin(center.yaw);
      if (std::abs(ahead) <= 0.5 * patch.area.length && std::abs(aside) <= 0.5 * patch.area.width) {
        factor = patch.factor;
      }
    }
    return factor;
  }

  void CheckStart() {
    const Mission& mission = record_.mission;
    const PlanRow& first = rows_.front();
    const double away = std::hypot(first.x - mission.start.x, first.y - mission.start.y);
    if (away > tolerances_.plan_position) {
      Report("plan_start_position", fmt::format("begins {:.4g} m from where the car starts", away));
    }
    const double turned = AngleBetween(first.yaw, mission.start.yaw);
    if (turned > tolerances_.plan_heading) {
      Report("plan_start_heading",
             fmt::format("begins {:.4g} rad from where the car heads", turned));
    }
    const double speed = std::abs(first.speed) - std::abs(mission.start_speed);
    if (std::abs(speed) > tolerances_.plan_speed) {
      Report("plan_start_speed", fmt::format("begins at {:.6g} m/s, the car at {:.6g} m/s",
                                             first.speed, mission.start_speed));
    }
    if (mission.start_speed != 0.0 && first.direction * mission.start_speed < 0.0) {
      Report("plan_start_speed", fmt::format("begins in direction {}, the car rolls at {:.4g} m/s",
                                             first.direction, mission.start_speed));
    }
    if (mission.start_speed != 0.0 &&
        std::abs(Steering(first) - mission.start_steering) > tolerances_.plan_steering) {
      Report("plan_start_steering",
             fmt::format("begins with {:.4f} rad of steering at {:.4g} m/s, the wheels at {:.4f} "
                         "rad",
                         Steering(first), mission.start_speed, mission.start_steering));
    }
  }

  void CheckEnd() {
    const Mission& mission = record_.mission;
    if (!mission.goal || !record_.blocked.empty()) {
      return;
    }
    const PlanRow& last = rows_.back();
    const double away = std::hypot(last.x - mission.goal->x, last.y - mission.goal->y);
    if (away > tolerances_.goal_position * record_.car.length) {
      Report("plan_end", fmt::format("is ok and ends {:.4g} m from the goal", away));
    }
    if (mission.goal_heading &&
        AngleBetween(last.yaw, *mission.goal_heading) > tolerances_.goal_heading) {
      Report("plan_end", fmt::format("is ok and ends {:.4g} rad from the goal's heading",
                                     AngleBetween(last.yaw, *mission.goal_heading)));
    }
  }

  /// Checks the footprint along the plan against the stationary obstacles that the planner knew.
  void CheckObstacles() {
    std::vector<TimedPose> poses;
    double yaw = rows_.front().yaw;
    for (const PlanRow& row : rows_) {
      yaw += std::remainder(row.yaw - yaw, kTurn);
      poses.push_back({0.0, row.x, row.y, yaw});
    }
    for (const std::size_t i : record_.mission.planned_around) {
      const Nearest nearest =
          SweptGap(record_.car.footprint(), poses, record_.mission.obstacles[i], 1e-3);
      if (nearest.gap < -tolerances_.contact) {
        Report("plan_contact",
               fmt::format("leads {:.4g} m deep through the known obstacle {}", -nearest.gap, i));
      }
    }
  }

  std::vector<PlanRow> rows_;
  const Record& record_;
  bool at_start_;
  bool kept_;
  const Tolerances& tolerances_;
  double steering_limit_;  ///< [rad]
  std::vector<Finding> findings_;
};

}  // namespace check_plan

std::vector<Finding> CheckPlan(const trackbed::Table& rows, const Record& record,
                               const Drive* taken_up_in, bool kept, const Tolerances& tolerances) {
  return check_plan::PlanCheck(rows, record, taken_up_in, kept, tolerances).Run();
}

}  // namespace audit
