#include "trackbed/path/reference.h"

#include <algorithm>
#include <cmath>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Stretches of a profile shorter than this are left out [m].
constexpr double kNegligible = 1e-9;

}  // namespace

SpeedProfile::SpeedProfile(std::vector<Knot> knots) : knots_(std::move(knots)) {
  for (std::size_t i = 0; i < knots_.size(); ++i) {
    TRACKBED_CHECK(knots_[i].speed >= 0.0 && std::isfinite(knots_[i].speed), "speed {}",
                   knots_[i].speed);
    TRACKBED_CHECK(i == 0 || knots_[i].s > knots_[i - 1].s, "stations {} and {} do not rise",
                   knots_[i - 1].s, knots_[i].s);
  }
}

std::size_t SpeedProfile::IntervalAt(double s) const {
  const auto after =
      std::upper_bound(knots_.begin(), knots_.end(), s,
                       [](double value, const Knot& knot) { return value < knot.s; });
  const auto index = std::clamp<std::ptrdiff_t>(after - knots_.begin() - 1, 0,
                                                static_cast<std::ptrdiff_t>(knots_.size()) - 2);
  return static_cast<std::size_t>(index);
}

double SpeedProfile::SpeedAt(double s) const {
  if (knots_.empty()) {
    return 0.0;
  }
  if (s <= knots_.front().s) {
    return knots_.front().speed;
  }
  if (s >= knots_.back().s) {
    return knots_.back().speed;
  }
  const std::size_t i = IntervalAt(s);
  const Knot& a = knots_[i];
  const Knot& b = knots_[i + 1];
  const double share = (s - a.s) / (b.s - a.s);
  return std::sqrt(std::lerp(a.speed * a.speed, b.speed * b.speed, share));
}

double SpeedProfile::AccelerationAt(double s) const {
  if (knots_.size() < 2 || s < knots_.front().s || s >= knots_.back().s) {
    return 0.0;
  }
  const std::size_t i = IntervalAt(s);
  const Knot& a = knots_[i];
  const Knot& b = knots_[i + 1];
  return (b.speed * b.speed - a.speed * a.speed) / (2.0 * (b.s - a.s));
}

double SpeedProfile::TimeAt(double s) const {
  double time = 0.0;
  for (std::size_t i = 0; i + 1 < knots_.size() && knots_[i].s < s; ++i) {
    const double end = std::min(s, knots_[i + 1].s);
    const double end_speed = end == knots_[i + 1].s ? knots_[i + 1].speed : SpeedAt(end);
    time += 2.0 * (end - knots_[i].s) / (knots_[i].speed + end_speed);
  }
  if (!knots_.empty() && s > knots_.back().s) {
    time += (s - knots_.back().s) / knots_.back().speed;
  }
  return time;
}

SpeedProfile StopAtEnd(double length, double start_speed, const SpeedLimits& limits) {
  if (length <= 0.0) {
    return SpeedProfile({{0.0, 0.0}});
  }
  const double a = start_speed > limits.speed ? -limits.deceleration : limits.acceleration;
  const double b = limits.deceleration;
  const double v0_squared = start_speed * start_speed;
  const double v_squared = limits.speed * limits.speed;
  const double ramp = (v_squared - v0_squared) / (2.0 * a);  // to the limit
  const double stop = v_squared / (2.0 * b);                 // from the limit
  std::vector<SpeedProfile::Knot> knots{{0.0, start_speed}};
  if (ramp + stop <= length) {
    if (ramp > kNegligible) {
      knots.push_back({ramp, limits.speed});
    }
    if (length - stop > knots.back().s + kNegligible) {
      knots.push_back({length - stop, limits.speed});
    }
  } else if (start_speed <= limits.speed && v0_squared < 2.0 * b * length) {
    // No room for the limit: accelerate until braking must begin.
    const double peak_squared = (2.0 * a * b * length + b * v0_squared) / (a + b);
    const double peak = (peak_squared - v0_squared) / (2.0 * a);
    if (peak > kNegligible && peak < length - kNegligible) {
      knots.push_back({peak, std::sqrt(peak_squared)});
    }
  }
  knots.push_back({length, 0.0});
  return SpeedProfile(std::move(knots));
}

}  // namespace trackbed
