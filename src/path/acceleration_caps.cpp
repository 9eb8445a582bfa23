#include "trackbed/path/acceleration_caps.h"

#include <algorithm>
#include <cmath>

#include "trackbed/core/error.h"

// Computes speed profiles with constant acceleration between knots. StopAtEnd splits the path into
// stretches at the ends of all caps (local limits of speed or acceleration). A backward pass limits
// the speed at each end of a stretch, so that the car can brake in time for the rest of the path. A
// forward pass limits the speed to what the car can reach by accelerating from the start. StopAtEnd
// then adds knots where the car starts to cruise in a stretch, and where it starts to brake. A car
// that starts faster than the profile brakes until it reaches the profile. Such a car brakes as
// hard as the strict caps, the sections of less grip and the path's end demand.

namespace trackbed {
namespace {

/// Length below which stretches of a speed profile are omitted [m].
constexpr double kNegligible = 1e-9;

/// A stretch of the path with constant limits of speed and acceleration.
struct Stretch {
  double from;
  double to;
  double speed;
  double acceleration;
  double deceleration;
};

/// Splits the path from station 0 to `length` at the ends of the caps.
class Splitter {
 public:
  Splitter(double length, const std::vector<SpeedCap>& caps,
           const std::vector<AccelerationCap>& sections)
      : length_(length) {
    AddEndsOf(caps);
    AddEndsOf(sections);
    std::sort(ends_.begin(), ends_.end());
  }

  [[nodiscard]] std::vector<Stretch> Stretches(const SpeedLimits& limits) const {
    std::vector<Stretch> stretches;
    for (std::size_t i = 0; i + 1 < ends_.size(); ++i) {
      if (ends_[i + 1] - ends_[i] >= kNegligible) {
        stretches.push_back(
            {ends_[i], ends_[i + 1], limits.speed, limits.acceleration, limits.deceleration});
      }
    }
    return stretches;
  }

 private:
  template <typename Cap>
  void AddEndsOf(const std::vector<Cap>& caps) {
    for (const Cap& cap : caps) {
      for (const double s : {cap.from, cap.to}) {
        if (s > kNegligible && s < length_ - kNegligible) {
          ends_.push_back(s);
        }
      }
    }
  }

  double length_;
  std::vector<double> ends_{0.0, length_};
};

/// Calls `limit` for each stretch whose middle lies on the section from `from` to `to`.
template <typename Limit>
void ForEachOn(std::vector<Stretch>& stretches, double from, double to, const Limit& limit) {
  const auto middle = [](const Stretch& stretch) { return 0.5 * (stretch.from + stretch.to); };
  auto stretch =
      std::lower_bound(stretches.begin(), stretches.end(), from,
                       [&](const Stretch& each, double station) { return middle(each) < station; });
  for (; stretch != stretches.end() && middle(*stretch) <= to; ++stretch) {
    limit(*stretch);
  }
}

std::vector<Stretch> SplitAtCaps(double length, const SpeedLimits& limits,
                                 const std::vector<SpeedCap>& caps,
                                 const std::vector<AccelerationCap>& sections) {
  std::vector<Stretch> stretches = Splitter(length, caps, sections).Stretches(limits);
  for (const SpeedCap& cap : caps) {
    ForEachOn(stretches, cap.from, cap.to,
              [&](Stretch& stretch) { stretch.speed = std::min(stretch.speed, cap.speed); });
  }
  for (const AccelerationCap& section : sections) {
    ForEachOn(stretches, section.from, section.to, [&](Stretch& stretch) {
      stretch.acceleration = std::min(stretch.acceleration, section.acceleration);
      stretch.deceleration = std::min(stretch.deceleration, section.deceleration);
    });
  }
  return stretches;
}

/// Adds the knots of the speed profile inside a stretch, given the squared speeds at both ends. The
/// stretch must be long enough to change between the two speeds. The car first accelerates, or
/// brakes at `braking`, to the speed of the stretch, then cruises, and finally brakes to the exit
/// speed.
void AddInnerKnots(const Stretch& stretch, double in_squared, double out_squared, double braking,
                   std::vector<SpeedProfile::Knot>& knots) {
  const double a = in_squared > stretch.speed * stretch.speed ? -braking : stretch.acceleration;
  const double b = stretch.deceleration;
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
    // If the stretch is too short for the car to reach its speed limit, the car accelerates until
    // it must begin to brake.
    const double peak = (out_squared - in_squared + 2.0 * b * length) / (2.0 * (a + b));
    add(stretch.from + peak, in_squared + 2.0 * a * peak);
  }
}

/// Returns the constant deceleration at which a car slows down if it starts faster than the profile
/// [m/s^2]. The returned deceleration is that of the first stretch, or `deceleration` without
/// stretches. The deceleration is increased if the car would be too fast at the start of a strict
/// cap, at the start of a section of less grip, or at the path's end. The argument `squared`
/// contains the largest squared speeds at the ends of the stretches.
double BrakingFromStart(double length, double start_squared, double deceleration,
                        const std::vector<SpeedCap>& caps, const std::vector<Stretch>& stretches,
                        const std::vector<double>& squared) {
  double braking = std::max(stretches.empty() ? deceleration : stretches.front().deceleration,
                            start_squared / (2.0 * length));
  for (const SpeedCap& cap : caps) {
    if (cap.strict && cap.from > kNegligible && cap.from < length - kNegligible &&
        cap.to > cap.from) {
      braking = std::max(braking, (start_squared - cap.speed * cap.speed) / (2.0 * cap.from));
    }
  }
  for (std::size_t i = 1; i < stretches.size(); ++i) {
    if (stretches[i].deceleration < deceleration) {
      braking = std::max(braking, (start_squared - squared[i]) / (2.0 * stretches[i].from));
    }
  }
  return braking;
}

void CheckArguments(double length, double start_speed, const SpeedLimits& limits,
                    const std::vector<SpeedCap>& caps,
                    const std::vector<AccelerationCap>& sections) {
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
  for (const AccelerationCap& section : sections) {
    TRACKBED_REQUIRE(!std::isnan(section.from) && !std::isnan(section.to) &&
                         section.acceleration > 0.0 && section.deceleration > 0.0,
                     "StopAtEnd: a section from {} to {} m of {} and {} m/s^2; stations must be "
                     "numbers, accelerations above 0",
                     section.from, section.to, section.acceleration, section.deceleration);
  }
}

/// Returns the caps on each leg, with stations that count from the start of the leg.
template <typename Cap>
std::vector<std::vector<Cap>> OnLegs(const std::vector<Stations>& legs,
                                     const std::vector<Cap>& caps) {
  std::vector<std::vector<Cap>> own(legs.size());
  for (const Cap& cap : caps) {
    const auto first =
        std::lower_bound(legs.begin(), legs.end(), cap.from,
                         [](const Stations& leg, double station) { return leg.to < station; });
    for (auto i = static_cast<std::size_t>(first - legs.begin());
         i < legs.size() && legs[i].from <= cap.to; ++i) {
      own[i].push_back(cap);
      own[i].back().from -= legs[i].from;
      own[i].back().to -= legs[i].from;
    }
  }
  return own;
}

}  // namespace

SpeedProfile StopAtEnd(double length, double start_speed, const SpeedLimits& limits,
                       const std::vector<SpeedCap>& caps,
                       const std::vector<AccelerationCap>& sections) {
  CheckArguments(length, start_speed, limits, caps, sections);
  if (length <= 0.0) {
    return SpeedProfile({{0.0, 0.0}});
  }
  const std::vector<Stretch> stretches = SplitAtCaps(length, limits, caps, sections);
  const double start_squared = start_speed * start_speed;
  // Compute the largest squared speeds at the ends of the stretches: first backward from standstill
  // at the end, then forward from the start speed.
  std::vector<double> squared(stretches.size() + 1, 0.0);
  for (std::size_t i = stretches.size(); i-- > 0;) {
    const Stretch& stretch = stretches[i];
    const double here = i == 0 ? stretch.speed : std::min(stretch.speed, stretches[i - 1].speed);
    squared[i] = std::min(
        here * here, squared[i + 1] + 2.0 * stretch.deceleration * (stretch.to - stretch.from));
  }
  const double braking =
      BrakingFromStart(length, start_squared, limits.deceleration, caps, stretches, squared);
  // A car that starts too fast for the path ahead brakes at the deceleration `braking` until its
  // speed equals the profile's.
  bool too_fast = start_squared > squared[0];
  squared[0] = start_squared;
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    const double step = 2.0 * (stretches[i].to - stretches[i].from);
    const double down = start_squared - 2.0 * braking * stretches[i].to;
    constexpr double kRounding = 1e-12;
    too_fast = too_fast && down > squared[i + 1] + kRounding * start_squared;
    squared[i + 1] =
        too_fast ? down : std::min(squared[i + 1], squared[i] + step * stretches[i].acceleration);
  }
  std::vector<SpeedProfile::Knot> knots{{0.0, start_speed}};
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    AddInnerKnots(stretches[i], squared[i], squared[i + 1], braking, knots);
    const double s = i + 1 < stretches.size() ? stretches[i].to : length;
    knots.push_back({s, std::sqrt(squared[i + 1])});
  }
  return SpeedProfile(std::move(knots));
}

SpeedProfile StopAtCusps(const Path& path, double start_speed, const SpeedLimits& limits,
                         const std::vector<SpeedCap>& caps, const std::vector<double>& stops,
                         const std::vector<AccelerationCap>& sections) {
  CheckArguments(path.length(), start_speed, limits, caps, sections);
  std::vector<SpeedProfile::Knot> knots;
  const std::vector<Stations> legs = SplitIntoLegs(path, stops);
  const std::vector<std::vector<SpeedCap>> own_caps = OnLegs(legs, caps);
  const std::vector<std::vector<AccelerationCap>> own_sections = OnLegs(legs, sections);
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const Stations& leg = legs[i];
    if (!knots.empty() && leg.to - leg.from < 2.0 * kNegligible) {
      continue;
    }
    const bool first = knots.empty();
    const SpeedProfile profile = StopAtEnd(leg.to - leg.from, first ? start_speed : 0.0, limits,
                                           own_caps[i], own_sections[i]);
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

}  // namespace trackbed
