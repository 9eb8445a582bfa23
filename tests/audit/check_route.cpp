// Checks plans of ordinary routes, and the reasons of refusals.
//
// A refusal counts as true if the quantity that its message names exceeds its limit when computed
// from the mission, the car and the road alone. If the message names a start speed as the remedy,
// the same route must have a plan for a car that starts at this speed.

#include "tests/audit/check_route.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

namespace audit {
namespace check_route {

constexpr double kGravity = 9.81;  // [m/s^2]
constexpr double kHalfTurn = 3.14159265358979323846;
/// The lowest speed that the planners choose for a turn, their default `min_speed` [m/s].
constexpr double kSlowest = 0.5;

/// Returns the number behind a text of a message; none if the text does not appear.
std::optional<double> NumberBehind(const std::string& message, const std::string& text) {
  const std::size_t at = message.find(text);
  if (at == std::string::npos) {
    return std::nullopt;
  }
  return std::strtod(message.c_str() + at + text.size(), nullptr);
}

bool Has(const std::string& message, const char* text) {
  return message.find(text) != std::string::npos;
}

double Length(const Point& from, const Point& to) {
  return std::hypot(to.x - from.x, to.y - from.y);
}

double Direction(const Point& from, const Point& to) {
  return std::atan2(to.y - from.y, to.x - from.x);
}

/// A turn of the route at a waypoint.
struct Turn {
  double angle = 0.0;     // [rad], in [0, pi]
  double half_leg = 0.0;  // half of the shorter leg [m]
};

Turn TurnAt(const std::vector<Point>& points, std::size_t i) {
  const double change = Direction(points[i], points[i + 1]) - Direction(points[i - 1], points[i]);
  return {std::abs(std::remainder(change, 2.0 * kHalfTurn)),
          0.5 * std::min(Length(points[i - 1], points[i]), Length(points[i], points[i + 1]))};
}

/// Returns the smallest length of a leg that a turn needs at a speed [m]: the tangent of an arc and
/// a part of the distance on which the wheels turn, for the best radius.
double SmallestRoom(const Car& car, double angle, double speed) {
  const double smallest = car.wheelbase / std::tan(car.steering_limit);
  double least = std::numeric_limits<double>::infinity();
  constexpr int kRadii = 4000;
  for (int i = 0; i <= kRadii; ++i) {
    const double radius = smallest * std::pow(1e4, static_cast<double>(i) / kRadii);
    least = std::min(least, radius * std::tan(0.5 * angle) +
                                speed / car.steering_rate * std::atan(car.wheelbase / radius));
  }
  return least;
}

class RefusalCheck {
 public:
  RefusalCheck(const Record& record, const RoutePlanner& planner,
               const std::function<bool(double)>& is_planned_at)
      : record_(record), planner_(planner), is_planned_at_(is_planned_at) {}

  std::vector<Finding> Run() {
    const std::string& status = record_.status;
    if (status == "infeasible") {
      CheckInfeasible();
    } else if (status == "budget_used_up") {
      CheckBudget();
    } else if (planner_.name == "fillet") {
      CheckFillet();
    } else if (!IsTooSteep()) {  // on slopes that the car cannot climb, every reason of a refusal
                                 // counts as true
      Report("untrue");
    }
    return findings_;
  }

 private:
  void Report(const char* kind, const std::string& why = "") {
    findings_.push_back({kind, fmt::format("{}: {} {}", record_.status, record_.reason, why)});
  }

  void CheckInfeasible() {
    const std::string& reason = record_.reason;
    const Mission& mission = record_.mission;
    if (const auto fits = NumberBehind(reason, "set mission.start.speed to at most ")) {
      if (!(*fits < mission.start_speed) || !is_planned_at_(*fits)) {
        Report("remedy", "the remedy does not help");
      }
    } else if (const auto pull = NumberBehind(reason, "pull of gravity ")) {
      constexpr double kThreeDigits = 1.005;
      if (*pull > kThreeDigits * SteepestPull() || !IsTooSteep()) {
        Report("untrue", fmt::format("gravity pulls with {:.4g} m/s^2 at most", SteepestPull()));
      }
    } else if (planner_.name == "fillet" && Has(reason, "initial ")) {
      CheckStart();
    } else {
      Report("untrue");
    }
  }

  /// The path of this planner begins at the first waypoint, along the first leg.
  void CheckStart() {
    const Mission& mission = record_.mission;
    const Point& first = mission.waypoints[0];
    const double away = std::hypot(mission.start.x - first.x, mission.start.y - first.y);
    const double turned = std::abs(std::remainder(
        mission.start.yaw - Direction(first, mission.waypoints[1]), 2.0 * kHalfTurn));
    constexpr double kTolerance = 1e-3;  // of the check of the program [m, rad]
    if (away <= kTolerance && turned <= kTolerance) {
      Report("untrue", "the car stands at the start of the first leg");
    }
  }

  /// Gravity pulls hardest straight down the slope [m/s^2].
  [[nodiscard]] double SteepestPull() const {
    const double grade = std::hypot(record_.mission.grade.x, record_.mission.grade.y);
    return kGravity * grade / std::hypot(1.0, grade);
  }

  /// Whether some car with one driven axle does not climb the slope on the most slippery road. At
  /// least 0.4 of the weight of a car is on its driven axle.
  [[nodiscard]] bool IsTooSteep() const { return 0.4 * LeastGrip() < SteepestPull(); }

  /// The friction of the most slippery road, as an acceleration [m/s^2].
  [[nodiscard]] double LeastGrip() const {
    double factor = record_.mission.road_friction;
    for (const Patch& patch : record_.mission.patches) {
      factor = std::min(factor, patch.factor);
    }
    return factor * record_.car.friction * kGravity;
  }

  /// A search with a grid of 0.5 m and 1e6 cells; the grid extends 10 m beyond the route.
  void CheckBudget() {
    const std::vector<Point>& points = record_.mission.waypoints;
    const auto [left, right] = std::minmax_element(
        points.begin(), points.end(), [](const Point& a, const Point& b) { return a.x < b.x; });
    const auto [low, high] = std::minmax_element(
        points.begin(), points.end(), [](const Point& a, const Point& b) { return a.y < b.y; });
    constexpr double kCell = 0.5;
    constexpr double kMargin = 20.0;
    constexpr double kBudget = 1e6;
    const double span = std::hypot(right->x - left->x, high->y - low->y) + kMargin;
    if (planner_.name != "astar" || span * span < kBudget * kCell * kCell) {
      Report("untrue", fmt::format("the route spans {:.4g} m", span));
    }
  }

  /// Returns the turn at a waypoint [rad] without the waypoints that are so close to it that a path
  /// may leave them out.
  double TurnWithoutNeighbors(std::size_t i) {
    const std::vector<Point>& points = record_.mission.waypoints;
    std::vector<Point> before;
    std::vector<Point> behind;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const bool is_end = k == 0 || k + 1 == points.size();
      if (k != i && (is_end || Length(points[k], points[i]) > 0.25 * record_.car.width)) {
        (k < i ? before : behind).push_back(points[k]);
      }
    }
    return TurnAt({before.back(), points[i], behind.front()}, 1).angle;
  }

  void CheckFillet() {
    const std::string& status = record_.status;
    const auto at = NumberBehind(record_.reason, "at waypoint ");
    const std::vector<Point>& points = record_.mission.waypoints;
    if (!at || *at < 1.0 || *at + 1.0 >= static_cast<double>(points.size())) {
      Report("untrue", "no turn is named");
      return;
    }
    const Turn turn = TurnAt(points, static_cast<std::size_t>(*at));
    const double radius = record_.car.wheelbase / std::tan(record_.car.steering_limit);
    constexpr double kRounding = 1e-6;
    bool is_true = false;
    if (status == "u_turn") {
      is_true = std::max(turn.angle, TurnWithoutNeighbors(static_cast<std::size_t>(*at))) >
                kHalfTurn - kRounding;
    } else if (status == "turn_too_tight") {
      is_true = radius * std::tan(0.5 * turn.angle) > turn.half_leg * (1.0 - kRounding);
    } else if (status == "no_room_for_steering") {
      // Half of the ramp lies on the arc.
      const double slowest = 0.5 * std::min(kSlowest, record_.mission.speed);
      is_true = SmallestRoom(record_.car, turn.angle, slowest) > turn.half_leg * (1.0 - kRounding);
    }
    if (!is_true) {
      Report("untrue", fmt::format("the turn of {:.4g} rad has {:.4g} m of each leg", turn.angle,
                                   turn.half_leg));
    }
  }

  const Record& record_;
  const RoutePlanner& planner_;
  const std::function<bool(double)>& is_planned_at_;
  std::vector<Finding> findings_;
};

/// The columns of a plan.
struct Rows {
  explicit Rows(const trackbed::Table& plan)
      : s(plan.Column("s_m")),
        x(plan.Column("x_m")),
        y(plan.Column("y_m")),
        curvature(plan.Column("curvature_radpm")),
        direction(plan.Column("direction")) {}

  [[nodiscard]] Point at(std::size_t i) const { return {x[i], y[i]}; }

  std::vector<double> s, x, y, curvature, direction;
};

double Miss(const Rows& rows, const Point& waypoint) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < rows.s.size(); ++i) {
    least = std::min(least, DistanceToSegment(waypoint, rows.at(i - 1), rows.at(i)));
  }
  return least;
}

/// Checks that every planned stop is at a place where the wheels turn noticeably, or where the
/// direction changes.
void CheckStops(const Record& record, const Rows& rows, std::vector<Finding>& findings) {
  constexpr double kAround = 0.5;    // [m]
  constexpr double kNothing = 0.02;  // [rad]
  for (const double stop : record.stops) {
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    bool is_cusp = false;
    for (std::size_t i = 0; i < rows.s.size(); ++i) {
      if (std::abs(rows.s[i] - stop) <= kAround) {
        const double steering = std::atan(record.car.wheelbase * rows.curvature[i]);
        least = std::min(least, steering);
        most = std::max(most, steering);
        is_cusp = is_cusp || (i > 0 && rows.direction[i] != rows.direction[i - 1]);
      }
    }
    if (!is_cusp && most - least < kNothing) {
      findings.push_back(
          {"needless_stop", fmt::format("stops at s = {:.5g} m, where the steering changes by only "
                                        "{:.3g} rad",
                                        stop, std::max(0.0, most - least))});
    }
  }
}

}  // namespace check_route

std::vector<Finding> CheckRoutePlan(const Record& record, const RoutePlanner& planner) {
  // Plans may begin a milliradian beside the car's heading.
  std::vector<Finding> findings =
      CheckPlan(record.plan, record, nullptr, false, {.plan_heading = 1e-3});
  const check_route::Rows rows(record.plan);
  // A chord of 0.1 m lies up to 0.1^2/(8 r) m beside an arc of radius r; r is 5 m or more.
  constexpr double kChord = 0.1 * 0.1 / (8.0 * 5.0);
  // The tolerance covers the integration of clothoids over a kilometer.
  constexpr double kExact = kChord + 1e-4;
  // A planner that meets its waypoints may leave one out within a quarter of the car's width, if a
  // note says so.
  const auto has_note = [&](const char* text) {
    return std::any_of(record.notes.begin(), record.notes.end(), [&](const std::string& note) {
      return note.find(text) != std::string::npos;
    });
  };
  const double near = has_note(" left out, because ") ? 0.25 * record.car.width + kExact : kExact;
  const bool is_noted = has_note(" is missed by ");
  const std::vector<Point>& points = record.mission.waypoints;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double miss = check_route::Miss(rows, points[i]);
    const double bound = planner.meets_waypoints ? near
                         : planner.bounds_misses ? record.car.length + kExact
                                                 : std::numeric_limits<double>::infinity();
    if (miss > bound || (miss > record.car.length + kExact && !is_noted)) {
      findings.push_back(
          {"waypoint", fmt::format("passes waypoint {} at a distance of {:.4g} m", i, miss)});
    }
  }
  check_route::CheckStops(record, rows, findings);
  return findings;
}

std::vector<Finding> CheckRefusal(const Record& record, const RoutePlanner& planner,
                                  const std::function<bool(double start_speed)>& is_planned_at) {
  return check_route::RefusalCheck(record, planner, is_planned_at).Run();
}

}  // namespace audit
