#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/geometry/pose.h"
#include "trackbed/options/key_visitor.h"

/// How to read the log of a real vehicle: names of columns, units, coordinate frames, filters.
/// ReadLogMap (scenario/record.h) reads a log map from a YAML file.
namespace trackbed {

/// The kinds of quantities in a log; each kind has a set of allowed units.
enum class LogQuantity { kAngle, kSpeed, kYawRate, kSteeringAngle, kThrottle };

/// Returns the names of the units of a quantity, with the SI unit first; for angles "rad", "deg".
Names UnitsOf(LogQuantity quantity);

/// Returns the size of a unit in SI units, such as pi/180 for "deg". Throws InternalError if the
/// unit is unknown.
double UnitInSi(const std::string& unit);

/// How to read one column of a log. The measured value is curve(scale * x + offset), where x is the
/// number in the column, converted to SI units. Each value was measured `delay` seconds before the
/// value was logged.
struct LogColumn {
  std::string column;
  /// File that contains the column, in the same folder as the log; nullopt: the log itself contains
  /// the column.
  std::optional<std::string> file{};
  std::string unit;
  double scale = 1.0;
  double offset = 0.0;  ///< Offset that is added to the scaled number, in the SI unit.
  /// Calibration curve, linear between its points and constant beyond the first and last point;
  /// empty: no calibration.
  std::vector<Vec2> curve{};
  double delay = 0.0;  ///< Delay between measurement and logging of a value [s].
  /// Update period of the values, if a slower control loop repeats each value in several rows [s].
  /// Values are interpolated linearly between the updates of the control loop; without a given
  /// update period, between rows.
  std::optional<double> period{};
};

/// A column of the given quantity; the quantity determines the allowed units.
template <LogQuantity quantity>
struct LogColumnOf : LogColumn {
  LogColumnOf() { unit = UnitsOf(quantity).front(); }
};

/// The columns that contain the time of each row of the log.
struct LogTime {
  std::string column;
  std::string unit = "s";
  /// Column with nanoseconds that are added to the time, for ROS time stamps.
  std::optional<std::string> nanoseconds{};
};

/// The columns of a log that contain the position: x and y in a plane, or latitude and longitude in
/// WGS 84.
struct LogPosition {
  std::string x{};
  std::string y{};
  std::optional<std::string> latitude{};
  std::optional<std::string> longitude{};
  /// Unit of x and y: "m", "cm" or "mm", by default "m". Unit of latitude and longitude: "deg" or
  /// "rad", by default "deg".
  std::optional<std::string> unit{};
  /// Latitude of the drive's coordinate origin [deg]; default: the latitude in the first row.
  std::optional<double> origin_latitude{};
  /// Longitude of the drive's coordinate origin [deg]; default: the longitude in the first row.
  std::optional<double> origin_longitude{};
};

/// The columns of a unit quaternion, from which the yaw is computed.
struct LogOrientation {
  std::string x;
  std::string y;
  std::string z;
  std::string w;
};

enum class LogDelimiter {
  kAuto,  ///< The most frequent of comma, semicolon and tab in the file's first line.
  kComma,
  kSemicolon,
  kTab,
};

enum class LogFrame {
  /// World axes are x east, y north, z up; all angles and rates are positive to the left.
  kEnu,
  /// World axes are x north, y east, z down; all angles and rates are positive to the right.
  kNed,
};

/// The pose X_VS of the sensor in the vehicle frame V: the measured point and the sensor's axes.
struct LogSensor {
  double x = 0.0;    ///< Distance of the sensor in front of the rear axle [m].
  double y = 0.0;    ///< Distance of the sensor to the left of the rear axle's center [m].
  double yaw = 0.0;  ///< Yaw of the sensor's axes relative to the vehicle [rad].
};

/// An accelerometer in the vehicle; the axes of the accelerometer are parallel to the axes of the
/// vehicle. The yaw rate and its derivative serve to convert the measured accelerations to
/// accelerations of the rear axle. When the car rolls or pitches, gravity contributes to the
/// measured accelerations; ImportLog does not remove this effect.
struct LogAccelerometer {
  std::string x;
  std::string y;
  std::optional<std::string> file{};
  std::string unit = "m/s^2";
  double delay = 0.0;  ///< Delay between measurement and logging of a value [s].
  double ahead = 0.0;  ///< Distance of the sensor in front of the rear axle [m].
  double left = 0.0;   ///< Distance of the accelerometer to the left of the vehicle's middle [m].
};

/// A condition on the number in a column; rows of the log that do not meet the condition are not
/// used.
struct LogCondition {
  std::string column;
  std::optional<double> equals{};
  std::optional<double> min{};
  std::optional<double> max{};
};

/// The time grid of the recorded drive, and the local polynomials that yield values and derivatives
/// at the points of the grid.
struct LogResample {
  double rate = 100.0;  ///< Number of samples per second [1/s].
  /// Time before and after a point of the grid from which rows are used for the local polynomial
  /// [s].
  double half_width = 0.1;
  int degree = 2;  ///< Degree of the local polynomials.
};

struct LogMap {
  std::string name;  ///< Name of the log map, which appears in RecordedDrive::notes.
  LogDelimiter delimiter = LogDelimiter::kAuto;
  LogTime time;
  LogPosition position;
  /// Column with the measured yaw; cannot be combined with `orientation`.
  std::optional<LogColumnOf<LogQuantity::kAngle>> yaw{};
  std::optional<LogOrientation> orientation{};
  /// Whether the yaw is the direction of motion of the measured point, for logs without a heading
  /// such as GPS tracks. Without measured headings, a car in reverse is read as a car that has
  /// turned around.
  bool heading_from_motion = false;
  LogFrame frame = LogFrame::kEnu;
  LogSensor sensor{};
  /// Column with the measured speed, which replaces the speed computed from the position.
  std::optional<LogColumnOf<LogQuantity::kSpeed>> speed{};
  /// Column with the measured yaw rate, which replaces the yaw rate computed from the yaw.
  std::optional<LogColumnOf<LogQuantity::kYawRate>> yaw_rate{};
  /// Columns with measured accelerations, which replace the accelerations computed from the
  /// position.
  std::optional<LogAccelerometer> accelerometer{};
  std::optional<LogColumnOf<LogQuantity::kSteeringAngle>> steering{};
  std::optional<LogColumnOf<LogQuantity::kSteeringAngle>> steering_command{};
  std::optional<LogColumnOf<LogQuantity::kThrottle>> throttle{};
  std::vector<LogCondition> valid{};
  LogResample resample{};
  /// Maximum time between two rows over which values are interpolated [s].
  double gap = 0.2;
  /// Start of the used part of the log, as time since the log's first row [s].
  double from = 0.0;
  /// End of the used part of the log, as time since the log's first row [s].
  std::optional<double> to{};
  double trim = 0.0;  ///< Time that is removed at both ends of the recorded drive [s].
  bool check = true;  ///< Whether to reject a log whose columns contradict each other.
  /// Whether to shift the measured speed, yaw rate and accelerations by their delay behind the
  /// motion of the pose.
  bool align = false;
};

void Visit(KeyVisitor& keys, LogMap& map);

/// Returns the problems of a log map (description of a log's columns) that concern several of its
/// keys together. Each returned pair contains the key that the user should change and the error
/// message.
std::vector<std::pair<std::string, std::string>> LogMapProblems(const LogMap& map);

}  // namespace trackbed
