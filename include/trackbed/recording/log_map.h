#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/geometry/pose.h"
#include "trackbed/options/key_visitor.h"

/// How to read the log of a real vehicle: names of columns, units, frames, filters. The strict
/// reader of YAML files is ReadLogMap (scenario/log_map_file.h).
namespace trackbed {

/// The kinds of quantities in a log; each has separate units.
enum class LogQuantity { kAngle, kSpeed, kYawRate, kSteeringAngle, kThrottle };

/// The names of the units of a quantity, the SI unit first: "rad", "deg".
Names UnitsOf(LogQuantity quantity);

/// The SI value of one unit, such as pi/180 for "deg". InternalError for an unknown unit.
double UnitInSi(const std::string& unit);

/// One column: the value is curve(scale * number in SI units + offset), measured `delay` before it
/// was logged.
struct LogColumn {
  std::string column;
  std::optional<std::string> file{};  ///< in the same folder as the log; none: the log itself
  std::string unit;
  double scale = 1.0;
  double offset = 0.0;        ///< in the SI unit
  std::vector<Vec2> curve{};  ///< linear between points, constant beyond; empty: none
  double delay = 0.0;         ///< [s]
  /// Period of the slower loop whose values the rows repeat [s]: the value is linear between
  /// updates of that loop. None: linear between rows.
  std::optional<double> period{};
};

/// A column of the given quantity, with its units.
template <LogQuantity quantity>
struct LogColumnOf : LogColumn {
  LogColumnOf() { unit = UnitsOf(quantity).front(); }
};

/// The times of the rows.
struct LogTime {
  std::string column;
  std::string unit = "s";
  std::optional<std::string> nanoseconds{};  ///< a column to be added, for ROS stamps
};

struct LogPosition {
  std::string x;
  std::string y;
  std::string unit = "m";
};

/// The columns of a unit quaternion, from which the yaw is computed.
struct LogOrientation {
  std::string x;
  std::string y;
  std::string z;
  std::string w;
};

enum class LogDelimiter { kComma, kSemicolon, kTab };

enum class LogFrame {
  kEnu,  ///< x east, y north, z up: all angles and rates positive to the left
  kNed,  ///< x north, y east, z down: all angles and rates positive to the right
};

/// X_VS: the pose of the measured point and its axes in the vehicle frame V.
struct LogSensor {
  double x = 0.0;    ///< ahead of the rear axle [m]
  double y = 0.0;    ///< to its left [m]
  double yaw = 0.0;  ///< [rad]
};

/// An accelerometer along the axes of the vehicle. Its readings are transferred to the rear axle by
/// the yaw rate and its derivative; gravity due to roll and pitch is not removed.
struct LogAccelerometer {
  std::string x;
  std::string y;
  std::optional<std::string> file{};
  std::string unit = "m/s^2";
  double delay = 0.0;  ///< [s]
  double ahead = 0.0;  ///< of the rear axle [m]
  double left = 0.0;   ///< of the vehicle's middle [m]
};

/// A row is used only if the number in the column meets the condition.
struct LogCondition {
  std::string column;
  std::optional<double> equals{};
  std::optional<double> min{};
  std::optional<double> max{};
};

/// The time grid, and the local polynomials that give values and derivatives there.
struct LogResample {
  double rate = 100.0;      ///< [1/s]
  double half_width = 0.1;  ///< of the polynomials' window [s]
  int degree = 2;           ///< of the polynomials
};

struct LogMap {
  std::string name;  ///< used in RecordedDrive::notes
  LogDelimiter delimiter = LogDelimiter::kComma;
  LogTime time;
  LogPosition position;
  std::optional<LogColumnOf<LogQuantity::kAngle>> yaw{};  ///< either this or `orientation`
  std::optional<LogOrientation> orientation{};
  LogFrame frame = LogFrame::kEnu;
  LogSensor sensor{};
  std::optional<LogColumnOf<LogQuantity::kSpeed>> speed{};       ///< instead of the position's
  std::optional<LogColumnOf<LogQuantity::kYawRate>> yaw_rate{};  ///< instead of the yaw's
  std::optional<LogAccelerometer> accelerometer{};               ///< instead of the position's
  std::optional<LogColumnOf<LogQuantity::kSteeringAngle>> steering{};
  std::optional<LogColumnOf<LogQuantity::kSteeringAngle>> steering_command{};
  std::optional<LogColumnOf<LogQuantity::kThrottle>> throttle{};
  std::vector<LogCondition> valid{};
  LogResample resample{};
  double gap = 0.2;            ///< longest time between rows that is interpolated [s]
  double from = 0.0;           ///< start, since the log's first row [s]
  std::optional<double> to{};  ///< end, since the log's first row [s]
  double trim = 0.0;           ///< removed at both ends [s]
  bool check = true;           ///< reject columns that contradict each other
};

void Visit(KeyVisitor& keys, LogMap& map);

/// Problems that concern more than one key, as pairs of the key to change and the message.
std::vector<std::pair<std::string, std::string>> LogMapProblems(const LogMap& map);

}  // namespace trackbed
