#include "trackbed/analysis/plan_table.h"

#include <algorithm>
#include <vector>

namespace trackbed {
namespace {

/// Largest distance between two consecutive points in plan.csv [m].
constexpr double kPlanSpacing = 0.1;

/// Computes the times at which a car that follows a speed profile reaches given stations, in
/// ascending order.
class ProfileClock {
 public:
  explicit ProfileClock(const SpeedProfile& profile) : profile_(profile) {}

  /// Returns the time at which the car reaches the station `s`, from the start of the profile [s].
  double TimeAt(double s) {
    const std::vector<SpeedProfile::Knot>& knots = profile_.knots();
    for (; next_ < knots.size() && knots[next_].s <= s; ++next_) {
      Pass(knots[next_].s, knots[next_].speed);
    }
    Pass(s, profile_.SpeedAt(s));
    return time_;
  }

 private:
  /// Advances to the station `s`, which the car reaches at `speed` with constant acceleration. A
  /// piece of the path at whose both ends the car rests takes no time; such pieces result only from
  /// rounding errors.
  void Pass(double s, double speed) {
    if (s > s_ && speed + speed_ > 0.0) {
      time_ += 2.0 * (s - s_) / (speed + speed_);
    }
    s_ = s;
    speed_ = speed;
  }

  const SpeedProfile& profile_;
  std::size_t next_ = 0;
  double s_ = 0.0;
  double speed_ = profile_.SpeedAt(0.0);
  double time_ = 0.0;
};

/// Returns the legs of a plan's path, divided at the plan's stops and waits.
std::vector<Stations> PiecesBetweenStops(const Plan& plan) {
  std::vector<double> stops = plan.stops;
  for (const PlannedWait& wait : plan.waits) {
    stops.push_back(wait.s);
  }
  std::sort(stops.begin(), stops.end());
  constexpr double kShortest = 1e-9;  // [m]
  std::vector<Stations> pieces;
  for (Stations leg : SplitIntoLegs(plan.reference.path)) {
    for (const double stop : stops) {
      if (stop > leg.from + kShortest && stop < leg.to - kShortest) {
        pieces.push_back({leg.from, stop});
        leg.from = stop;
      }
    }
    pieces.push_back(leg);
  }
  return pieces;
}

}  // namespace

Table PlanTable(const Plan& plan) {
  Table table({"s_m", "x_m", "y_m", "yaw_rad", "curvature_radpm", "speed_mps", "direction", "t_s"});
  const Reference& reference = plan.reference;
  ProfileClock clock(reference.speed);
  double waited = 0.0;  // [s]
  auto wait = plan.waits.begin();
  // Sample each piece of the path separately, so that plan.csv contains every cusp and stop. Where
  // two pieces of the path meet, plan.csv gets only the point of the earlier piece.
  for (const Stations& piece : PiecesBetweenStops(plan)) {
    const Reference part = Excerpt(reference, piece);
    for (const PathPoint& point : part.path.Sample(kPlanSpacing)) {
      if (point.s == 0.0 && table.rows() > 0) {
        continue;
      }
      const double s = piece.from + point.s;
      const double direction = point.direction;
      const double speed = part.speed.SpeedAt(point.s);
      std::vector<double> row{s,
                              point.pose.x,
                              point.pose.y,
                              point.pose.yaw,
                              point.curvature,
                              speed == 0.0 ? 0.0 : direction * speed,
                              direction,
                              clock.TimeAt(s) + waited};
      table.AddRow(row);
      // Where the car waits, a second row at the same place gives the time at which the wait ends.
      constexpr double kSamePlace = 1e-9;  // [m]
      for (; wait != plan.waits.end() && wait->s <= s + kSamePlace; ++wait) {
        waited += wait->duration;
        row.back() += wait->duration;
        table.AddRow(row);
      }
    }
  }
  return table;
}

}  // namespace trackbed
