#include "trackbed/control/recording_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "trackbed/control/playback.h"
#include "trackbed/core/error.h"
#include "trackbed/core/table.h"

namespace trackbed {
namespace {

/// Converts the columns of a table excerpt to signals and collects the problems of all columns.
class RecordingExcerpt {
 public:
  RecordingExcerpt(const std::filesystem::path& file, CsvExcerpt excerpt, std::string axis)
      : file_(file.string()), excerpt_(std::move(excerpt)), axis_name_(std::move(axis)) {
    axis_ = excerpt_.table.Column(axis_name_);
    if (axis_.empty()) {
      problems_.Add({.file = file_, .line = 1, .message = "no rows after the header"});
    }
    for (std::size_t row = 1; row < axis_.size(); ++row) {
      if (axis_[row] <= axis_[row - 1]) {
        AddError(row, axis_name_,
                 fmt::format("{} must be above the previous row's {}", axis_[row], axis_[row - 1]));
      }
    }
  }

  [[nodiscard]] bool Has(const std::string& column) const {
    return excerpt_.table.Find(column) >= 0;
  }

  /// Converts one column to a signal, which is empty if the column does not exist. The column's
  /// value in the last row must be in the range `last`, all other values in the range `range`.
  Signal Column(const std::string& column, const Range& range, const Range& last) {
    Signal signal;
    if (!Has(column)) {
      return signal;
    }
    const std::vector<double> values = excerpt_.table.Column(column);
    for (std::size_t row = 0; row < values.size(); ++row) {
      const Range& own = row + 1 == values.size() ? last : range;
      if (values[row] < own.min || values[row] > own.max || values[row] <= own.above) {
        AddError(row, column,
                 fmt::format("{} is out of range; must be {}", values[row], AllowedBy(own)));
      }
      signal.knots.emplace_back(axis_[row], values[row]);
    }
    return signal;
  }

  Signal Column(const std::string& column, const Range& range) {
    return Column(column, range, range);
  }

  /// Throws one InputError that lists all problems of the recording, in the order of the file.
  void Finish() const { problems_.ThrowIfAny(); }

 private:
  void AddError(std::size_t row, const std::string& column, std::string message) {
    problems_.Add({file_, excerpt_.lines[row], 0, column, std::move(message)});
  }

  std::string file_;
  CsvExcerpt excerpt_;
  std::string axis_name_;
  std::vector<double> axis_;
  ProblemList problems_;
};

}  // namespace

Recording ReadRecording(const std::filesystem::path& file, PlaybackAxis by,
                        const RecordingColumns& columns) {
  if (columns.speed && columns.acceleration) {
    throw InputError(Problem{.key = "columns", .message = "give speed or acceleration, not both"});
  }
  const bool by_distance = by == PlaybackAxis::kDistance;
  const std::string axis =
      by_distance ? columns.distance.value_or("s_m") : columns.time.value_or("t_s");
  const std::string steering = columns.steering.value_or("steering_rad");
  const std::string speed = columns.speed.value_or("speed_mps");
  const std::string acceleration = columns.acceleration.value_or("acceleration_mps2");
  std::vector<std::string> needed{axis, steering};
  std::vector<std::string> optional;
  if (columns.speed || columns.acceleration) {
    needed.push_back(columns.speed ? speed : acceleration);
  } else {
    optional = {speed, acceleration};
  }
  RecordingExcerpt excerpt(file, ReadCsvExcerpt(file, needed, optional), axis);
  if (!optional.empty() && excerpt.Has(speed) && excerpt.Has(acceleration)) {
    throw InputError(
        Problem{.file = file.string(),
                .line = 1,
                .message = fmt::format("has both '{}' and '{}'; choose one in control.columns",
                                       speed, acceleration)});
  }
  Recording recording;
  recording.steering = excerpt.Column(steering, kSteering);
  const Range moving{.max = kSpeedRange.max, .above = 0.0};
  if (!columns.acceleration) {
    recording.speed = excerpt.Column(speed, by_distance ? moving : kSpeedRange, kSpeedRange);
  }
  if (!columns.speed) {
    recording.acceleration = excerpt.Column(acceleration, {});
  }
  excerpt.Finish();
  return recording;
}

std::string RecordingCsv(const Recording& recording, PlaybackAxis by) {
  std::vector<std::pair<const char*, const Signal*>> signals{
      {"steering_rad", &recording.steering},
      {"speed_mps", &recording.speed},
      {"acceleration_mps2", &recording.acceleration}};
  std::erase_if(signals, [](const auto& signal) { return signal.second->empty(); });
  std::vector<std::string> columns{by == PlaybackAxis::kDistance ? "s_m" : "t_s"};
  for (const auto& [name, signal] : signals) {
    columns.emplace_back(name);
  }
  const std::vector<Vec2>& knots = recording.steering.knots;
  Table table(columns);
  for (std::size_t i = 0; i < knots.size(); ++i) {
    std::vector<double> row{knots[i].x()};
    for (const auto& [name, signal] : signals) {
      TRACKBED_REQUIRE(signal->knots.size() == knots.size() && signal->knots[i].x() == row[0],
                       "RecordingCsv: row {} of {} is not over the steering's axis", i, name);
      row.push_back(signal->knots[i].y());
    }
    table.AddRow(row);
  }
  return table.ToCsv();
}

}  // namespace trackbed
