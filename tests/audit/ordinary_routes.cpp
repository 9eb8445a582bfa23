// Random ordinary routes for the audit, reproducible by index.
//
// Planner and shape of the route alternate by index. A shape is a list of waypoints, drawn from the
// origin along x, sometimes with a start beside the route. The waypoints are then rounded, turned,
// and moved to their place. Speed, start, ice and grade are drawn independently of the shape.

#include "tests/audit/ordinary_routes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "tests/audit/dice.h"
#include "trackbed/planning/registry/planners.h"

namespace audit {
namespace ordinary_routes {

using trackbed::MissionSpec;
using trackbed::Vec2;

constexpr double kHalfTurn = 3.14159265358979323846;

Vec2 Along(double heading) {
  return {std::cos(heading), std::sin(heading)};
}

class Drawing {
 public:
  Drawing(std::uint64_t seed, const RouteSettings& settings, std::size_t fewest, bool has_headings)
      : dice_(seed), settings_(settings), fewest_(fewest), has_headings_(has_headings) {}

  // Shapes.

  /// Points on a straight line, at any distances.
  void Line() {
    Legs(
        Count(), [&] { return Length(); }, [] { return 0.0; });
    HeadingsAlongLegs();
  }

  /// A line with a goal far beyond short legs.
  void UnevenLine() {
    Legs(
        Count(), [&] { return dice_.Chance(0.5) ? 0.1 * Length() : Length(); }, [] { return 0.0; });
  }

  /// There and back: turns of 90 to 180 degrees, sometimes of exactly 180.
  void Hairpin() {
    Legs(
        Count(3), [&] { return Length(); },
        [&] {
          const double turn = dice_.Chance(0.3) ? kHalfTurn : dice_.Between(0.5, 1.0) * kHalfTurn;
          return dice_.Chance(0.5) ? turn : -turn;
        });
  }

  /// Right angles, as along blocks of a town.
  void Blocks() {
    Legs(
        Count(3), [&] { return std::ceil(Length()); },
        [&] { return (dice_.Chance(0.5) ? 0.5 : -0.5) * kHalfTurn; });
  }

  /// Turns of any angle.
  void Scattered() {
    Legs(
        Count(), [&] { return Length(); }, [&] { return dice_.Between(-1.0, 1.0) * kHalfTurn; });
  }

  /// A gentle bend through many points.
  void Bend() {
    const double turn = dice_.Between(-0.3, 0.3);
    const double length = std::max(2.0, 0.3 * Length());
    Legs(
        4 + dice_.Below(6), [&] { return length; }, [&] { return turn; });
  }

  /// Points 1 mm to 2 m apart.
  void Close() {
    Legs(
        Count(), [&] { return dice_.Logarithmic(1e-3, 2.0); },
        [&] { return dice_.Between(-1.0, 1.0) * kHalfTurn; });
  }

  /// The goal is the start.
  void Loop() {
    Scattered();
    if (points_.size() > 2 && dice_.Chance(0.5)) {
      points_.back() = points_.front();
    } else {
      points_.push_back(points_.front());
    }
  }

  /// Adds routes whose legs have headings at multiples of 45 degrees, with short and with long
  /// legs.
  void Eighths() {
    Legs(
        Count(), [&] { return Length(); },
        [&] { return 0.25 * kHalfTurn * static_cast<double>(dice_.Below(8)); });
    if (has_headings_) {
      for (std::size_t i = 0; i < points_.size(); ++i) {
        headings_.push_back(0.25 * kHalfTurn * static_cast<double>(dice_.Below(8)));
      }
    }
  }

  /// The car starts behind, before or beside the first waypoint, and heads in another direction.
  void StartBeside() {
    Scattered();
    start_ = Vec2(dice_.Between(-10.0, 10.0), dice_.Chance(0.5) ? 0.0 : dice_.Between(-5.0, 5.0));
    if (dice_.Chance(0.7)) {
      start_yaw_ = 0.25 * kHalfTurn * static_cast<double>(dice_.Below(8));
    }
  }

  /// The first waypoint after the start lies behind or beside the car.
  void GoalBehind() {
    Legs(
        Count(), [&] { return Length(); }, [&] { return dice_.Between(-0.5, 0.5); });
    start_yaw_ = dice_.Chance(0.5) ? kHalfTurn : dice_.Between(0.5, 1.5) * kHalfTurn;
  }

  // The rest of the mission.

  /// Rounds, turns and moves the waypoints.
  void Place() {
    const double digit = std::pow(10.0, -static_cast<double>(dice_.Below(7)));
    bool rounds = dice_.Chance(0.6) && digit < 1.0;
    const double turn = dice_.Chance(0.3) ? 0.0 : dice_.Between(-1.0, 1.0) * kHalfTurn;
    Vec2 at = dice_.Chance(0.5) ? Vec2(0.0, 0.0)
                                : Vec2(dice_.Between(-100.0, 100.0), dice_.Between(-100.0, 100.0));
    if (settings_.far_away && dice_.Chance(0.3)) {
      at += Vec2(3.5e5, 5.8e6);
    }
    const auto turned = [&](const Vec2& point) {
      return Vec2(at + Vec2(std::cos(turn) * point.x() - std::sin(turn) * point.y(),
                            std::sin(turn) * point.x() + std::cos(turn) * point.y()));
    };
    const auto rounded = [&](const Vec2& point) {
      const Vec2 placed = turned(point);
      return Vec2(std::round(placed.x() / digit) * digit, std::round(placed.y() / digit) * digit);
    };
    // Rounding must not move two successive waypoints to the same place.
    for (std::size_t i = 1; i < points_.size(); ++i) {
      rounds = rounds && rounded(points_[i]) != rounded(points_[i - 1]);
    }
    const auto place = [&](const Vec2& point) { return rounds ? rounded(point) : turned(point); };
    MissionSpec& mission = scenario_.mission;
    for (const Vec2& point : points_) {
      mission.waypoints.push_back(place(point));
    }
    const double step = 0.01 * digit;
    for (const double heading : headings_) {
      mission.headings.push_back(rounds ? std::round((heading + turn) / step) * step
                                        : heading + turn);
    }
    if (start_) {
      const Vec2 placed = place(*start_);
      mission.start.x = placed.x();
      mission.start.y = placed.y();
    }
    if (start_yaw_) {
      mission.start.yaw = *start_yaw_ + turn;
    }
  }

  void Speed() {
    MissionSpec& mission = scenario_.mission;
    mission.speed = dice_.Logarithmic(settings_.driven ? 1.0 : 0.5, 15.0);
    if (dice_.Chance(0.4)) {
      mission.start.speed = 0.0;
    } else if (dice_.Chance(0.3)) {
      mission.start.speed = dice_.Between(0.2, 1.5) * mission.speed;
    }
  }

  /// Ice somewhere along the route, or under all of it, and a grade.
  void Road() {
    trackbed::World& world = scenario_.world;
    if (dice_.Chance(0.15)) {
      const std::vector<Vec2>& points = scenario_.mission.waypoints;
      const std::size_t leg = dice_.Below(points.size() - 1);
      const Vec2 at = points[leg] + dice_.Between(0.0, 1.0) * (points[leg + 1] - points[leg]);
      const double length = dice_.Logarithmic(1.0, 50.0);
      world.friction_patches.push_back(
          {{{at.x(), at.y(), dice_.Between(-1.0, 1.0) * kHalfTurn}, length, 10.0},
           dice_.Logarithmic(0.05, 0.6)});
    }
    if (dice_.Chance(0.1)) {
      world.friction = dice_.Logarithmic(0.1, 0.9);
    }
    if (dice_.Chance(0.15)) {
      world.ground.grade = {dice_.Between(-0.1, 0.1), dice_.Between(-0.1, 0.1)};
    }
  }

  [[nodiscard]] trackbed::Scenario& scenario() { return scenario_; }

 private:
  std::size_t Count(std::size_t fewest = 2) {
    const std::size_t least = std::max(fewest, fewest_);
    return least + dice_.Below(5 - least + 1);
  }

  double Length() {
    return settings_.driven ? dice_.Logarithmic(1.0, 40.0) : dice_.Logarithmic(1e-3, 1e3);
  }

  template <typename LengthOf, typename TurnOf>
  void Legs(std::size_t count, const LengthOf& length, const TurnOf& turn) {
    Vec2 at(0.0, 0.0);
    double heading = 0.0;
    points_.push_back(at);
    for (std::size_t i = 1; i < count; ++i) {
      at += length() * Along(heading);
      points_.push_back(at);
      heading += turn();
    }
  }

  void HeadingsAlongLegs() {
    if (!has_headings_ || dice_.Chance(0.5)) {
      return;
    }
    const double error = dice_.Logarithmic(1e-6, 1e-2);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      headings_.push_back(error * dice_.Between(-1.0, 1.0));
    }
  }

  Dice dice_;
  RouteSettings settings_;
  std::size_t fewest_;
  bool has_headings_;
  trackbed::Scenario scenario_{};
  std::vector<Vec2> points_;
  std::vector<double> headings_;
  std::optional<Vec2> start_;
  std::optional<double> start_yaw_;
};

struct Shape {
  const char* name;
  void (Drawing::*draw)();
};

constexpr std::array kShapes{Shape{"line", &Drawing::Line},
                             Shape{"uneven line", &Drawing::UnevenLine},
                             Shape{"hairpin", &Drawing::Hairpin},
                             Shape{"blocks", &Drawing::Blocks},
                             Shape{"scattered", &Drawing::Scattered},
                             Shape{"bend", &Drawing::Bend},
                             Shape{"close", &Drawing::Close},
                             Shape{"loop", &Drawing::Loop},
                             Shape{"eighths", &Drawing::Eighths},
                             Shape{"start beside", &Drawing::StartBeside},
                             Shape{"goal behind", &Drawing::GoalBehind}};

}  // namespace ordinary_routes

std::vector<trackbed::PlannerEntry> RoutePlanners() {
  std::vector<trackbed::PlannerEntry> entries = trackbed::Planners();
  std::erase_if(entries,
                [](const trackbed::PlannerEntry& entry) { return entry.min_waypoints == 0; });
  return entries;
}

std::size_t RouteShapes() {
  return ordinary_routes::kShapes.size();
}

OrdinaryRoute RouteOf(std::size_t index, const RouteSettings& settings) {
  const std::vector<trackbed::PlannerEntry> planners = RoutePlanners();
  const trackbed::PlannerEntry& planner = planners[index % planners.size()];
  const ordinary_routes::Shape& shape =
      ordinary_routes::kShapes[index / planners.size() % RouteShapes()];
  ordinary_routes::Drawing drawing(7919U * index + (settings.driven ? 1U : 0U), settings,
                                   planner.min_waypoints, planner.has_headings);
  (drawing.*shape.draw)();
  trackbed::Scenario& scenario = drawing.scenario();
  scenario.name = fmt::format("route_{}", index);
  scenario.seed = index;
  scenario.plan = trackbed::PlanSpec{};
  scenario.plan->global = planner.defaults;
  drawing.Place();
  drawing.Speed();
  drawing.Road();
  return {shape.name, scenario};
}

}  // namespace audit
