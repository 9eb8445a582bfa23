#include "trackbed/recording/log_listing.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <cctype>

#include "src/recording/log_source.h"
#include "src/recording/time_unit.h"
#include "trackbed/bag/bag.h"
#include "trackbed/bag/message.h"
#include "trackbed/core/csv_columns.h"
#include "trackbed/core/csv_rows.h"
#include "trackbed/core/error.h"
#include "trackbed/path_files/globe_file.h"
#include "trackbed/path_files/globe_names.h"
#include "trackbed/path_files/pose_columns.h"

// Lists a log and proposes a map (log_map.h).
// 1. In CSV files, columns are recognized by the names that path files use, too
//    (FindPoseColumns), and by names that state a unit.
// 2. In bags, topics are recognized by the type of their messages. The position comes from the
//    odometry; without odometry, from a pose; without both, from a satellite fix.
// 3. GPX, KML and GeoJSON files have positions and times.
// 4. FitTo chooses the gap and the width of the polynomials from the median step of the times.
//    TimeUnitOf finds the unit of times whose column states none.
namespace trackbed {
namespace {

namespace fs = std::filesystem;

/// Name of a map for a log: the letters, digits and '_' of the file's name.
std::string MapName(const fs::path& log) {
  std::string name = log.stem().string();
  std::erase_if(name, [](unsigned char c) {
    return c >= 0x80 || (std::isalnum(c) == 0 && c != '_' && c != '-');
  });
  return name.empty() ? "log" : name;
}

/// Sets `gap` and the half width of the polynomials for rows that are `step` seconds apart.
void FitTo(double step, LogMap& map) {
  const LogMap usual;
  if (step > 0.3 * usual.gap) {
    const auto rounded = [](double value) { return std::stod(fmt::format("{:.2g}", value)); };
    map.gap = rounded(3.0 * step);
    map.resample.half_width = std::min(10.0, rounded(1.7 * step));
    map.resample.rate = std::clamp(rounded(10.0 / step), 1.0, usual.resample.rate);
  }
}

double MedianStep(std::vector<double> times) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i] > times[i - 1]) {
      steps.push_back(times[i] - times[i - 1]);
    }
  }
  if (steps.empty()) {
    return 0.0;
  }
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

LogListing ListGlobe(const fs::path& log) {
  const GlobeFile file = ReadGlobeFile(log);
  LogListing listing;
  std::vector<double> times;
  LogTopic topic{.name = {}, .type = file.format, .rows = 0, .columns = {}, .problem = {}};
  for (const GlobeLine& line : file.lines) {
    topic.rows += line.points.size();
    for (const GlobePoint& point : line.points) {
      if (point.time) {
        times.push_back(*point.time);
      }
    }
  }
  topic.columns.assign(std::begin(kGlobeColumns), std::end(kGlobeColumns));
  listing.topics.push_back(std::move(topic));
  if (times.size() < 2) {
    const std::size_t rows = listing.topics.front().rows;
    const std::string found =
        times.empty() ? "the file has no times" : fmt::format("1 of {} points has a time", rows);
    listing.problem = rows == 1 ? "1 point; a recording has at least 2"
                                : found +
                                      ", so the file is a path and not a recording: drive the path "
                                      "with plan: {method: path_file}";
    return listing;
  }
  LogMap& map = listing.map.emplace();
  map.name = MapName(log);
  map.time.column = "time";
  map.position.latitude = "latitude";
  map.position.longitude = "longitude";
  map.heading_from_motion = true;
  FitTo(MedianStep(times), map);
  return listing;
}

/// A column of the log, with the unit that the column's name states, in the spelling of log maps.
struct FoundColumn {
  std::string name;
  std::string unit;
};

/// Returns the unit among `units` that `spelling` means, in the spelling of log maps; "" if
/// `spelling` means none of `units`.
std::string UnitIn(const std::string& spelling, const Names& units) {
  static const std::vector<std::pair<const char*, const char*>> kSpellings{
      {"mps", "m/s"},     {"ms", "ms"},       {"ms", "m/s"},      {"kmh", "km/h"},
      {"kph", "km/h"},    {"kmph", "km/h"},   {"dps", "deg/s"},   {"degps", "deg/s"},
      {"radps", "rad/s"}, {"degrees", "deg"}, {"degree", "deg"},  {"\xC2\xB0", "deg"},
      {"sec", "s"},       {"seconds", "s"},   {"unix time", "s"}, {"meters", "m"}};
  const auto is_allowed = [&](const std::string& unit) {
    return std::find(units.begin(), units.end(), unit) != units.end();
  };
  const std::string lower = boost::to_lower_copy(spelling);
  for (const auto& [other, unit] : kSpellings) {
    if (lower == other && is_allowed(unit)) {
      return unit;
    }
  }
  return is_allowed(lower) ? lower : "";
}

/// Returns the column if its name is `wanted`, ignoring case, without or with one of `units`, as in
/// "speed", "speed [km/h]", "speed (km/h)", "speed km/h" and "speed_kmh".
std::optional<FoundColumn> Matches(const std::string& name, const std::string& wanted,
                                   const Names& units) {
  if (boost::iequals(name, wanted)) {
    return FoundColumn{name, ""};
  }
  const bool has_brackets = name.ends_with(']') || name.ends_with(')');
  const std::size_t begin = name.find_last_of(has_brackets ? "[(" : "_ ");
  if (begin == std::string::npos || begin == 0 ||
      !boost::iequals(boost::trim_right_copy(name.substr(0, begin)), wanted)) {
    return std::nullopt;
  }
  const std::size_t end = name.size() - (has_brackets ? 1 : 0);
  const std::string unit = UnitIn(name.substr(begin + 1, end - begin - 1), units);
  return unit.empty() ? std::nullopt : std::optional(FoundColumn{name, unit});
}

/// Returns the first of the wanted names that the log has. A column that states a unit other than
/// `units` is ignored.
std::optional<FoundColumn> AnyOf(const std::vector<std::string>& names, const Names& units,
                                 const std::vector<const char*>& wanted) {
  for (const char* own : wanted) {
    for (const std::string& name : names) {
      if (auto found = Matches(name, own, units)) {
        return found;
      }
    }
  }
  return std::nullopt;
}

/// Sets `column` to the found column, if any. If the column's name states a unit, this unit
/// replaces the default unit.
template <typename Column>
void Take(const std::optional<FoundColumn>& found, std::optional<Column>& column) {
  if (found) {
    column.emplace();
    column->column = found->name;
    if (!found->unit.empty()) {
      column->unit = found->unit;
    }
  }
}

/// Proposes columns for time and position, for a table whose columns have usual names. Returns
/// whether the name of the time's column states its unit.
bool TakePlace(const std::vector<std::string>& names, LogMap& map) {
  bool has_time_unit = false;
  // rostopic echo -p writes nanoseconds in the column %time.
  const Names times{"s", "ms", "us", "ns"};
  if (const auto stamp = AnyOf(names, times, {"%time"})) {
    map.time = {.column = stamp->name, .unit = "ns", .nanoseconds = {}};
    has_time_unit = true;
  } else if (const auto time = AnyOf(names, times,
                                     {"t_s", "t", "time_s", "time", "timestamp_s", "timestamp",
                                      "stamp", "datetime", "utc", "elapsed_time", "device time"})) {
    map.time.column = time->name;
    map.time.unit = time->unit.empty() ? map.time.unit : time->unit;
    has_time_unit = !time->unit.empty() || boost::iends_with(time->name, "_s");
  }
  const Names lengths{"m", "cm", "mm"};
  const auto x = AnyOf(names, lengths,
                       {"x_m", "x", "pos_x", "position_x", "easting", "car coord x", "xcg_tm",
                        "car.tx", "field.pose.pose.position.x", "field.pose.position.x"});
  const auto y = AnyOf(names, lengths,
                       {"y_m", "y", "pos_y", "position_y", "northing", "car coord y", "ycg_tm",
                        "car.ty", "field.pose.pose.position.y", "field.pose.position.y"});
  const GlobeColumns globe = FindGlobeColumns(names);
  if (x && y && x->unit == y->unit) {
    map.position.x = x->name;
    map.position.y = y->name;
    if (!x->unit.empty()) {
      map.position.unit = x->unit;
    }
  } else if (globe.latitude && globe.longitude) {
    map.position.latitude = names[*globe.latitude];
    map.position.longitude = names[*globe.longitude];
  } else if (const PoseColumns pose = FindPoseColumns(names);
             pose.x && pose.y && pose.x->unit == pose.y->unit &&
             std::find(lengths.begin(), lengths.end(), pose.x->unit) != lengths.end()) {
    // Accept the other column names of path files, such as pose_x and pose_y.
    map.position.x = names[pose.x->index];
    map.position.y = names[pose.y->index];
    map.position.unit = pose.x->unit;
    if (pose.yaw) {
      map.yaw.emplace();
      map.yaw->column = names[pose.yaw->index];
      map.yaw->unit = pose.yaw->unit;
    }
  }
  return has_time_unit;
}

LogListing ListCsv(const fs::path& log) {
  LogListing listing;
  LogTopic topic{.name = {}, .type = "CSV", .rows = 0, .columns = {}, .problem = {}};
  topic.columns = ReadCsvNames(log, topic.rows);
  const std::vector<std::string>& names = topic.columns;
  LogMap map;
  map.name = MapName(log);
  const bool has_time_unit = TakePlace(names, map);
  if (!map.position.latitude && !map.yaw) {
    Take(
        AnyOf(names, UnitsOf(LogQuantity::kAngle),
              {"yaw_rad", "yaw", "heading_rad", "psi_rad", "psi", "theta_rad", "theta", "car.yaw"}),
        map.yaw);
  }
  // rostopic echo -p names columns by the fields of the message.
  if (const std::string& x = map.position.x; x.starts_with("field.")) {
    const std::string part = x.substr(0, x.rfind("position.x")) + "orientation.";
    const LogOrientation columns{part + "x", part + "y", part + "z", part + "w"};
    const std::vector<std::string> all{columns.x, columns.y, columns.z, columns.w};
    if (std::all_of(all.begin(), all.end(), [&](const std::string& column) {
          return std::find(names.begin(), names.end(), column) != names.end();
        })) {
      map.orientation = columns;
    }
  }
  map.heading_from_motion = !map.yaw && !map.orientation;
  const Names speeds = UnitsOf(LogQuantity::kSpeed);
  Take(AnyOf(names, speeds,
             {"speed_mps", "vx_mps", "v_mps", "speed", "velocity", "v", "gps speed", "ground speed",
              "vehicle_speed", "car.v", "field.twist.twist.linear.x"}),
       map.speed);
  // Beside vy, vx may be a velocity along the x axis of the world.
  if (!map.speed && !AnyOf(names, speeds, {"vy"})) {
    Take(AnyOf(names, speeds, {"vx"}), map.speed);
  }
  const std::vector<std::string> poses = FindPoseColumns(names).choices;
  listing.topics.push_back(std::move(topic));
  const bool has_position = map.position.latitude || !map.position.x.empty();
  if (map.time.column.empty() || !has_position) {
    listing.problem =
        fmt::format("no column has a usual name for {}{}{}",
                    map.time.column.empty() ? "the time (t_s, time)" : "",
                    map.time.column.empty() && !has_position ? " and " : "",
                    has_position ? "" : "the position (x_m, y_m, latitude, longitude)");
    if (!has_position && !poses.empty()) {
      listing.problem = fmt::format("several columns for x: {}; write a map with one of them",
                                    fmt::join(poses, ", "));
    }
    return listing;
  }
  std::vector<double> times;
  ReadCsvColumns(log, {map.time.column}, kFindDelimiter, map.time.column,
                 [&](const std::vector<double>& numbers, int /*line*/) {
                   constexpr std::size_t kEnough = 10'000;
                   if (times.size() < kEnough) {
                     times.push_back(numbers.front());
                   }
                 });
  const double step = MedianStep(std::move(times));
  if (!has_time_unit) {
    map.time.unit = TimeUnitOf(log, map, step);
  }
  FitTo(step * UnitInSi(map.time.unit), map);
  listing.map = std::move(map);
  return listing;
}

/// Proposes a map for a bag.
class BagProposal {
 public:
  BagProposal(const std::vector<BagTopic>& topics, const fs::path& log) : topics_(topics) {
    map_.name = MapName(log);
    map_.time = {.column = "stamp.sec", .unit = "s", .nanoseconds = "stamp.nanosec"};
  }

  std::optional<LogMap> Make() {
    if (!TakePose("nav_msgs/msg/Odometry", "pose.pose.") &&
        !TakePose("geometry_msgs/msg/PoseStamped", "pose.") &&
        !TakePose("geometry_msgs/msg/PoseWithCovarianceStamped", "pose.pose.") && !TakeFix()) {
      return std::nullopt;
    }
    Take(map_.speed, {{"nav_msgs/msg/Odometry", "twist.twist.linear.x"},
                      {"autoware_vehicle_msgs/msg/VelocityReport", "longitudinal_velocity"},
                      {"autoware_auto_vehicle_msgs/msg/VelocityReport", "longitudinal_velocity"},
                      {"geometry_msgs/msg/TwistStamped", "twist.linear.x"},
                      {"geometry_msgs/msg/TwistWithCovarianceStamped", "twist.twist.linear.x"}});
    Take(map_.yaw_rate, {{"nav_msgs/msg/Odometry", "twist.twist.angular.z"},
                         {"sensor_msgs/msg/Imu", "angular_velocity.z"},
                         {"autoware_vehicle_msgs/msg/VelocityReport", "heading_rate"},
                         {"autoware_auto_vehicle_msgs/msg/VelocityReport", "heading_rate"},
                         {"geometry_msgs/msg/TwistStamped", "twist.angular.z"}});
    Take(map_.steering, {{"autoware_vehicle_msgs/msg/SteeringReport", "steering_tire_angle"},
                         {"autoware_auto_vehicle_msgs/msg/SteeringReport", "steering_tire_angle"}});
    Take(map_.steering_command,
         {{"ackermann_msgs/msg/AckermannDriveStamped", "drive.steering_angle"},
          {"ackermann_msgs/msg/AckermannDrive", "steering_angle"},
          {"autoware_control_msgs/msg/Control", "lateral.steering_tire_angle"},
          {"autoware_auto_control_msgs/msg/AckermannControlCommand",
           "lateral.steering_tire_angle"}});
    Take(map_.throttle,
         {{"autoware_control_msgs/msg/Control", "longitudinal.acceleration"},
          {"autoware_auto_control_msgs/msg/AckermannControlCommand", "longitudinal.acceleration"}});
    return map_;
  }

  [[nodiscard]] const std::string& topic() const { return topic_; }

 private:
  /// Returns the topic with the most messages among the CDR topics of a type that have at least two
  /// messages; null if the log has no such topic.
  [[nodiscard]] const BagTopic* Find(const std::string& type) const {
    const BagTopic* found = nullptr;
    for (const BagTopic& topic : topics_) {
      if (topic.type == type && topic.messages >= 2 && topic.encoding == "cdr" &&
          (found == nullptr || topic.messages > found->messages)) {
        found = &topic;
      }
    }
    return found;
  }

  bool TakePose(const char* type, const std::string& prefix) {
    const BagTopic* topic = Find(type);
    if (topic == nullptr) {
      return false;
    }
    topic_ = topic->name;
    const std::string start = topic_ + "." + prefix;
    map_.position.x = start + "position.x";
    map_.position.y = start + "position.y";
    map_.orientation = LogOrientation{start + "orientation.x", start + "orientation.y",
                                      start + "orientation.z", start + "orientation.w"};
    return true;
  }

  bool TakeFix() {
    const BagTopic* topic = Find("sensor_msgs/msg/NavSatFix");
    if (topic == nullptr) {
      return false;
    }
    topic_ = topic->name;
    map_.position.latitude = topic_ + ".latitude";
    map_.position.longitude = topic_ + ".longitude";
    map_.heading_from_motion = true;
    map_.valid.push_back({.column = topic_ + ".status.status", .min = 0.0});
    return true;
  }

  template <typename Column>
  void Take(std::optional<Column>& column,
            const std::vector<std::pair<const char*, const char*>>& sources) {
    for (const auto& [type, field] : sources) {
      if (const BagTopic* topic = Find(type)) {
        column.emplace();
        column->column = topic->name + "." + field;
        return;
      }
    }
  }

  const std::vector<BagTopic>& topics_;
  LogMap map_;
  std::string topic_;  // topic of the position
};

LogListing ListBag(const fs::path& log) {
  const BagContent content = ReadBagTopics(log);
  LogListing listing;
  listing.notes = content.notes;
  for (const BagTopic& own : content.topics) {
    LogTopic topic{
        .name = own.name, .type = own.type, .rows = own.messages, .columns = {}, .problem = {}};
    try {
      if (own.encoding != "cdr") {
        throw InputError(
            Problem{.message = fmt::format("encoding '{}'; must be cdr", own.encoding)});
      }
      const BagMessage message(own.type, own.definition);
      for (const std::string& column : message.columns()) {
        topic.columns.push_back(own.name + "." + column);
      }
    } catch (const InputError& error) {
      topic.problem = error.problems().front().message;
    }
    listing.topics.push_back(std::move(topic));
  }
  BagProposal proposal(content.topics, log);
  listing.map = proposal.Make();
  if (!listing.map) {
    listing.problem =
        "no topic has at least two messages of the types nav_msgs/Odometry, "
        "geometry_msgs/PoseStamped, geometry_msgs/PoseWithCovarianceStamped or "
        "sensor_msgs/NavSatFix, which have a position";
    return listing;
  }
  std::vector<double> times;
  ReadLogNumbers({log, proposal.topic()}, {.names = {"stamp.sec", "stamp.nanosec"}, .time = {}},
                 [&](const std::vector<double>& numbers, int /*row*/) {
                   times.push_back(numbers[0] + 1e-9 * numbers[1]);
                 });
  FitTo(MedianStep(std::move(times)), *listing.map);
  return listing;
}

}  // namespace

LogListing ListLog(const fs::path& log) {
  if (IsGlobeFile(log)) {
    return ListGlobe(log);
  }
  return IsBag(log) ? ListBag(log) : ListCsv(log);
}

}  // namespace trackbed
