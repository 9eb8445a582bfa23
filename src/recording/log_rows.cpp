#include "src/recording/log_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "src/recording/bag_map.h"
#include "src/recording/log_globe.h"
#include "src/recording/log_source.h"
#include "trackbed/bag/bag.h"
#include "trackbed/control/signal.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/csv_rows.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/table.h"
#include "trackbed/path_files/globe.h"
#include "trackbed/path_files/globe_file.h"
#include "trackbed/path_files/globe_names.h"

// Reads the CSV file of a log, and the other files named in the log map (the file that describes
// the log's columns), row by row. Times are relative to the first row of the log. The reader skips
// rows outside the imported part and rows that a condition of the log map excludes. The reader also
// skips incomplete poses and poses with the time of the previous pose. Each number is converted by
// the scale, unit, offset and curve that the log map specifies for its column. NED poses are
// converted to ENU, and signals that are positive to the right change their sign.
namespace trackbed {
namespace {

namespace fs = std::filesystem;

// Largest number of values that are read from a log, which limits the memory to 400 MB.
constexpr std::size_t kMaxNumbers = 50'000'000;

/// Column that contains a signal, and the sign (1 or -1) that converts the column's values to
/// Trackbed's vehicle frame.
struct SignalColumn {
  LogSignal signal;
  LogColumn column;
  double sign;
};

std::vector<SignalColumn> SignalColumns(const LogMap& map) {
  // Factor that makes turning signals positive to the left; in NED logs, they are positive to the
  // right.
  const double turn = map.frame == LogFrame::kNed ? -1.0 : 1.0;
  std::vector<SignalColumn> columns;
  const auto add = [&](LogSignal signal, const auto& column, double sign) {
    if (column) {
      columns.push_back({signal, *column, sign});
    }
  };
  add(kSpeedSignal, map.speed, 1.0);
  add(kYawRateSignal, map.yaw_rate, turn);
  if (const auto& sensor = map.accelerometer) {
    const LogColumn x{
        .column = sensor->x, .file = sensor->file, .unit = sensor->unit, .delay = sensor->delay};
    LogColumn y = x;
    y.column = sensor->y;
    columns.push_back({kAccelerationX, x, 1.0});
    columns.push_back({kAccelerationY, y, turn});
  }
  add(kSteeringSignal, map.steering, turn);
  add(kSteeringCommandSignal, map.steering_command, turn);
  add(kThrottleSignal, map.throttle, 1.0);
  return columns;
}

char DelimiterOf(const LogMap& map) {
  return map.delimiter == LogDelimiter::kAuto        ? kFindDelimiter
         : map.delimiter == LogDelimiter::kComma     ? ','
         : map.delimiter == LogDelimiter::kSemicolon ? ';'
                                                     : '\t';
}

/// A list of log column names without duplicates.
class ColumnNames {
 public:
  std::size_t Add(const std::string& name) {
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found == names_.end()) {
      names_.push_back(name);
      return names_.size() - 1;
    }
    return static_cast<std::size_t>(found - names_.begin());
  }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

 private:
  std::vector<std::string> names_;
};

double Yaw(double x, double y, double z, double w) {
  return std::atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z));
}

class LogReader {
 public:
  /// Reads a topic of a ROS bag, if `topic` is not empty.
  LogReader(const fs::path& log, const LogMap& map, std::string topic)
      : log_(log),
        topic_(std::move(topic)),
        map_(map),
        signals_(SignalColumns(map)),
        is_globe_(map.position.latitude) {
    if (is_globe_) {
      const std::optional<GlobeColumn> meaning = GlobeColumnOf(*map.position.latitude);
      globe_unit_ = map.position.unit ? UnitInSi(*map.position.unit) / UnitInSi("deg")
                                      : meaning.value_or(GlobeColumn{}).degrees;
    }
    for (const SignalColumn& signal : signals_) {
      rows_.has[signal.signal] = true;
    }
  }

  LogRows Read() {
    ReadPoses();
    if (is_globe_ && topic_.empty() && !IsGlobeFile(log_)) {
      CheckHemispheres(log_, map_.position, DelimiterOf(map_));
    }
    if (is_globe_) {
      ProjectRows(log_, map_.position, lines_, rows_);
    }
    if (map_.heading_from_motion) {
      TakeHeadings(log_, map_, rows_);
    }
    std::vector<std::string> others;
    for (const SignalColumn& signal : signals_) {
      const std::optional<std::string>& file = signal.column.file;
      if (file && std::find(others.begin(), others.end(), *file) == others.end()) {
        others.push_back(*file);
        ReadOther(*file, kLogSignalKeys[signal.signal]);
      }
    }
    return std::move(rows_);
  }

 private:
  using Numbers = std::vector<double>;

  /// Time column of a CSV file, and the last time that was read from the column.
  struct Clock {
    std::size_t column;
    std::optional<std::size_t> nanoseconds;
    std::optional<double> last{};
  };

  Clock MakeClock(ColumnNames& names) const {
    Clock clock{.column = names.Add(map_.time.column), .nanoseconds = {}};
    if (map_.time.nanoseconds) {
      clock.nanoseconds = names.Add(*map_.time.nanoseconds);
    }
    return clock;
  }

  /// Returns the time of a row since the first row of the log [s]. If the time is missing or less
  /// than the previous time, TimeOf adds a problem and returns nullopt.
  std::optional<double> TimeOf(Clock& clock, const Numbers& numbers, const fs::path& file, int line,
                               ProblemList& problems) {
    const double count = numbers[clock.column];
    const double nanoseconds = clock.nanoseconds ? numbers[*clock.nanoseconds] : 0.0;
    if (!std::isfinite(count) || !std::isfinite(nanoseconds)) {
      problems.Add({file.string(), line, 0, map_.time.column, "no time"});
      return std::nullopt;
    }
    if (!origin_) {
      origin_ = {count, nanoseconds};
      rows_.origin = count;
    }
    // Subtract the first time before converting the unit, so that time differences are exact even
    // if the log's times are integers near 1e18.
    const double time = (count - origin_->first) * UnitInSi(map_.time.unit) +
                        (nanoseconds - origin_->second) * 1e-9;
    if (clock.last && time < *clock.last) {
      problems.Add({file.string(), line, 0, map_.time.column,
                    fmt::format("the time goes back by {:.6g} s; sort the rows, or cut the part "
                                "out with from and to",
                                *clock.last - time)});
      clock.last = time;
      return std::nullopt;
    }
    clock.last = time;
    return time;
  }

  [[nodiscard]] bool IsWanted(double time) const {
    const double margin = map_.resample.half_width;
    return time >= map_.from - margin && (!map_.to || time <= *map_.to + margin);
  }

  void Count(std::size_t numbers) {
    kept_ += numbers;
    if (kept_ > kMaxNumbers) {
      throw InputError(Problem{
          .file = log_.string(),
          .message = fmt::format("more than {} numbers in the columns that the map names; import a "
                                 "part of it with from and to",
                                 kMaxNumbers)});
    }
  }

  void TakeSignal(const SignalColumn& signal, double number, double time) {
    if (!std::isfinite(number)) {
      return;
    }
    const LogColumn& column = signal.column;
    LogSeries& series = rows_.signals[signal.signal];
    const double at = time - column.delay;
    if (!series.time.empty() && at <= series.time.back()) {
      return;  // skip a signal value whose time is not later than that of the previous value
    }
    Count(2);
    double value = column.scale * (number * UnitInSi(column.unit)) + column.offset;
    if (!column.curve.empty()) {
      value = Signal{column.curve}.At(value);
    }
    series.time.push_back(at);
    series.value.push_back(signal.sign * value);
  }

  [[nodiscard]] WantedColumns Wanted(const ColumnNames& names) const {
    return {.names = names.names(), .time = map_.time.column, .delimiter = DelimiterOf(map_)};
  }

  void ReadPoses();
  void ReadOther(const std::string& name, const char* key);
  /// Adds the position and the yaw of a row, unless one of them is missing.
  void TakePose(const Numbers& numbers, double time, int line,
                const std::vector<std::size_t>& columns, ProblemList& problems);

  const fs::path& log_;
  std::string topic_;  // Topic of the position in a ROS bag; empty for other logs.
  const LogMap& map_;
  std::vector<SignalColumn> signals_;
  LogRows rows_;
  // Time of the first row: the number in the time column, in the log's unit, and the number in the
  // column of additional nanoseconds.
  std::optional<std::pair<double, double>> origin_;
  std::size_t kept_ = 0;
  bool is_globe_;            // Whether the log has geographic positions [deg], which are projected
                             // at the end.
  double globe_unit_ = 1.0;  // Degrees per unit of the columns of geographic positions.
  std::vector<int> lines_;   // Line number in the log of each geographic position.
};

void LogReader::TakePose(const Numbers& numbers, double time, int line,
                         const std::vector<std::size_t>& columns, ProblemList& problems) {
  const bool complete = std::all_of(columns.begin(), columns.end(), [&](std::size_t column) {
    return std::isfinite(numbers[column]);
  });
  if (!complete) {
    ++rows_.without_pose;
    return;
  }
  if (!rows_.time.empty() && time <= rows_.time.back()) {
    rows_.repeated_line = rows_.repeated == 0 ? line : rows_.repeated_line;
    ++rows_.repeated;
    return;
  }
  Count(4);
  double yaw = 0.0;
  if (map_.yaw) {
    yaw = map_.yaw->scale * (numbers[columns[2]] * UnitInSi(map_.yaw->unit)) + map_.yaw->offset;
    yaw = map_.yaw->curve.empty() ? yaw : Signal{map_.yaw->curve}.At(yaw);
  } else if (map_.orientation) {
    yaw = Yaw(numbers[columns[2]], numbers[columns[3]], numbers[columns[4]], numbers[columns[5]]);
  }
  const bool ned = map_.frame == LogFrame::kNed;
  rows_.time.push_back(time);
  const Vec2 numbers_xy(numbers[columns[0]], numbers[columns[1]]);
  if (is_globe_) {
    const Vec2 degrees = globe_unit_ * numbers_xy;
    const GlobePosition position{.latitude = degrees.y(), .longitude = degrees.x()};
    if (std::string problem = GlobeProblem(position); !problem.empty()) {
      problems.Add({log_.string(), line, 0, *map_.position.latitude, std::move(problem)});
    }
    rows_.position.push_back(degrees);
    lines_.push_back(line);
  } else {
    const Vec2 position = UnitInSi(map_.position.unit.value_or("m")) * numbers_xy;
    rows_.position.push_back(ned ? Vec2(position.y(), position.x()) : position);
  }
  rows_.yaw.push_back(ned ? 0.5 * kPi - yaw : yaw);
}

void LogReader::ReadPoses() {
  ColumnNames names;
  Clock clock = MakeClock(names);
  std::vector<std::size_t> pose;
  if (is_globe_) {
    pose = {names.Add(*map_.position.longitude), names.Add(*map_.position.latitude)};
  } else {
    pose = {names.Add(map_.position.x), names.Add(map_.position.y)};
  }
  if (map_.yaw) {
    pose.push_back(names.Add(map_.yaw->column));
  } else if (map_.orientation) {
    for (const std::string& part :
         {map_.orientation->x, map_.orientation->y, map_.orientation->z, map_.orientation->w}) {
      pose.push_back(names.Add(part));
    }
  }
  std::vector<std::pair<const SignalColumn*, std::size_t>> signals;
  for (const SignalColumn& signal : signals_) {
    if (!signal.column.file) {
      signals.emplace_back(&signal, names.Add(signal.column.column));
    }
  }
  std::vector<std::size_t> conditions;
  for (const LogCondition& condition : map_.valid) {
    conditions.push_back(names.Add(condition.column));
  }
  ProblemList problems;
  ReadLogNumbers({log_, topic_}, Wanted(names), [&](const Numbers& numbers, int line) {
    ++rows_.rows;
    const std::optional<double> time = TimeOf(clock, numbers, log_, line, problems);
    if (!time || !IsWanted(*time)) {
      return;
    }
    for (std::size_t i = 0; i < conditions.size(); ++i) {
      const LogCondition& condition = map_.valid[i];
      const double number = numbers[conditions[i]];
      constexpr double kAny = std::numeric_limits<double>::infinity();
      if (!(number >= condition.min.value_or(-kAny) && number <= condition.max.value_or(kAny)) ||
          (condition.equals && number != *condition.equals)) {
        ++rows_.invalid;
        return;
      }
    }
    TakePose(numbers, *time, line, pose, problems);
    for (const auto& [signal, column] : signals) {
      TakeSignal(*signal, numbers[column], *time);
    }
  });
  problems.ThrowIfAny();
}

void LogReader::ReadOther(const std::string& name, const char* key) {
  const fs::path folder = log_.parent_path();
  if (const std::string why = topic_.empty() ? ReadAccessError(name, folder, {}) : "";
      !why.empty()) {
    throw InputError(Problem{.file = log_.string(),
                             .key = fmt::format("{}.file", key),
                             .message = fmt::format("{} {}", name, why)});
  }
  ColumnNames names;
  Clock clock = MakeClock(names);
  std::vector<std::pair<const SignalColumn*, std::size_t>> signals;
  for (const SignalColumn& signal : signals_) {
    if (signal.column.file == name) {
      signals.emplace_back(&signal, names.Add(signal.column.column));
    }
  }
  const fs::path file = topic_.empty() ? folder / name : log_;
  ProblemList problems;
  ReadLogNumbers({file, topic_.empty() ? "" : name}, Wanted(names),
                 [&](const Numbers& numbers, int line) {
                   const std::optional<double> time = TimeOf(clock, numbers, file, line, problems);
                   // Keep also rows outside the imported part of the log, because the rows of this
                   // file may be far apart in time.
                   if (time) {
                     for (const auto& [signal, column] : signals) {
                       TakeSignal(*signal, numbers[column], *time);
                     }
                   }
                 });
  problems.ThrowIfAny();
}

}  // namespace

LogRows ReadLogRows(const fs::path& log, const LogMap& map) {
  if (IsBag(log)) {
    const BagMap bag = DivideByTopics(log, map);
    return LogReader(log, bag.map, bag.topic).Read();
  }
  return LogReader(log, map, "").Read();
}

std::string GapProblem(const std::vector<double>& time, double gap) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < time.size(); ++i) {
    steps.push_back(time[i] - time[i - 1]);
  }
  if (steps.empty()) {
    return "";
  }
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle <= gap
             ? ""
             : fmt::format(
                   "most rows are {0:.4g} s or more apart, more than gap, {1:.4g} s, so nearly all "
                   "samples would be in gaps: set gap: {2:.3g} and resample: {{half_width: "
                   "{3:.3g}}} "
                   "in the map",
                   *middle, gap, 3.0 * *middle, 1.7 * *middle);
}

void Unwrap(std::vector<double>& yaw) {
  for (std::size_t i = 1; i < yaw.size(); ++i) {
    yaw[i] = yaw[i - 1] + AngleDifference(yaw[i], yaw[i - 1]);
  }
}

}  // namespace trackbed
