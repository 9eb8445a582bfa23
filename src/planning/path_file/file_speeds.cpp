#include "src/planning/path_file/file_speeds.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

// Takes speeds, stops and waits of a path from its file.
// 1. CapsOf limits the speed between two points to the mean of their speeds.
// 2. The car of the file stands at points with the speed 0, and at places within max_deviation
//    where it stays so long that its mean speed is below kMinSpeed.
// 3. The duration of a standstill is the time from its first to its last point, plus a part of the
//    steps before and after. Of a step, only the time counts that braking or starting does not need
//    (StandingPart).
// 4. AddStops adds a stop at each standstill, and a wait if the file has times.
namespace trackbed {
namespace {

// Lower bound of the speed caps [m/s]. Next to a stop, the mean of the file's speeds may be lower
// than this bound.
constexpr double kMinSpeed = 0.1;

// Ratio of the length of the path through some points to the distance between the first and the
// last point. Above the ratio kToAndFro, the points move back and forth, as noise does.
constexpr double kToAndFro = 2.0;

std::vector<SpeedCap> CapsOf(const FittedPath& fitted) {
  const std::vector<double>& speed = fitted.given.speed;
  std::vector<SpeedCap> caps;
  const auto add = [&](double from, double to, double a, double b) {
    if (to > from) {
      caps.push_back({from, to, std::max(0.5 * (a + b), kMinSpeed), /*strict=*/false});
    }
  };
  for (std::size_t i = 0; i + 1 < speed.size(); ++i) {
    add(fitted.stations[i], fitted.stations[i + 1], speed[i], speed[i + 1]);
  }
  // On a closed path, add a cap from the last point back to the first point.
  if (!speed.empty() && fitted.options.closed) {
    add(fitted.stations.back(), fitted.path.length(), speed.back(), speed.front());
  }
  return caps;
}

/// Points of the path at which the file's car stands.
struct Standstill {
  std::size_t first;
  std::size_t last;
  double duration = 0.0;  // Duration of the standstill [s]; 0 if the file has no times.
};

/// Returns the runs of points at which the speed in the file is 0. Standstills that lie within
/// max_deviation of each other are joined to one standstill.
std::vector<Standstill> PointsWithoutSpeed(const FittedPath& fitted) {
  const std::vector<double>& speed = fitted.given.speed;
  const std::vector<double>& s = fitted.stations;
  std::vector<Standstill> found;
  for (std::size_t i = 0; i < speed.size(); ++i) {
    if (speed[i] > 0.0) {
      continue;
    }
    if (!found.empty() && (found.back().last + 1 == i ||
                           s[i] - s[found.back().first] <= fitted.options.max_deviation)) {
      found.back().last = i;
    } else {
      found.push_back({i, i});
    }
  }
  return found;
}

/// Returns for how long the car stands during the time step between the points i and j [s]. The car
/// has the speed 0 at point i, and moves at the neighboring point j. A car that starts at constant
/// acceleration a reaches the speed v after the distance d = v^2/(2 a) and the time 2 d/v; at
/// constant jerk, after 3 d/v. A time step of at most 3 d/v, up to rounding of the file, counts as
/// pure starting without standing.
double StandingPart(const FittedPath& fitted, std::size_t i, std::size_t j) {
  const double step = std::abs(fitted.given.time[j] - fitted.given.time[i]);
  const double distance = std::abs(fitted.stations[j] - fitted.stations[i]);
  const double speed = fitted.given.speed[j];
  constexpr double kRounding = 1e-3;
  if (speed <= 0.0 || step * speed <= 3.0 * distance * (1.0 + kRounding)) {
    return 0.0;
  }
  return step - 2.0 * distance / speed;
}

/// Returns the places at which the car stays within max_deviation for so long that its mean speed
/// is below kMinSpeed. A car that creeps for a longer distance does not stand.
std::vector<Standstill> SlowPlaces(const FittedPath& fitted) {
  const std::vector<double>& s = fitted.stations;
  const std::vector<double>& t = fitted.given.time;
  const double extent = fitted.options.max_deviation;
  const auto is_fast = [&](std::size_t i) {
    return s[i + 1] - s[i] > kMinSpeed * (t[i + 1] - t[i]);
  };
  std::vector<Standstill> found;
  Standstill joined{0, 0};   // Union of the present window and all earlier windows that overlap it.
  Standstill longest{0, 0};  // Longest window of standing that is part of `joined`.
  const auto finish = [&] {
    const bool creeps = (joined.first > 0 && !is_fast(joined.first - 1)) ||
                        (joined.last + 1 < t.size() && !is_fast(joined.last));
    if (longest.duration <= 0.0 || creeps || s[joined.last] - s[joined.first] > 2.0 * extent) {
      return;
    }
    while (longest.first < longest.last && is_fast(longest.first)) {
      ++longest.first;
    }
    while (longest.first < longest.last && is_fast(longest.last - 1)) {
      --longest.last;
    }
    longest.duration = t[longest.last] - t[longest.first];
    found.push_back(longest);
  };
  std::size_t end = 0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    end = std::max(end, i);
    while (end + 1 < t.size() && s[end + 1] - s[i] <= extent) {
      ++end;
    }
    const double duration = t[end] - t[i];
    if (duration <= extent / kMinSpeed) {
      continue;
    }
    if (longest.duration > 0.0 && i <= joined.last) {
      joined.last = end;
    } else {
      finish();
      joined = {i, end};
      longest = {i, i};
    }
    if (duration > longest.duration) {
      longest = {i, end, duration};
    }
  }
  finish();
  return found;
}

std::vector<Standstill> FindStandstills(const FittedPath& fitted) {
  std::vector<Standstill> found = PointsWithoutSpeed(fitted);
  const std::vector<double>& t = fitted.given.time;
  if (t.empty() || fitted.given.speed.empty()) {
    return found;
  }
  for (Standstill& own : found) {
    own.duration = t[own.last] - t[own.first];
    own.duration += own.first > 0 ? StandingPart(fitted, own.first, own.first - 1) : 0.0;
    own.duration += own.last + 1 < t.size() ? StandingPart(fitted, own.last, own.last + 1) : 0.0;
  }
  const std::size_t exact = found.size();
  for (const Standstill& slow : SlowPlaces(fitted)) {
    const bool is_known = std::any_of(
        found.begin(), found.begin() + static_cast<std::ptrdiff_t>(exact),
        [&](const Standstill& own) { return own.first <= slow.last && slow.first <= own.last; });
    if (!is_known) {
      found.push_back(slow);
    }
  }
  std::sort(found.begin(), found.end(),
            [](const Standstill& a, const Standstill& b) { return a.first < b.first; });
  return found;
}

/// Adds the stops and waits at the standstills. At a cusp or at a stop that the plan already has,
/// only adds the wait. Returns the stations of the new stops [m].
std::vector<double> AddStops(Plan& plan, const FittedPath& fitted, double start_speed) {
  std::vector<double> known = CuspsOf(fitted.path);
  known.insert(known.end(), plan.stops.begin(), plan.stops.end());
  if (start_speed == 0.0) {
    known.push_back(0.0);
  }
  const double near = fitted.options.max_deviation;
  std::vector<double> stops;
  for (const auto& [first, last, duration] : FindStandstills(fitted)) {
    const double from = fitted.stations[first];
    const double to = fitted.stations[last];
    const auto at = std::find_if(known.begin(), known.end(), [&](double own) {
      return from - near <= own && own <= to + near;
    });
    const bool is_inside = from > near && to < fitted.path.length() - near;
    if (at == known.end() && is_inside) {
      stops.push_back(from);
    } else if (at == known.end()) {
      continue;
    }
    const double s = at == known.end() ? from : *at;
    if (duration > 0.0 && !plan.waits.empty() && plan.waits.back().s == s) {
      plan.waits.back().duration += duration;
    } else if (duration > 0.0) {
      plan.waits.push_back({s, duration});
    }
  }
  plan.stops.insert(plan.stops.end(), stops.begin(), stops.end());
  return stops;
}

/// Describes where the car drives differently from the speeds in the file, one line each.
std::vector<std::string> SpeedNotes(const FittedPath& fitted, const std::vector<double>& stops,
                                    const std::vector<PlannedWait>& waits) {
  std::vector<std::string> notes;
  if (!stops.empty()) {
    notes.push_back(
        fmt::format("stops where the file's speed is 0: s = {:.4g} m", fmt::join(stops, ", ")));
  }
  if (!waits.empty()) {
    std::vector<std::string> list;
    for (const PlannedWait& wait : waits) {
      list.push_back(fmt::format("{:.4g} s at s = {:.4g} m", wait.duration, wait.s));
    }
    notes.push_back(fmt::format("waits as long as the file's car: {}", fmt::join(list, ", ")));
  }
  const std::vector<double>& speed = fitted.given.speed;
  const bool has_slow = std::any_of(speed.begin(), speed.end(),
                                    [](double own) { return own > 0.0 && own < kMinSpeed; });
  if (has_slow) {
    notes.push_back(fmt::format("the file's speeds below {} m/s are raised to it", kMinSpeed));
  }
  return notes;
}

/// Returns the largest of three radii [m]: of the circles around the first point, the last point
/// and the center of the bounding box that contain all points.
double NoiseOf(const PathPoints& given, std::size_t first, std::size_t last) {
  Vec2 low = given.points[first];
  Vec2 high = low;
  double largest = 0.0;
  for (std::size_t i = first; i <= last; ++i) {
    const Vec2& point = given.points[i];
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
    largest = std::max(
        {largest, (point - given.points[first]).norm(), (point - given.points[last]).norm()});
  }
  return std::max(largest, 0.5 * (high - low).norm());
}

}  // namespace

std::vector<double> CuspsOf(const Path& path) {
  std::vector<double> cusps;
  for (const Stations& leg : SplitIntoLegs(path)) {
    cusps.push_back(leg.from);
  }
  cusps.erase(cusps.begin());
  return cusps;
}

std::vector<Problem> FileSpeedProblems(const FittedPath& fitted, const std::string& file) {
  const PathPoints& given = fitted.given;
  std::vector<Problem> problems;
  for (const auto& [first, last, duration] : PointsWithoutSpeed(fitted)) {
    // Points that are closer together than the fit resolves count as one place, at which the car
    // stands.
    const double extent = fitted.stations[last] - fitted.stations[first];
    if (extent > fitted.options.max_deviation) {
      const double noise = NoiseOf(given, first, last);
      problems.push_back(
          {.file = file,
           .line = given.lines.empty() ? 0 : given.lines[first],
           .key = "speed",
           .message = fmt::format(
               "the speed is 0 from point {} to point {}, {:.4g} m along the path, so the car "
               "would "
               "never arrive; {}give speeds above 0, or set speeds: mission",
               first + 1, last + 1, extent,
               extent > kToAndFro * noise
                   ? fmt::format("if the car stands there and its positions are noisy, set "
                                 "max_deviation: {:.2g}; otherwise ",
                                 1.05 * noise)
                   : "")});
    }
  }
  return problems;
}

std::optional<double> FileStartSpeed(const FittedPath& fitted) {
  if (fitted.given.speed.empty()) {
    return std::nullopt;
  }
  const std::vector<Standstill> standstills = FindStandstills(fitted);
  const bool stands = !standstills.empty() &&
                      fitted.stations[standstills.front().first] <= fitted.options.max_deviation;
  return stands ? 0.0 : fitted.given.speed.front();
}

void FollowFileSpeeds(Plan& plan, const FittedPath& fitted, double start_speed) {
  const std::vector<SpeedCap> caps = CapsOf(fitted);
  plan.caps.insert(plan.caps.end(), caps.begin(), caps.end());
  const std::vector<double> stops = AddStops(plan, fitted, start_speed);
  plan.notes = SpeedNotes(fitted, stops, plan.waits);
}

}  // namespace trackbed
