// Checks one plant's run against its recorded tables.
//
// 1. The times, rows and physics steps must belong to one drive.
// 2. The smallest gap between the footprint and each obstacle is computed anew over all physics
//    steps and compared with the reported clearance and collision.
// 3. The distance of each pose from the plan then in effect, as a polyline, is compared with the
//    reported cross-track error and the corridor.
// 4. Steering angles and rates must keep the car's limits; the end must agree with `arrived`.
// 5. A run that passed must meet its expectations, and a run that failed must violate one.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/audit/checker.h"

namespace audit {
namespace {

constexpr double kTurn = 6.283185307179586;
constexpr double kSameTime = 1e-8;  // [s]; logs hold nanoseconds

using trackbed::Table;

/// A plan with the time from which it is driven.
struct Driven {
  double from = 0.0;
  Polyline line;
  double sagitta = 0.0;  ///< largest height of the curve above its chords [m]
  TimedPose end;
};

/// A plan as a polyline, extended straight by `beyond` meters.
Driven DrivenFrom(const Table& table, double time, double beyond) {
  const auto x = table.Column("x_m"), y = table.Column("y_m"), yaw = table.Column("yaw_rad"),
             s = table.Column("s_m"), curvature = table.Column("curvature_radpm"),
             direction = table.Column("direction");
  std::vector<Point> points;
  double sagitta = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    points.push_back({x[i], y[i]});
    if (i > 0) {
      const double ds = s[i] - s[i - 1];
      const double bend = std::max(std::abs(curvature[i]), std::abs(curvature[i - 1]));
      sagitta = std::max(sagitta, bend * ds * ds / 8.0);
    }
  }
  const TimedPose end{0.0, x.back(), y.back(), yaw.back()};
  points.push_back({end.x + beyond * direction.back() * std::cos(end.yaw),
                    end.y + beyond * direction.back() * std::sin(end.yaw)});
  return {time, Polyline(std::move(points)), sagitta, end};
}

/// Splits a table of plan changes into its plans.
std::vector<Table> PlansTakenUp(const Table& changes) {
  std::vector<Table> plans;
  if (changes.rows() == 0) {
    return plans;
  }
  const std::vector<double> from = changes.Column("from_t_s");
  const std::vector<double> s = changes.Column("s_m");
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (i == 0 || from[i] != from[i - 1] || s[i] <= s[i - 1]) {
      plans.emplace_back(changes.columns());
    }
    std::vector<double> cells;
    for (std::size_t column = 0; column < changes.columns().size(); ++column) {
      cells.push_back(changes.at(i, column));
    }
    plans.back().AddRow(cells);
  }
  return plans;
}

/// The mission's plan and the replans, in order of time.
std::vector<Driven> DrivenPlans(const Table& plan, const Table& changes, double beyond) {
  std::vector<Driven> plans{DrivenFrom(plan, 0.0, beyond)};
  for (const Table& next : PlansTakenUp(changes)) {
    plans.push_back(DrivenFrom(next, next.Column("from_t_s").front(), beyond));
  }
  return plans;
}

/// The chassis at every physics step.
std::vector<TimedPose> TimedPoses(const Table& steps) {
  const auto t = steps.Column("t_s"), x = steps.Column("x_m"), y = steps.Column("y_m"),
             qw = steps.Column("qw"), qx = steps.Column("qx"), qy = steps.Column("qy"),
             qz = steps.Column("qz");
  std::vector<TimedPose> poses;
  double yaw = 0.0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double now = std::atan2(2.0 * (qw[i] * qz[i] + qx[i] * qy[i]),
                                  1.0 - 2.0 * (qy[i] * qy[i] + qz[i] * qz[i]));
    yaw = i == 0 ? now : yaw + std::remainder(now - yaw, kTurn);
    poses.push_back({t[i], x[i], y[i], yaw});
  }
  return poses;
}

/// The largest distance of a series of poses from the plan in effect at their times.
struct Furthest {
  double distance = 0.0;
  double t = 0.0;
  double sagitta = 0.0;
};

Furthest FurthestFrom(std::vector<Driven>& plans, const std::vector<TimedPose>& poses) {
  Furthest furthest;
  std::size_t plan = 0;
  double bound = std::numeric_limits<double>::infinity();  // upper bound of the current distance
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const TimedPose& pose = poses[i];
    if (i > 0) {
      bound += std::hypot(pose.x - poses[i - 1].x, pose.y - poses[i - 1].y);
    }
    while (plan + 1 < plans.size() && pose.t >= plans[plan + 1].from - kSameTime) {
      ++plan;
      bound = std::numeric_limits<double>::infinity();
    }
    furthest.sagitta = std::max(furthest.sagitta, plans[plan].sagitta);
    if (bound <= furthest.distance) {
      continue;
    }
    const Point at{pose.x, pose.y};
    bound = plans[plan].line.LocalDistanceTo(at);
    if (bound <= furthest.distance) {
      continue;
    }
    bound = plans[plan].line.DistanceTo(at);
    if (bound > furthest.distance) {
      furthest.distance = bound;
      furthest.t = pose.t;
    }
  }
  return furthest;
}

class DriveCheck {
 public:
  DriveCheck(const Drive& drive, const Record& record, const Tolerances& tolerances)
      : drive_(drive),
        record_(record),
        tolerances_(tolerances),
        status_(drive.metrics.at("status").get<std::string>()),
        poses_(TimedPoses(drive.steps)) {
    const auto t = drive.log.Column("t_s"), x = drive.log.Column("x_m"),
               y = drive.log.Column("y_m"), yaw = drive.log.Column("yaw_rad");
    for (std::size_t i = 0; i < t.size(); ++i) {
      rows_.push_back({t[i], x[i], y[i], yaw[i]});
    }
  }

  std::vector<Finding> Run() {
    if (rows_.empty() || poses_.empty()) {
      Report("log", "a drive without rows");
      return findings_;
    }
    CheckTime();
    if (status_ == "diverged") {
      if (record_.passed) {
        Report("verdict", "passed, but diverged");
      }
      return findings_;  // the remaining checks need a valid state
    }
    if (!CheckNumbers()) {
      return findings_;  // the remaining checks compare numbers, which NaN would pass
    }
    CheckRows();
    CheckObstacles();
    CheckTracking();
    CheckSteering();
    CheckOverspeed();
    if (status_ == "arrived") {
      CheckArrival();
    } else if (status_ == "stuck") {
      CheckStuck();
    } else if (record_.passed) {
      Report("verdict", fmt::format("passed, but ended as {}", status_));
    }
    CheckExpectations();
    CheckFailure();
    return findings_;
  }

 private:
  void Report(const char* kind, const std::string& text) {
    findings_.push_back({kind, drive_.plant + ": " + text});
  }

  /// By how much a yaw in the log may differ from that in the physics [rad].
  [[nodiscard]] double SameYaw() const {
    return record_.mission.leans_on_slope ? 0.05 * 0.2 : 1e-6;
  }

  /// Whether all numbers used by the checks are finite.
  bool CheckNumbers() {
    const auto finite = [](const TimedPose& pose) {
      return std::isfinite(pose.t) && std::isfinite(pose.x) && std::isfinite(pose.y) &&
             std::isfinite(pose.yaw);
    };
    bool good = std::all_of(rows_.begin(), rows_.end(), finite) &&
                std::all_of(poses_.begin(), poses_.end(), finite);
    for (const char* name : {"speed_mps", "steering_actuator_rad", "steering_rad"}) {
      const std::vector<double> column = drive_.log.Column(name);
      good = good && std::all_of(column.begin(), column.end(),
                                 [](double value) { return std::isfinite(value); });
    }
    if (!good) {
      Report("numbers", fmt::format("rows with NaN or infinity; it says {}", status_));
    }
    return good;
  }

  /// The log and the physics steps must belong to one drive.
  void CheckRows() {
    const double same_yaw = SameYaw();
    std::size_t step = 0;
    for (const TimedPose& row : rows_) {
      while (step + 1 < poses_.size() && poses_[step].t < row.t - kSameTime) {
        ++step;
      }
      const TimedPose& pose = poses_[step];
      const double away = std::hypot(pose.x - row.x, pose.y - row.y);
      const double turned = std::abs(std::remainder(pose.yaw - row.yaw, kTurn));
      if (std::abs(pose.t - row.t) < kSameTime && (away > 1e-6 || turned > same_yaw)) {
        Report("log", fmt::format("at {:.4g} s the log and the physics are {:.4g} m and {:.4g} rad "
                                  "apart",
                                  row.t, away, turned));
        return;
      }
    }
  }

  void CheckTime() {
    const double period = record_.mission.control_period;
    for (std::size_t i = 1; i < rows_.size(); ++i) {
      if (std::abs(rows_[i].t - rows_[i - 1].t - period) > kSameTime) {
        Report("time", fmt::format("rows {:.9g} s and {:.9g} s, one period is {:.9g} s",
                                   rows_[i - 1].t, rows_[i].t, period));
        break;
      }
    }
    const double last = rows_.back().t;
    const double told = drive_.metrics.at("time").get<double>();
    if (std::abs(told - last) > kSameTime) {
      Report("time", fmt::format("says {:.9g} s, its last row {:.9g} s", told, last));
    }
    const double limit = record_.mission.time_limit;
    if (last > limit + period + kSameTime) {
      Report("time", fmt::format("ended at {:.6g} s, after the limit of {:.6g} s", last, limit));
    }
    if (status_ == "time_limit" && last < limit - 0.5 * record_.mission.timestep - kSameTime) {
      Report("time", fmt::format("says time_limit at {:.6g} s of {:.6g} s", last, limit));
    }
  }

  void CheckObstacles() {
    if (record_.mission.obstacles.empty()) {
      return;
    }
    const bool told_collision = drive_.metrics.at("collision").get<bool>();
    const double told = drive_.metrics.at("clearance_min").get<double>();
    Nearest nearest{.gap = std::numeric_limits<double>::infinity()};
    std::size_t which = 0;
    for (std::size_t i = 0; i < record_.mission.obstacles.size(); ++i) {
      const Nearest one =
          SweptGap(record_.car.footprint(), poses_, record_.mission.obstacles[i], 1e-3);
      if (one.gap < nearest.gap) {
        nearest = one;
        which = i;
      }
    }
    touched_ = nearest.gap <= tolerances_.contact;
    gap_ = nearest.gap;
    if (nearest.gap < -tolerances_.contact && (!told_collision || record_.passed)) {
      Report("contact",
             fmt::format("overlaps obstacle {} by {:.4g} m at {:.5g} s; it says {}{}", which,
                         -nearest.gap, nearest.t, status_, record_.passed ? ", passed" : ""));
    }
    // The smallest distance may occur between two steps. The distances at the steps are larger than
    // the smallest distance by at most half of the relative motion in a step. The program's
    // footprint does not lean. The footprint of a leaning car here differs from it by up to `leans`
    // at a corner.
    const double leans = SameYaw() * record_.car.footprint().reach();
    const double missed = 0.5 * nearest.step + 1e-6 + leans;
    missed_ = missed;
    if (told > std::max(nearest.gap, 0.0) + missed) {
      Report("clearance", fmt::format("says {:.5g} m, was {:.5g} m from obstacle {} at {:.5g} s",
                                      told, std::max(nearest.gap, 0.0), which, nearest.t));
    }
  }

  void CheckTracking() {
    if (!drive_.metrics.contains("cross_track")) {
      return;
    }
    // A car that stops just behind the end of its plan has arrived if it is within the goal
    // tolerance.
    const double beyond = tolerances_.goal_position * record_.car.length;
    std::vector<Driven> plans = DrivenPlans(record_.plan, drive_.changes, beyond);
    const double told = drive_.metrics["cross_track"]["max"].get<double>();
    // An obstacle that pushes the car causes errors that are not the controller's, so errors count
    // only up to the reported contact. Whether there was a contact is checked above.
    std::vector<TimedPose> counted = rows_;
    if (drive_.metrics.value("collision", false) && drive_.metrics.contains("clearance_min_t")) {
      const double contact = drive_.metrics["clearance_min_t"].get<double>();
      std::erase_if(counted, [&](const TimedPose& row) { return row.t > contact; });
    }
    const Furthest logged = FurthestFrom(plans, counted);
    // The polyline deviates from the plan by at most the sagitta.
    const double tolerance = logged.sagitta + 1e-6;
    if (logged.distance > told + tolerance) {
      Report("cross_track", fmt::format("says {:.5g} m at most, was {:.5g} m from its path at "
                                        "{:.5g} s",
                                        told, logged.distance, logged.t));
    }
    const double corridor = record_.mission.max_cross_track.value_or(record_.car.width);
    const Furthest driven = FurthestFrom(plans, poses_);
    inside_ = driven.distance < corridor - tolerance;
    if (record_.passed) {
      if (driven.distance > corridor + tolerance) {
        Report("corridor",
               fmt::format("passed, {:.5g} m from its path at {:.5g} s, with a corridor "
                           "of {:.5g} m",
                           driven.distance, driven.t, corridor));
      }
    }
  }

  void CheckSteering() {
    // Ignore the steering after a collision, because a collision also turns the wheels.
    if (touched_ || drive_.metrics.value("collision", false)) {
      return;
    }
    const Car& car = record_.car;
    const bool soft = drive_.has_wheels;
    const double told = drive_.metrics.at("steering_rate_max").get<double>();
    CheckColumn("steering_actuator_rad", car.steering_limit + 1e-9, tolerances_.actuator_rate);
    // Compliant wheels exceed the limit in a slide; a run that passed has not been sliding.
    const double free = std::numeric_limits<double>::infinity();
    const double angle = soft ? tolerances_.wheel_angle : 1e-9;
    const double more = soft ? tolerances_.wheel_rate : tolerances_.actuator_rate;
    const bool judged = !soft || record_.passed;
    const double rate = CheckColumn("steering_rad", judged ? car.steering_limit + angle : free,
                                    judged ? more : free);
    slow_wheels_ = rate < record_.car.steering_rate * (1.0 + tolerances_.wheel_rate) - 1e-9;
    if (rate > told + 1e-9) {
      Report("steering_metric",
             fmt::format("says {:.5g} rad/s at most, was {:.5g} rad/s", told, rate));
    }
  }

  /// Checks angle and rate of a column. Returns the largest rate over any 0.1 s, or over one period
  /// if that is longer.
  double CheckColumn(const char* name, double limit, double more) {
    const std::vector<double> angle = drive_.log.Column(name);
    const double period = record_.mission.control_period;
    const auto window = static_cast<std::size_t>(std::max(1.0, std::round(0.1 / period)));
    double largest = 0.0, largest_t = 0.0, rate = 0.0, rate_t = 0.0;
    for (std::size_t i = 0; i < angle.size(); ++i) {
      if (std::abs(angle[i]) > largest) {
        largest = std::abs(angle[i]);
        largest_t = rows_[i].t;
      }
      if (i >= window) {
        const double now =
            std::abs(angle[i] - angle[i - window]) / (static_cast<double>(window) * period);
        if (now > rate) {
          rate = now;
          rate_t = rows_[i].t;
        }
      }
    }
    if (largest > limit) {
      Report("steering_angle", fmt::format("{} {:.5f} rad at {:.5g} s, the car has {:.5f} rad",
                                           name, largest, largest_t, record_.car.steering_limit));
    }
    if (rate > record_.car.steering_rate * (1.0 + more) + 1e-9) {
      Report("steering_rate", fmt::format("{} {:.5f} rad/s up to {:.5g} s, the car has {:.5f} "
                                          "rad/s{}",
                                          name, rate, rate_t, record_.car.steering_rate,
                                          record_.passed ? "; passed" : ""));
    }
    return rate;
  }

  /// Returns an upper bound of the planned speed [m/s], also between the rows of a plan. Over a gap
  /// d between two rows, a plan that accelerates by at most a increases v^2 by at most 2 a d.
  [[nodiscard]] double HighestPlanned(const Table& plan) const {
    const std::vector<double> s = plan.Column("s_m");
    const std::vector<double> v = plan.Column("speed_mps");
    double highest = v.empty() ? 0.0 : v.front() * v.front();  // [m^2/s^2]
    for (std::size_t i = 1; i < v.size(); ++i) {
      const double gap = std::max(0.0, s[i] - s[i - 1]);  // 0 between two plans
      highest = std::max(highest, std::max(v[i] * v[i], v[i - 1] * v[i - 1]) +
                                      2.0 * record_.mission.acceleration * gap);
    }
    return std::sqrt(highest);
  }

  /// Checks that a car that passed was never faster than the highest planned speed by more than the
  /// bound on the overspeed. The program compares with the planned speed at the car's station, so
  /// its overspeed is at least as large.
  void CheckOverspeed() {
    const std::vector<double> speed = drive_.log.Column("speed_mps");
    const double told = drive_.metrics.value("overspeed_max", 0.0);
    fast_ = drive_.overspeed_bound && told > *drive_.overspeed_bound;
    if (!drive_.overspeed_bound || drive_.metrics.value("collision", false)) {
      return;
    }
    const double planned =
        std::max(HighestPlanned(record_.plan),
                 drive_.changes.rows() > 0 ? HighestPlanned(drive_.changes) : 0.0);
    for (std::size_t i = 0; i + 1 < speed.size(); ++i) {  // the last row has no command
      const double over = std::abs(speed[i]) - planned;
      if (over > told + 1e-6) {
        Report("overspeed", fmt::format("says {:.4g} m/s, was {:.4g} m/s faster than any plan at "
                                        "{:.5g} s",
                                        told, over, rows_[i].t));
        return;
      }
    }
    if (record_.passed && fast_) {
      Report("overspeed", fmt::format("passed, {:.4g} m/s faster than planned; {:.4g} m/s are "
                                      "allowed",
                                      told, *drive_.overspeed_bound));
    }
  }

  /// Returns the goal of the mission, or the end of the first plan if the mission has no goal.
  /// Later plans may end millimeters beside this end.
  [[nodiscard]] Point Goal() const {
    const Driven first = DrivenFrom(record_.plan, 0.0, 0.0);
    return record_.mission.goal.value_or(Point{first.end.x, first.end.y});
  }

  /// Checks that a car that stands at the goal is not reported as stuck: it has arrived, for any
  /// command.
  void CheckStuck() {
    const TimedPose& last = rows_.back();
    const Point goal = Goal();
    const double away = std::hypot(last.x - goal.x, last.y - goal.y);
    // On a loop, the start is as near to the goal as the end, so the car must have driven.
    const bool has_driven = drive_.metrics.at("distance").get<double>() > record_.car.length;
    if (away <= tolerances_.goal_position * record_.car.length && has_driven) {
      Report("stuck_at_goal", fmt::format("stuck {:.4g} m from the goal", away));
    }
  }

  void CheckArrival() {
    const TimedPose& last = rows_.back();
    const Mission& mission = record_.mission;
    const Point goal = Goal();
    const double away = std::hypot(last.x - goal.x, last.y - goal.y);
    const double near = tolerances_.goal_position * record_.car.length;
    if (away > near) {
      Report("goal_position", fmt::format("arrived{}, {:.4g} m from the goal; {:.4g} m count as "
                                          "there",
                                          record_.passed ? ", passed" : "", away, near));
    }
    if (mission.goal_heading) {
      const double turned = std::abs(std::remainder(last.yaw - *mission.goal_heading, kTurn));
      if (turned > tolerances_.goal_heading) {
        Report("goal_heading", fmt::format("arrived{}, {:.4g} rad from the goal's heading",
                                           record_.passed ? ", passed" : "", turned));
      }
    }
    const double speed = std::abs(drive_.log.Column("speed_mps").back());
    if (speed > tolerances_.at_rest) {
      Report("goal_speed", fmt::format("arrived at {:.4g} m/s", speed));
    }
    const double told = drive_.metrics.value("goal_distance", 0.0);
    if (std::abs(told - away) > 1e-6 && mission.goal) {
      Report("goal_metric", fmt::format("says {:.5g} m from the goal, is {:.5g} m", told, away));
    }
  }

  /// The scenario's further expectations, for a run that passed.
  void CheckExpectations() {
    const Mission& mission = record_.mission;
    if (!record_.passed) {
      return;
    }
    if (mission.min_clearance && std::max(gap_, 0.0) + missed_ < *mission.min_clearance) {
      Report("expected_clearance", fmt::format("passed, {:.5g} m from an obstacle where {:.5g} m "
                                               "are expected",
                                               gap_, *mission.min_clearance));
    }
    if (mission.max_time && rows_.back().t > *mission.max_time + kSameTime) {
      Report("expected_time", fmt::format("passed after {:.6g} s where {:.6g} s are expected",
                                          rows_.back().t, *mission.max_time));
    }
  }

  /// Returns whether the steering command swings about its mean over 1 s for at least 4 s: at least
  /// once per second to each side, with a root mean square of at least 0.5 mrad.
  [[nodiscard]] bool Swings() const {
    const std::vector<double> angle = drive_.log.Column("steering_command_rad");
    const double period = record_.mission.control_period;
    const auto half = static_cast<std::size_t>(std::max(1.0, std::round(0.5 / period)));
    std::vector<double> sum{0.0};
    for (const double a : angle) {
      sum.push_back(sum.back() + a);
    }
    std::vector<double> swing;
    for (std::size_t i = half; i + half < angle.size(); ++i) {
      swing.push_back(angle[i] -
                      (sum[i + half + 1] - sum[i - half]) / static_cast<double>(2 * half + 1));
    }
    const std::size_t length = 8 * half;
    for (std::size_t from = 0; from + length <= swing.size(); from += half) {
      double square = 0.0;
      int changes = 0;
      for (std::size_t i = from; i < from + length; ++i) {
        square += swing[i] * swing[i] / static_cast<double>(length);
        changes += i > from && (swing[i] > 0.0) != (swing[i - 1] > 0.0) ? 1 : 0;
      }
      if (changes >= 8 && std::sqrt(square) >= 5e-4) {
        return true;
      }
    }
    return false;
  }

  /// A failed run must have a reason: at least one checked condition is violated, or nearly so.
  void CheckFailure() {
    const Mission& mission = record_.mission;
    if (record_.passed || record_.drives.size() > 1 || status_ != "arrived" || touched_) {
      return;
    }
    const bool clear = !mission.min_clearance || gap_ > *mission.min_clearance + missed_;
    const bool in_time = !mission.max_time || rows_.back().t < *mission.max_time - kSameTime;
    if (inside_ && slow_wheels_ && !fast_ && clear && in_time && !Swings()) {
      Report("verdict", "failed, but arrived and kept all that is checked");
    }
  }

  const Drive& drive_;
  const Record& record_;
  const Tolerances& tolerances_;
  std::string status_;
  std::vector<TimedPose> rows_;
  std::vector<TimedPose> poses_;
  bool touched_ = false;                                  ///< the car touched an obstacle, within
                                                          ///< tolerance
  bool inside_ = false;                                   ///< the car stayed inside the corridor
  bool fast_ = false;                                     ///< the overspeed exceeds its bound
  bool slow_wheels_ = false;                              ///< the wheels kept the steering rate
                                                          ///< limit
  double gap_ = std::numeric_limits<double>::infinity();  ///< to the nearest obstacle [m]
  double missed_ = 0.0;  ///< by how much the gap may be smaller between two steps [m]
  std::vector<Finding> findings_;
};

}  // namespace

std::vector<Finding> CheckDrive(const Drive& drive, const Record& record,
                                const Tolerances& tolerances) {
  return DriveCheck(drive, record, tolerances).Run();
}

std::vector<Finding> Check(const Record& record, const Tolerances& tolerances) {
  std::vector<Finding> findings;
  const auto add = [&](std::vector<Finding> more) {
    std::move(more.begin(), more.end(), std::back_inserter(findings));
  };
  if (!record.plan_ok) {
    if (record.passed) {
      findings.push_back({"verdict", "passed without a plan"});
    }
    return findings;
  }
  add(CheckPlan(record.plan, record, nullptr, false, tolerances));
  for (const Drive& drive : record.drives) {
    add(CheckDrive(drive, record, tolerances));
    const std::vector<Table> plans = PlansTakenUp(drive.changes);
    for (std::size_t i = 0; i < plans.size(); ++i) {
      const bool kept = i < drive.kept.size() && drive.kept[i];
      for (Finding& finding : CheckPlan(plans[i], record, &drive, kept, tolerances)) {
        findings.push_back({finding.kind, drive.plant + ", taken up on the way: " + finding.text});
      }
    }
  }
  return findings;
}

}  // namespace audit
