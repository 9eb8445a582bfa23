#include "trackbed/path/reference.h"

#include <algorithm>
#include <cmath>

#include "trackbed/core/error.h"

// Computes speed profiles with constant acceleration between knots. StopAtEnd splits the path into
// stretches at the ends of the speed caps. A backward pass limits the speed at each end of a
// stretch, so that the car can brake in time for the rest of the path. A forward pass limits the
// speed to what the car can reach by accelerating from the start. StopAtEnd then adds knots to each
// stretch where the car starts to cruise and where it starts to brake. A car that starts too fast
// brakes as hard as needed until its speed meets the profile.

namespace trackbed {
namespace {

/// Length below which stretches of a profile are dropped [m].
constexpr double kNegligible = 1e-9;

/// A stretch of the path with a constant speed limit.
struct Stretch {
  double from;
  double to;
  double speed;
};

/// Splits the path from station 0 to `length` at the ends of the speed caps.
std::vector<Stretch> SplitAtSpeedCaps(double length, double limit,
                                      const std::vector<SpeedCap>& caps) {
  std::vector<double> ends{0.0, length};
  for (const SpeedCap& cap : caps) {
    for (const double s : {cap.from, cap.to}) {
      if (s > kNegligible && s < length - kNegligible) {
        ends.push_back(s);
      }
    }
  }
  std::sort(ends.begin(), ends.end());
  std::vector<Stretch> stretches;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    if (ends[i + 1] - ends[i] < kNegligible) {
      continue;
    }
    double speed = limit;
    const double middle = 0.5 * (ends[i] + ends[i + 1]);
    for (const SpeedCap& cap : caps) {
      if (cap.from <= middle && middle <= cap.to) {
        speed = std::min(speed, cap.speed);
      }
    }
    stretches.push_back({ends[i], ends[i + 1], speed});
  }
  return stretches;
}

/// Adds the knots inside a stretch, given the squared speeds at both ends. The caller ensures that
/// the stretch is long enough to change between these speeds. The car first accelerates, or brakes
/// at `braking`, to the speed of the stretch, then cruises, and finally brakes to the exit speed.
void AddInnerKnots(const Stretch& stretch, double in_squared, double out_squared, double braking,
                   const SpeedLimits& limits, std::vector<SpeedProfile::Knot>& knots) {
  const double a = in_squared > stretch.speed * stretch.speed ? -braking : limits.acceleration;
  const double b = limits.deceleration;
  const double length = stretch.to - stretch.from;
  const auto add = [&](double s, double v_squared) {
    if (s > knots.back().s + kNegligible && s < stretch.to - kNegligible) {
      knots.push_back({s, std::sqrt(v_squared)});
    }
  };
  const double v_squared = stretch.speed * stretch.speed;
  const double ramp = (v_squared - in_squared) / (2.0 * a);
  const double brake = (v_squared - out_squared) / (2.0 * b);
  if (ramp + brake <= length) {
    add(stretch.from + ramp, v_squared);
    add(stretch.to - brake, v_squared);
  } else if (a > 0.0) {
    // The stretch is too short for the car to reach the speed limit, so the car accelerates until
    // it must begin to brake.
    const double peak = (out_squared - in_squared + 2.0 * b * length) / (2.0 * (a + b));
    add(stretch.from + peak, in_squared + 2.0 * a * peak);
  }
}

void CheckArguments(double length, double start_speed, const SpeedLimits& limits,
                    const std::vector<SpeedCap>& caps) {
  TRACKBED_REQUIRE(
      std::isfinite(length) && std::isfinite(start_speed) && std::isfinite(limits.speed) &&
          std::isfinite(limits.acceleration) && std::isfinite(limits.deceleration),
      "StopAtEnd: length {} m, start speed {} m/s, limits {} m/s, {} and {} m/s^2; must "
      "be finite",
      length, start_speed, limits.speed, limits.acceleration, limits.deceleration);
  for (const SpeedCap& cap : caps) {
    TRACKBED_REQUIRE(!std::isnan(cap.from) && !std::isnan(cap.to) && !std::isnan(cap.speed),
                     "StopAtEnd: a cap from {} to {} m of {} m/s; must be numbers", cap.from,
                     cap.to, cap.speed);
  }
}

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
    // If the speeds at both ends are 0, the duration is infinite, because the car stays at rest.
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
  CheckArguments(length, start_speed, limits, caps);
  if (length <= 0.0) {
    return SpeedProfile({{0.0, 0.0}});
  }
  const std::vector<Stretch> stretches = SplitAtSpeedCaps(length, limits.speed, caps);
  const double start_squared = start_speed * start_speed;
  // Compute the largest squared speeds at the ends of the stretches: first backward from standstill
  // at the end, then forward from the start speed.
  std::vector<double> squared(stretches.size() + 1, 0.0);
  double braking = std::max(limits.deceleration, start_squared / (2.0 * length));
  for (std::size_t i = stretches.size(); i-- > 0;) {
    const auto& [from, to, speed] = stretches[i];
    const double here = i == 0 ? speed : std::min(speed, stretches[i - 1].speed);
    squared[i] = std::min(here * here, squared[i + 1] + 2.0 * limits.deceleration * (to - from));
    if (from > 0.0) {
      braking = std::max(braking, (start_squared - speed * speed) / (2.0 * from));
    }
  }
  // A car that starts too fast for the path ahead brakes at `braking` until its speed meets the
  // profile.
  bool too_fast = start_squared > squared[0];
  squared[0] = start_squared;
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    const double step = 2.0 * (stretches[i].to - stretches[i].from);
    const double down = start_squared - 2.0 * braking * stretches[i].to;
    constexpr double kRounding = 1e-12;
    too_fast = too_fast && down > squared[i + 1] + kRounding * start_squared;
    squared[i + 1] =
        too_fast ? down : std::min(squared[i + 1], squared[i] + step * limits.acceleration);
  }
  std::vector<SpeedProfile::Knot> knots{{0.0, start_speed}};
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    AddInnerKnots(stretches[i], squared[i], squared[i + 1], braking, limits, knots);
    const double s = i + 1 < stretches.size() ? stretches[i].to : length;
    knots.push_back({s, std::sqrt(squared[i + 1])});
  }
  return SpeedProfile(std::move(knots));
}

SpeedProfile StopAtCusps(const Path& path, double start_speed, const SpeedLimits& limits,
                         const std::vector<SpeedCap>& caps, const std::vector<double>& stops) {
  std::vector<SpeedProfile::Knot> knots;
  for (const Stations& leg : SplitIntoLegs(path, stops)) {
    if (!knots.empty() && leg.to - leg.from < 2.0 * kNegligible) {
      continue;
    }
    std::vector<SpeedCap> own;
    for (const SpeedCap& cap : caps) {
      own.push_back({cap.from - leg.from, cap.to - leg.from, cap.speed});
    }
    const bool first = knots.empty();
    const SpeedProfile profile =
        StopAtEnd(leg.to - leg.from, first ? start_speed : 0.0, limits, own);
    for (const SpeedProfile::Knot& knot : profile.knots()) {
      // Skip a knot that coincides with the previous knot due to rounding errors in the sum of
      // stations.
      if (first || leg.from + knot.s > knots.back().s + 0.5 * kNegligible) {
        knots.push_back({leg.from + knot.s, knot.speed});
      }
    }
    knots.back().s = leg.to;
  }
  return SpeedProfile(std::move(knots));
}

SpeedProfile Excerpt(const SpeedProfile& profile, Stations within) {
  TRACKBED_REQUIRE(!std::isnan(within.from) && !std::isnan(within.to),
                   "Excerpt: stations {} and {}; must be numbers", within.from, within.to);
  std::vector<SpeedProfile::Knot> knots{{0.0, profile.SpeedAt(within.from)}};
  for (const SpeedProfile::Knot& knot : profile.knots()) {
    // Skip knots that would coincide with an end of the excerpt due to rounding errors.
    if (knot.s > within.from + 0.5 * kNegligible && knot.s < within.to - 0.5 * kNegligible) {
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
