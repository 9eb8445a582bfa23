#include "src/recording/time_unit.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "trackbed/core/angle.h"
#include "trackbed/core/csv_columns.h"
#include "trackbed/core/csv_rows.h"
#include "trackbed/core/error.h"
#include "trackbed/geometry/pose.h"

namespace trackbed {
namespace {

/// Returns the mean speed of a log, in meters per unit of the log's times.
double MeanSpeed(const std::filesystem::path& log, const LogMap& map) {
  const bool is_globe = map.position.latitude.has_value();
  const std::string& x = is_globe ? *map.position.longitude : map.position.x;
  const std::string& y = is_globe ? *map.position.latitude : map.position.y;
  constexpr double kDegree = 111.2e3;  // Length of a degree of latitude [m].
  bool is_first = true;
  Vec2 last(0.0, 0.0);
  double first_time = 0.0;
  double last_time = 0.0;
  double length = 0.0;
  ReadCsvColumns(log, {map.time.column, x, y}, kFindDelimiter, map.time.column,
                 [&](const std::vector<double>& numbers, int /*line*/) {
                   if (!std::all_of(numbers.begin(), numbers.end(),
                                    [](double n) { return std::isfinite(n); })) {
                     return;
                   }
                   const Vec2 scale =
                       is_globe ? Vec2(kDegree * std::cos(numbers[2] * kPi / 180.0), kDegree)
                                : Vec2(Vec2::Constant(UnitInSi(map.position.unit.value_or("m"))));
                   const Vec2 place = scale.cwiseProduct(Vec2(numbers[1], numbers[2]));
                   length += is_first ? 0.0 : (place - last).norm();
                   first_time = is_first ? numbers[0] : first_time;
                   last_time = numbers[0];
                   last = place;
                   is_first = false;
                 });
  return last_time > first_time ? length / (last_time - first_time) : 0.0;
}

/// Returns whether cells of a column of times are no numbers, but timestamps.
bool HasTimestamps(const std::filesystem::path& log, const std::string& column) {
  try {
    ReadCsvColumns(log, {column}, kFindDelimiter, "",
                   [](const std::vector<double>& /*numbers*/, int /*line*/) {});
    return false;
  } catch (const InputError&) {
    return true;
  }
}

}  // namespace

std::string TimeUnitOf(const std::filesystem::path& log, const LogMap& map, double step) {
  constexpr double kLongestStep = 33.0;  // [s]
  constexpr double kLeastSpeed = 0.1;    // [m/s]
  constexpr double kMostSpeed = 100.0;   // [m/s]
  if (step <= 1.0 || HasTimestamps(log, map.time.column)) {
    return "s";
  }
  const double speed = MeanSpeed(log, map);
  for (const char* unit : {"s", "ms", "us", "ns"}) {
    const double own = speed / UnitInSi(unit);
    if (step * UnitInSi(unit) <= kLongestStep && own >= kLeastSpeed && own <= kMostSpeed) {
      return unit;
    }
  }
  return "s";
}

}  // namespace trackbed
