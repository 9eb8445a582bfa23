#include "trackbed/recording/log_map.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "src/recording/log_source.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/path_files/globe.h"
#include "trackbed/path_files/globe_names.h"

// Keys of a log map, which names the columns of a log, their units and their frames.
// 1. kUnits converts units to SI; UnitsOf lists the units that a quantity may have.
// 2. Visit declares the keys with ranges and descriptions, for the reader and the reference.
// 3. LogMapProblems checks conditions that involve several keys, such as two sources of the
//    position.
namespace trackbed {
namespace {

struct Unit {
  const char* name;
  double si;
};

constexpr std::array kUnits{
    Unit{"1", 1.0},       Unit{"rad", 1.0},   Unit{"deg", kPi / 180.0},   Unit{"m", 1.0},
    Unit{"cm", 0.01},     Unit{"mm", 0.001},  Unit{"m/s", 1.0},           Unit{"km/h", 1.0 / 3.6},
    Unit{"mph", 0.44704}, Unit{"rad/s", 1.0}, Unit{"deg/s", kPi / 180.0}, Unit{"m/s^2", 1.0},
    Unit{"g", 9.80665},   Unit{"s", 1.0},     Unit{"ms", 1e-3},           Unit{"us", 1e-6},
    Unit{"ns", 1e-9},
};

void VisitColumn(KeyVisitor& keys, LogColumn& column, const Names& units) {
  keys.Field({"column", "", "name of the column"}, column.column, Need::kRequired);
  keys.Field({"file", "",
              "CSV file beside the log that has it, with the time in columns of the "
              "same names; default: the log"},
             column.file);
  keys.Field({"unit", "", "unit of its numbers; 1: a normalized command"}, column.unit,
             Need::kRequired, units);
  keys.Field({"scale", "", "factor on the numbers; -1 turns their sign"}, column.scale,
             Need::kOptional);
  keys.Field({"offset", "", "added after that, in the SI unit"}, column.offset, Need::kOptional);
  static const PairShape shape{"a pair [number, value]", "pairs [number, value]", {}, {}};
  keys.Field({"curve", "",
              "the value over the number after scale and offset, in the SI unit: linear between "
              "pairs, held beyond"},
             column.curve, Need::kOptional, shape);
  keys.Field({"delay", "s", "how long before its row it was measured or sent"}, column.delay,
             Need::kOptional, Range{.min = -10.0, .max = 10.0});
  keys.Field({"period", "s",
              "of the slower loop whose values the rows repeat; the value is then linear from one "
              "of its updates to the next, not held"},
             column.period, Range{.max = 10.0, .above = 0.0});
}

}  // namespace

Names UnitsOf(LogQuantity quantity) {
  switch (quantity) {
    case LogQuantity::kAngle:
      return {"rad", "deg"};
    case LogQuantity::kSpeed:
      return {"m/s", "km/h", "mph"};
    case LogQuantity::kYawRate:
      return {"rad/s", "deg/s"};
    case LogQuantity::kSteeringAngle:
      return {"rad", "deg", "1"};
    case LogQuantity::kThrottle:
      return {"m/s^2", "g", "1"};
  }
  return {};
}

double UnitInSi(const std::string& unit) {
  const auto* found =
      std::find_if(kUnits.begin(), kUnits.end(), [&](const Unit& own) { return unit == own.name; });
  TRACKBED_CHECK(found != kUnits.end(), "no unit '{}'", unit);
  return found->si;
}

template <LogQuantity quantity>
void Visit(KeyVisitor& keys, LogColumnOf<quantity>& column) {
  VisitColumn(keys, column, UnitsOf(quantity));
}

void Visit(KeyVisitor& keys, LogTime& time) {
  keys.Field({"column", "", "name of the column"}, time.column, Need::kRequired);
  keys.Field({"unit", "", "unit of its numbers; they may count from any moment"}, time.unit,
             Need::kOptional, Names{"s", "ms", "us", "ns"});
  keys.Field({"nanoseconds", "", "column of nanoseconds to be added, as in stamps of ROS"},
             time.nanoseconds);
}

void Visit(KeyVisitor& keys, LogPosition& position) {
  keys.Field({"x", "", "name of the column; east, or north with frame: ned"}, position.x,
             Need::kOptional);
  keys.Field({"y", "", "name of the column; north, or east with frame: ned"}, position.y,
             Need::kOptional);
  keys.Field({"latitude", "", "name of the column (WGS 84), instead of x and y"},
             position.latitude);
  keys.Field({"longitude", "", "name of the column (WGS 84), instead of x and y"},
             position.longitude);
  keys.Field(
      {"unit", "",
       "unit of the numbers: m, cm or mm; of latitude and longitude deg or rad; default: m or "
       "deg"},
      position.unit);
  keys.Field(
      {"origin_latitude", "deg", "origin of the projection of WGS 84; default: the first row"},
      position.origin_latitude, Range{.min = -89.0, .max = 89.0});
  keys.Field(
      {"origin_longitude", "deg", "origin of the projection of WGS 84; default: the first row"},
      position.origin_longitude, Range{.min = -180.0, .max = 180.0});
}

void Visit(KeyVisitor& keys, LogOrientation& orientation) {
  keys.Field({"x", "", "name of the column"}, orientation.x, Need::kRequired);
  keys.Field({"y", "", "name of the column"}, orientation.y, Need::kRequired);
  keys.Field({"z", "", "name of the column"}, orientation.z, Need::kRequired);
  keys.Field({"w", "", "name of the column"}, orientation.w, Need::kRequired);
}

void Visit(KeyVisitor& keys, LogSensor& sensor) {
  const Range near{.min = -100.0, .max = 100.0};
  keys.Field({"x", "m", "ahead of the rear axle"}, sensor.x, Need::kOptional, near);
  keys.Field({"y", "m", "to the left of the vehicle's middle"}, sensor.y, Need::kOptional, near);
  keys.Field({"yaw", "rad", "by how much its axes are turned to the left against the vehicle's"},
             sensor.yaw, Need::kOptional, kDirection);
}

void Visit(KeyVisitor& keys, LogAccelerometer& sensor) {
  keys.Field({"x", "", "column of the acceleration forward, without gravity"}, sensor.x,
             Need::kRequired);
  keys.Field({"y", "", "column of that to the left, or to the right with frame: ned"}, sensor.y,
             Need::kRequired);
  keys.Field({"file", "", "as of other columns"}, sensor.file);
  keys.Field({"unit", "", "unit of the numbers"}, sensor.unit, Need::kRequired,
             Names{"m/s^2", "g"});
  keys.Field({"delay", "s", "as of other columns"}, sensor.delay, Need::kOptional,
             Range{.min = -10.0, .max = 10.0});
  const Range near{.min = -100.0, .max = 100.0};
  keys.Field({"ahead", "m", "where it is, ahead of the rear axle"}, sensor.ahead, Need::kOptional,
             near);
  keys.Field({"left", "m", "where it is, to the left"}, sensor.left, Need::kOptional, near);
}

void Visit(KeyVisitor& keys, LogCondition& condition) {
  keys.Field({"column", "", "name of a column of the log"}, condition.column, Need::kRequired);
  keys.Field({"equals", "", "the number that it must be"}, condition.equals);
  keys.Field({"min", "", "the least that it must be"}, condition.min);
  keys.Field({"max", "", "the most that it may be"}, condition.max);
}

void Visit(KeyVisitor& keys, LogResample& resample) {
  keys.Field({"rate", "1/s", "samples per second"}, resample.rate, Need::kOptional,
             Range{.min = 1.0, .max = 1e4});
  keys.Field({"half_width", "s",
              "rows up to this far before and after a sample shape the polynomial there; more "
              "smooths more"},
             resample.half_width, Need::kOptional, Range{.min = 1e-4, .max = 10.0});
  keys.Field({"degree", "", "of the polynomials in time"}, resample.degree, Need::kOptional,
             Range{.min = 2, .max = 5});
}

void Visit(KeyVisitor& keys, LogMap& map) {
  int schema = 1;
  keys.Field({"schema", "", "version of this format"}, schema, Need::kRequired,
             Range{.min = 1, .max = 1});
  keys.Identifier({"name", "", "name of the map, in notes"}, map.name);
  static const EnumNames<LogDelimiter> delimiters{{LogDelimiter::kAuto, "auto"},
                                                  {LogDelimiter::kComma, "comma"},
                                                  {LogDelimiter::kSemicolon, "semicolon"},
                                                  {LogDelimiter::kTab, "tab"}};
  keys.Field({"delimiter", "",
              "what separates cells; auto: the most frequent of comma, semicolon and tab in the "
              "first line that is not a comment"},
             map.delimiter, Need::kOptional, delimiters);
  keys.Section({"time", "", "when rows were logged"}, map.time, Need::kRequired);
  keys.Section({"position", "", "where the measured point is"}, map.position, Need::kRequired);
  keys.Section({"yaw", "", "heading of the measured axes; this or orientation"}, map.yaw);
  keys.Section(
      {"orientation", "", "unit quaternion of the measured axes, of which the yaw is taken"},
      map.orientation);
  keys.Field({"heading_from_motion", "",
              "take the yaw from the direction of motion, for logs without a heading such as GPS "
              "tracks; the car must not drive in reverse"},
             map.heading_from_motion, Need::kOptional);
  static const EnumNames<LogFrame> frames{{LogFrame::kEnu, "enu"}, {LogFrame::kNed, "ned"}};
  keys.Field({"frame", "",
              "enu: x east, y north, angles and rates positive to the left; ned: x north, y east, "
              "angles, rates and steering positive to the right"},
             map.frame, Need::kOptional, frames);
  keys.Section({"sensor", "", "the measured point and its axes in the vehicle"}, map.sensor);
  keys.Section({"speed", "",
                "measured speed of the rear axle, forward positive; default: that of the position"},
               map.speed);
  keys.Section({"yaw_rate", "", "measured yaw rate; default: that of the yaw"}, map.yaw_rate);
  keys.Section({"accelerometer", "", "measured accelerations; default: those of the position"},
               map.accelerometer);
  keys.Section({"steering", "", "measured bicycle angle of the road wheels"}, map.steering);
  keys.Section({"steering_command", "", "command to the steering actuator, as the model takes it"},
               map.steering_command);
  keys.Section({"throttle", "", "command of the drive, as the acceleration that it asks for"},
               map.throttle);
  keys.List({"valid", "", "rows count only if all of these hold"}, map.valid);
  keys.Section({"resample", "", "the uniform time grid, and how values get there"}, map.resample);
  keys.Field({"gap", "s", "longest time between rows that is bridged; more is a gap"}, map.gap,
             Need::kOptional, Range{.max = 100.0, .above = 0.0});
  keys.Field({"from", "s", "what is before is left out; since the first row of the log"}, map.from,
             Need::kOptional, kNonNegative);
  keys.Field({"to", "s", "what is after is left out; since the first row of the log"}, map.to,
             kPositive);
  keys.Field({"trim", "s", "left out at either end, where filters are one-sided"}, map.trim,
             Need::kOptional, kNonNegative);
  keys.Field({"check", "",
              "refuse columns that contradict each other, such as degrees that are read as "
              "radians; false: only say so"},
             map.check, Need::kOptional);
  keys.Field(
      {"align", "",
       "shift speed, yaw rate and accelerations by their delay behind the motion of the pose "
       "(--align); false: only say how large it is"},
      map.align, Need::kOptional);
}

namespace {

using MapProblems = std::vector<std::pair<std::string, std::string>>;

/// Requires exactly one pair of position columns, and rejects columns of degrees as x and y.
void AddPositionProblems(const LogPosition& position, MapProblems& found) {
  const bool has_globe = position.latitude || position.longitude;
  const bool has_plane = !position.x.empty() || !position.y.empty();
  if (has_globe && has_plane) {
    found.emplace_back("position", "give either x and y or latitude and longitude");
    return;
  }
  if (has_globe ? !position.latitude || !position.longitude
                : position.x.empty() || position.y.empty()) {
    found.emplace_back(has_globe ? (position.latitude ? "position.longitude" : "position.latitude")
                                 : (position.x.empty() ? "position.x" : "position.y"),
                       "missing; give x and y, or latitude and longitude");
    return;
  }
  const Names units = has_globe ? Names{"deg", "rad"} : Names{"m", "cm", "mm"};
  if (position.unit && std::find(units.begin(), units.end(), *position.unit) == units.end()) {
    found.emplace_back(
        "position.unit",
        fmt::format("'{}' is not a unit of {}; allowed: {}", *position.unit,
                    has_globe ? "latitude and longitude" : "x and y", fmt::join(units, ", ")));
  }
  for (const auto& [key, name] :
       {std::pair("position.x", &position.x), std::pair("position.y", &position.y)}) {
    if (!has_globe && NamesGlobeAxis(FieldOfColumn(*name))) {
      found.emplace_back(
          key, fmt::format("'{0}' is in degrees, which are not meters: name it by "
                           "position.latitude or position.longitude; if it is in meters, rename "
                           "the column to {0}_m",
                           *name));
    }
  }
  for (const auto& [key, name, axis] :
       {std::tuple("position.latitude", &position.latitude, GlobeAxis::kLatitude),
        std::tuple("position.longitude", &position.longitude, GlobeAxis::kLongitude)}) {
    const auto meaning = *name ? GlobeColumnOf(FieldOfColumn(**name)) : std::nullopt;
    if (meaning && meaning->axis != axis) {
      found.emplace_back(key, fmt::format("'{}' is the other coordinate by its name: swap "
                                          "position.latitude and position.longitude",
                                          **name));
    }
  }
  if (position.origin_latitude.has_value() != position.origin_longitude.has_value()) {
    found.emplace_back(
        position.origin_latitude ? "position.origin_longitude" : "position.origin_latitude",
        "missing; give both coordinates of the origin or none");
  }
}

}  // namespace

std::vector<std::pair<std::string, std::string>> LogMapProblems(const LogMap& map) {
  std::vector<std::pair<std::string, std::string>> found;
  AddPositionProblems(map.position, found);
  if (map.heading_from_motion && (map.yaw || map.orientation)) {
    found.emplace_back("heading_from_motion", "not allowed with yaw or orientation");
  } else if (!map.heading_from_motion && map.yaw.has_value() == map.orientation.has_value()) {
    found.emplace_back("yaw",
                       map.yaw ? "give either yaw or orientation"
                               : "give either yaw or orientation, or heading_from_motion: true if "
                                 "the log has no heading");
  }
  if (map.yaw && map.yaw->file) {
    found.emplace_back("yaw.file", "not allowed: position and yaw are columns of the log itself");
  }
  if (map.yaw && (map.yaw->delay != 0.0 || map.yaw->period)) {
    found.emplace_back("yaw", "delay and period are not allowed: the yaw is that of its row");
  }
  if (map.to && *map.to <= map.from) {
    found.emplace_back("to", fmt::format("{} s is not above from, {} s", *map.to, map.from));
  }
  for (std::size_t i = 0; i < map.valid.size(); ++i) {
    const LogCondition& condition = map.valid[i];
    if (!condition.equals && !condition.min && !condition.max) {
      found.emplace_back(fmt::format("valid[{}]", i), "give equals, min or max");
    }
  }
  const auto check = [&](const char* key, const auto& column) {
    if (!column) {
      return;
    }
    const std::vector<Vec2>& curve = column->curve;
    const std::string own = std::string(key) + ".curve";
    if (curve.size() == 1) {
      found.emplace_back(own, "one pair given; must be at least two");
    }
    for (std::size_t i = 1; i < curve.size(); ++i) {
      if (curve[i].x() <= curve[i - 1].x()) {
        found.emplace_back(
            fmt::format("{}[{}]", own, i),
            fmt::format("{} must be above the previous {}", curve[i].x(), curve[i - 1].x()));
      }
    }
  };
  check("yaw", map.yaw);
  check("speed", map.speed);
  check("yaw_rate", map.yaw_rate);
  check("steering", map.steering);
  check("steering_command", map.steering_command);
  check("throttle", map.throttle);
  return found;
}

}  // namespace trackbed
