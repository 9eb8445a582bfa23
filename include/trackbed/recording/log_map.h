#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/geometry/pose.h"
#include "trackbed/options/key_visitor.h"

/// How to read the log of a real vehicle: names of columns, units, frames, filters. The strict
/// reader of YAML files is ReadLogMap (scenario/record.h).
namespace trackbed {

/// The kinds of quantities in a log, each with its set of units.
enum class LogQuantity { kAngle, kSpeed, kYawRate, kSteeringAngle, kThrottle };

/// The names of the units of a quantity, the SI unit first: "rad", "deg".
Names UnitsOf(LogQuantity quantity);

/// The SI value of one unit, such as pi/180 for "deg". InternalError for an unknown unit.
double UnitInSi(const std::string& unit);

/// One column of a log. The value of a column is curve(scale * number in SI units + offset),
/// measured `delay` before it was logged.
struct LogColumn {
  std::string column;
  /// File that contains the column, in the same folder as the log; nullopt: the log itself.
  std::optional<std::string> file{};
  std::string unit;
  double scale = 1.0;
  double offset = 0.0;  ///< Offset in the SI unit.
  /// Calibration curve, linear between its points and constant beyond them; empty: no calibration.
  std::vector<Vec2> curve{};
  double delay = 0.0;  ///< Time between measurement and logging [s].
  /// Update period of a slower control loop, whose values are repeated in several rows [s]. The
  /// value is interpolated linearly between the updates; without a period, between rows.
  std::optional<double> period{};
};

/// A column of the given quantity, with its units.
template <LogQuantity quantity>
struct LogColumnOf : LogColumn {
  LogColumnOf() { unit = UnitsOf(quantity).front(); }
};

/// The columns that contain the time of each row.
struct LogTime {
  std::string column;
  std::string unit = "s";
  /// Column of nanoseconds to add to the time, for ROS time stamps.
  std::optional<std::string> nanoseconds{};
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
  /// x east, y north, z up. All angles and rates are positive to the left.
  kEnu,
  /// x north, y east, z down. All angles and rates are positive to the right.
  kNed,
};

/// The pose X_VS of the measured point and its axes in the vehicle frame V.
struct LogSensor {
  double x = 0.0;    ///< Position ahead of the rear axle [m].
  double y = 0.0;    ///< Position to the left of the rear axle's center [m].
  double yaw = 0.0;  ///< Yaw of the axes [rad].
};

/// An accelerometer whose axes are parallel to those of the vehicle. The accelerometer's readings
/// are transferred to the rear axle by the yaw rate and its derivative; the influence of gravity
/// through roll and pitch is not removed.
struct LogAccelerometer {
  std::string x;
  std::string y;
  std::optional<std::string> file{};
  std::string unit = "m/s^2";
  double delay = 0.0;  ///< Time between measurement and logging [s].
  double ahead = 0.0;  ///< Position ahead of the rear axle [m].
  double left = 0.0;   ///< Position to the left of the vehicle's middle [m].
};

/// A row is used only if the number in the column meets the condition.
struct LogCondition {
  std::string column;
  std::optional<double> equals{};
  std::optional<double> min{};
  std::optional<double> max{};
};

/// The time grid, and the local polynomials that give values and derivatives at its points.
struct LogResample {
  double rate = 100.0;      ///< Samples per second [1/s].
  double half_width = 0.1;  ///< Half width of the polynomials' window [s].
  int degree = 2;           ///< Degree of the polynomials.
};

struct LogMap {
  std::string name;  ///< Name of the map, used in RecordedDrive::notes.
  LogDelimiter delimiter = LogDelimiter::kComma;
  LogTime time;
  LogPosition position;
  /// Yaw; cannot be combined with `orientation`.
  std::optional<LogColumnOf<LogQuantity::kAngle>> yaw{};
  std::optional<LogOrientation> orientation{};
  LogFrame frame = LogFrame::kEnu;
  LogSensor sensor{};
  /// Measured speed, which replaces the speed computed from the position.
  std::optional<LogColumnOf<LogQuantity::kSpeed>> speed{};
  /// Measured yaw rate, which replaces the yaw rate computed from the yaw.
  std::optional<LogColumnOf<LogQuantity::kYawRate>> yaw_rate{};
  /// Measured accelerations, which replace the accelerations computed from the position.
  std::optional<LogAccelerometer> accelerometer{};
  std::optional<LogColumnOf<LogQuantity::kSteeringAngle>> steering{};
  std::optional<LogColumnOf<LogQuantity::kSteeringAngle>> steering_command{};
  std::optional<LogColumnOf<LogQuantity::kThrottle>> throttle{};
  std::vector<LogCondition> valid{};
  LogResample resample{};
  double gap = 0.2;            ///< Longest time between rows that is interpolated [s].
  double from = 0.0;           ///< Start time since the log's first row [s].
  std::optional<double> to{};  ///< End time since the log's first row [s].
  double trim = 0.0;           ///< Time removed at both ends [s].
  bool check = true;           ///< Whether to reject columns that contradict each other.
};

void Visit(KeyVisitor& keys, LogMap& map);

/// Problems that concern more than one key, as pairs of the key to change and the message.
std::vector<std::pair<std::string, std::string>> LogMapProblems(const LogMap& map);

}  // namespace trackbed
