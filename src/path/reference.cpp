#include "trackbed/path/reference.h"

#include <algorithm>
#include <cmath>

#include "trackbed/core/error.h"
#include "trackbed/path/acceleration_caps.h"

namespace trackbed {
namespace {

/// Distance [m] below which two knots of a speed profile are regarded as one knot.
constexpr double kSameKnot = 0.5e-9;

}  // namespace

SpeedProfile::SpeedProfile(std::vector<Knot> knots) : knots_(std::move(knots)) {
  for (std::size_t i = 0; i < knots_.size(); ++i) {
    TRACKBED_CHECK(knots_[i].speed >= 0.0 && std::isfinite(knots_[i].speed), "speed {}",
                   knots_[i].speed);
    TRACKBED_CHECK(std::isfinite(knots_[i].s), "station {}", knots_[i].s);
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
  if (knots_.empty() || std::isnan(s)) {
    return knots_.empty() ? 0.0 : s;
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
  if (std::isnan(s)) {
    return s;
  }
  if (knots_.size() < 2 || s < knots_.front().s || s >= knots_.back().s) {
    return 0.0;
  }
  const std::size_t i = IntervalAt(s);
  const Knot& a = knots_[i];
  const Knot& b = knots_[i + 1];
  return (b.speed * b.speed - a.speed * a.speed) / (2.0 * (b.s - a.s));
}

double SpeedProfile::TimeAt(double s) const {
  double time = std::isnan(s) ? s : 0.0;
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

double SpeedProfile::StationAt(double time) const {
  if (knots_.empty()) {
    return 0.0;
  }
  for (std::size_t i = 0; i + 1 < knots_.size(); ++i) {
    const Knot& a = knots_[i];
    const Knot& b = knots_[i + 1];
    // If the speeds at both knots are 0, the duration between the knots is infinite, because the
    // car stays at rest.
    const double duration = 2.0 * (b.s - a.s) / (a.speed + b.speed);
    if (time < duration) {
      const double acceleration = (b.speed - a.speed) / duration;
      return a.s + time * (a.speed + 0.5 * time * acceleration);
    }
    time -= duration;
  }
  return knots_.back().s + time * knots_.back().speed;
}

SpeedProfile StopAtEnd(double length, double start_speed, const SpeedLimits& limits,
                       const std::vector<SpeedCap>& caps) {
  return StopAtEnd(length, start_speed, limits, caps, {});
}

SpeedProfile StopAtCusps(const Path& path, double start_speed, const SpeedLimits& limits,
                         const std::vector<SpeedCap>& caps, const std::vector<double>& stops) {
  return StopAtCusps(path, start_speed, limits, caps, stops, {});
}

SpeedProfile Excerpt(const SpeedProfile& profile, Stations within) {
  TRACKBED_REQUIRE(!std::isnan(within.from) && !std::isnan(within.to),
                   "Excerpt: stations {} and {}; must be numbers", within.from, within.to);
  std::vector<SpeedProfile::Knot> knots{{0.0, profile.SpeedAt(within.from)}};
  for (const SpeedProfile::Knot& knot : profile.knots()) {
    // Skip knots of the speed profile that would coincide with an end of the excerpt due to
    // rounding errors.
    if (knot.s > within.from + kSameKnot && knot.s < within.to - kSameKnot) {
      knots.push_back({knot.s - within.from, knot.speed});
    }
  }
  if (within.to > within.from) {
    knots.push_back({within.to - within.from, profile.SpeedAt(within.to)});
  }
  return SpeedProfile(std::move(knots));
}

Reference Excerpt(const Reference& reference, Stations within) {
  return {Path(reference.path.At(within.from).pose, reference.path.Cut(within)),
          Excerpt(reference.speed, within)};
}

}  // namespace trackbed
