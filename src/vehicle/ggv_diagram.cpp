#include "trackbed/vehicle/ggv_diagram.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

void CheckForces(const LongitudinalForces& forces) {
  TRACKBED_CHECK(forces.mass > 0.0 && forces.rolling_mass > 0.0 && std::isfinite(forces.mass) &&
                     std::isfinite(forces.rolling_mass),
                 "mass {} kg, rolling mass {} kg", forces.mass, forces.rolling_mass);
  for (const double number : {forces.drive_force, forces.drive_power, forces.brake_force,
                              forces.rolling_resistance, forces.drag, forces.top_speed}) {
    TRACKBED_CHECK(number >= 0.0 && std::isfinite(number), "a force is {}", number);
  }
}

void CheckSection(const GgvSection& section, std::size_t size) {
  TRACKBED_CHECK(std::isfinite(section.speed) && section.speed >= 0.0 &&
                     std::isfinite(section.road) && section.road > 0.0 &&
                     std::isfinite(section.lateral) && section.lateral > 0.0,
                 "section of {} m/s on a road of {}: lateral {} m/s^2", section.speed, section.road,
                 section.lateral);
  TRACKBED_CHECK(size >= 2 && section.driving.size() == size && section.braking.size() == size,
                 "{} driving and {} braking values", section.driving.size(),
                 section.braking.size());
  for (std::size_t i = 0; i < size; ++i) {
    TRACKBED_CHECK(std::isfinite(section.driving[i]) && std::isfinite(section.braking[i]) &&
                       section.braking[i] <= section.driving[i],
                   "from {} to {} m/s^2", section.braking[i], section.driving[i]);
  }
}

/// Position of a value in an ascending list: the index of the next lower list value, and the
/// relative position between this list value and the next one.
struct Place {
  std::size_t index = 0;
  double share = 0.0;
};

template <typename Measure>
Place PlaceAmong(const std::vector<double>& values, double value, const Measure& measure) {
  if (values.size() < 2 || value <= values.front()) {
    return {};
  }
  if (value >= values.back()) {
    return {values.size() - 1, 0.0};
  }
  const auto above = std::upper_bound(values.begin(), values.end(), value);
  const double low = measure(*(above - 1));
  return {static_cast<std::size_t>(above - values.begin()) - 1,
          (measure(value) - low) / (measure(*above) - low)};
}

/// Returns the position on the boundary of a g-g-v section at which the lateral acceleration f_y is
/// `ratio` times the section's largest f_y. The points on the boundary of a g-g-v section are
/// numbered from 0 to `last`.
Place PlaceOnBoundary(double ratio, std::size_t last) {
  const double sine = std::sqrt(1.0 - ratio * ratio);
  if (last == 1) {
    return {0, sine};
  }
  const double step = 0.5 * std::numbers::pi / static_cast<double>(last);
  const std::size_t index = std::min(static_cast<std::size_t>(std::acos(ratio) / step), last - 1);
  const double low = std::sin(step * static_cast<double>(index));
  const double high = std::sin(step * static_cast<double>(index + 1));
  return {index, std::clamp((sine - low) / (high - low), 0.0, 1.0)};
}

void AddOnce(std::vector<double>& values, double value) {
  const auto at = std::lower_bound(values.begin(), values.end(), value);
  if (at == values.end() || *at != value) {
    values.insert(at, value);
  }
}

}  // namespace

GgvDiagram::GgvDiagram(const LongitudinalForces& forces, std::vector<GgvSection> sections)
    : forces_(forces), sections_(std::move(sections)) {
  CheckForces(forces_);
  TRACKBED_CHECK(!sections_.empty(), "a diagram without sections");
  for (const GgvSection& section : sections_) {
    CheckSection(section, sections_.front().driving.size());
    AddOnce(speeds_, section.speed);
    AddOnce(roads_, section.road);
  }
  std::sort(sections_.begin(), sections_.end(), [](const GgvSection& a, const GgvSection& b) {
    return a.road != b.road ? a.road < b.road : a.speed < b.speed;
  });
  TRACKBED_CHECK(sections_.size() == speeds_.size() * roads_.size(),
                 "{} sections for {} speeds and {} roads", sections_.size(), speeds_.size(),
                 roads_.size());
  for (std::size_t i = 0; i < sections_.size(); ++i) {
    TRACKBED_CHECK(sections_[i].road == roads_[i / speeds_.size()] &&
                       sections_[i].speed == speeds_[i % speeds_.size()],
                   "no section of {} m/s on a road of {}", speeds_[i % speeds_.size()],
                   roads_[i / speeds_.size()]);
  }
}

GgvDiagram::Weights GgvDiagram::WeightsAt(const GgvPoint& point) const {
  const Place road = PlaceAmong(roads_, point.road, [](double x) { return x; });
  const Place speed = PlaceAmong(speeds_, point.speed, [](double v) { return v * v; });
  // For friction coefficients outside the range of the tabulated roads `roads_`, assume that the
  // forces are proportional to the friction coefficient.
  const double beyond =
      point.road / std::clamp(point.road, roads_.front(), roads_.back());  // scale factor
  Weights weights;
  const auto add = [&](std::size_t at_road, std::size_t at_speed, double weight) {
    if (weight > 0.0) {
      weights.section[weights.count] = &sections_[at_road * speeds_.size() + at_speed];
      weights.weight[weights.count] = weight * beyond * point.load;
      ++weights.count;
    }
  };
  add(road.index, speed.index, (1.0 - road.share) * (1.0 - speed.share));
  add(road.index, speed.index + 1, (1.0 - road.share) * speed.share);
  add(road.index + 1, speed.index, road.share * (1.0 - speed.share));
  add(road.index + 1, speed.index + 1, road.share * speed.share);
  return weights;
}

double GgvDiagram::MaxLateral(const GgvPoint& point) const {
  const Weights weights = WeightsAt(point);
  double lateral = 0.0;
  for (std::size_t i = 0; i < weights.count; ++i) {
    lateral += weights.weight[i] * weights.section[i]->lateral;
  }
  return lateral;
}

TyreRange GgvDiagram::TyresAt(const GgvPoint& point) const {
  const Weights weights = WeightsAt(point);
  double lateral = 0.0;
  for (std::size_t i = 0; i < weights.count; ++i) {
    lateral += weights.weight[i] * weights.section[i]->lateral;
  }
  const double ratio = lateral > 0.0 ? std::min(1.0, std::abs(point.lateral) / lateral) : 1.0;
  const std::size_t last = sections_.front().driving.size() - 1;
  const auto [index, share] = PlaceOnBoundary(ratio, last);
  TyreRange range;
  for (std::size_t i = 0; i < weights.count; ++i) {
    const GgvSection& section = *weights.section[i];
    range.driving +=
        weights.weight[i] * std::lerp(section.driving[index], section.driving[index + 1], share);
    range.braking +=
        weights.weight[i] * std::lerp(section.braking[index], section.braking[index + 1], share);
  }
  return range;
}

AccelerationRange GgvDiagram::AccelerationsAt(const GgvPoint& point, double share,
                                              double slope) const {
  GgvPoint whole = point;
  whole.lateral /= share;
  const TyreRange tyres = TyresAt(whole);
  const double resistance = forces_.drag * point.speed * point.speed / forces_.mass + slope;
  // Driving resistance of the car [N].
  const double against = forces_.rolling_resistance + forces_.mass * resistance;
  const double motor = share * DriveForce(point.speed) - against;
  const double brakes = forces_.brake_force > 0.0 ? share * forces_.brake_force
                                                  : std::numeric_limits<double>::infinity();
  return {std::max(share * tyres.braking - resistance, -(brakes + against) / forces_.rolling_mass),
          std::min(share * tyres.driving - resistance, motor / forces_.rolling_mass)};
}

double GgvDiagram::DriveForce(double speed) const {
  double force =
      forces_.drive_force > 0.0 ? forces_.drive_force : std::numeric_limits<double>::infinity();
  if (forces_.drive_power > 0.0 && force * speed > forces_.drive_power) {
    force = forces_.drive_power / speed;
  }
  return force;
}

GgvSection EllipticSection(double driving, double braking, double lateral) {
  return {.lateral = lateral, .driving = {0.0, driving}, .braking = {0.0, -braking}};
}

}  // namespace trackbed
