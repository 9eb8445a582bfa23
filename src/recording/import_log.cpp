#include "trackbed/recording/import_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "src/recording/clocks.h"
#include "src/recording/drive_extent.h"
#include "src/recording/fitted_series.h"
#include "src/recording/local_polynomial.h"
#include "src/recording/log_check.h"
#include "src/recording/log_rows.h"
#include "trackbed/control/signal.h"
#include "trackbed/core/error.h"

// Imports the log of a recorded drive. Rows are read in SI units and ENU axes (log_rows.h), and
// columns are checked for contradictions (log_check.h). Poses and signals are resampled to a time
// grid with a constant period by fitting local polynomials (local_polynomial.h: Cleveland 1979).
// Velocity and acceleration are the derivatives of the fitted polynomials. If the log contains a
// measured speed, yaw rate or acceleration, the measured value replaces the derivative of the
// polynomial. Delays between measured values and derivatives are noted, and removed on request
// (clocks.h). Inputs of the car, such as the steering angle, are interpolated linearly. Gaps in the
// log are filled by linear interpolation, and the samples within a gap are marked invalid.
namespace trackbed {
namespace {

namespace fs = std::filesystem;

constexpr double kMinDuration = 1.0;  // Minimum duration of an imported drive [s].
// Largest number of samples of an imported drive, which limits the memory to 130 MB.
constexpr double kMaxSamples = 1e6;

/// Computes the pose X_WV of the rear axle from the pose X_WS of the measured point (sensor).
Pose2 VehiclePose(const Pose2& X_WS, const LogSensor& X_VS) {
  const Vec2 p_SV = ToLocal({X_VS.x, X_VS.y, X_VS.yaw}, Vec2::Zero());
  return Compose(X_WS, {p_SV.x(), p_SV.y(), -X_VS.yaw});
}

/// Returns the rows of a series at which the signal's value changed, for a signal that is updated
/// less often than it is logged. Between two updates, the signal is later interpolated linearly. If
/// a value stays constant for longer than 1.5 update periods, Updates also returns a row with this
/// value one period before the next change.
LogSeries Updates(const LogSeries& rows, double period) {
  LogSeries updates;
  const auto add = [&](double time, double value) {
    updates.time.push_back(time);
    updates.value.push_back(value);
  };
  for (std::size_t i = 0; i < rows.time.size(); ++i) {
    if (i > 0 && rows.value[i] == rows.value[i - 1]) {
      continue;
    }
    if (!updates.time.empty() && rows.time[i] - updates.time.back() > 1.5 * period) {
      add(rows.time[i] - period, updates.value.back());
    }
    add(rows.time[i], rows.value[i]);
  }
  if (!rows.time.empty() && rows.time.back() > updates.time.back()) {
    add(rows.time.back(), rows.value.back());
  }
  return updates;
}

Signal Linear(const LogSeries& series, const std::optional<double>& period) {
  const LogSeries knots = period ? Updates(series, *period) : series;
  Signal signal;
  for (std::size_t i = 0; i < knots.time.size(); ++i) {
    signal.knots.emplace_back(knots.time[i], knots.value[i]);
  }
  return signal;
}

class Importer {
 public:
  Importer(const fs::path& log, const LogMap& map)
      : log_(log), map_(map), rows_(ReadLogRows(log, map)) {}

  RecordedDrive Import() {
    RequireRows();
    drive_.name = log_.stem().string();
    drive_.period = 1.0 / map_.resample.rate;
    drive_.has_steering = rows_.has[kSteeringSignal];
    drive_.has_steering_command = rows_.has[kSteeringCommandSignal];
    drive_.has_throttle = rows_.has[kThrottleSignal];
    NoteRows();
    Check();
    BuildTimeGrid();
    if (const std::string problem = GapProblem(rows_.time, map_.gap); !problem.empty()) {
      Refuse(problem);
    }
    FitPoses();
    for (std::string& note : CompareClocks(rows_, map_, drive_, start_)) {
      drive_.notes.push_back(std::move(note));
    }
    FitSignals();
    FillGaps();
    TakeInputs();
    NoteResult();
    return std::move(drive_);
  }

 private:
  [[noreturn]] void Refuse(std::string message) const {
    throw InputError(Problem{.file = log_.string(), .message = std::move(message)});
  }

  void RequireRows() const;
  void Check();
  void BuildTimeGrid();
  void FitPoses();
  void FitSignals();
  void FillGaps();
  void TakeInputs();
  void NoteRows();
  void NoteResult();
  void NoteGaps();

  [[nodiscard]] double LogTime(const RecordedSample& sample) const { return start_ + sample.time; }

  template <typename... T>
  void Note(fmt::format_string<T...> text, T&&... values) {
    drive_.notes.push_back(fmt::format(text, std::forward<T>(values)...));
  }

  fs::path log_;
  const LogMap& map_;
  LogRows rows_;
  RecordedDrive drive_;
  double start_ = 0.0;  // start of the time grid, relative to the first row of the log [s]
};

void Importer::RequireRows() const {
  if (rows_.time.size() < 2) {
    Refuse(fmt::format(
        "{} rows with a pose of {} in the log ({} excluded by valid, {} without a number, {} at "
        "the time of the row before); must be at least 2",
        rows_.time.size(), rows_.rows, rows_.invalid, rows_.without_pose, rows_.repeated));
  }
  Vec2 least = rows_.position.front();
  Vec2 most = least;
  for (const Vec2& position : rows_.position) {
    least = least.cwiseMin(position);
    most = most.cwiseMax(position);
  }
  constexpr double kMinExtent = 1e-6;  // [m]
  if ((most - least).norm() < kMinExtent) {
    Refuse(
        fmt::format("the position never changes ({}, {}): the car stands, or these are other "
                    "columns",
                    map_.position.latitude.value_or(map_.position.x),
                    map_.position.longitude.value_or(map_.position.y)));
  }
  const std::string extent = ExtentProblem(rows_.position, [&](std::size_t row) {
    return fmt::format("{:.10g} s after the first row", rows_.time[row]);
  });
  if (!extent.empty()) {
    Refuse(extent);
  }
  for (std::size_t signal = 0; signal < kLogSignals; ++signal) {
    if (rows_.has[signal] && rows_.signals[signal].time.size() < 2) {
      Refuse(fmt::format("the column of {} has numbers in less than two rows",
                         kLogSignalKeys[signal]));
    }
  }
}

void Importer::Check() {
  const auto found = FindContradictions(rows_, map_);
  if (map_.check && !found.empty()) {
    std::vector<Problem> problems;
    for (const auto& [key, message] : found) {
      problems.push_back({.file = log_.string(),
                          .key = key,
                          .message = message + " (check: false in the map imports it anyway)"});
    }
    throw InputError(std::move(problems));
  }
  for (const auto& [key, message] : found) {
    Note("{}: {}", key, message);
  }
}

void Importer::BuildTimeGrid() {
  start_ = std::max(rows_.time.front() + map_.trim, map_.from);
  const double end = std::min(rows_.time.back() - map_.trim, map_.to.value_or(rows_.time.back()));
  if (end - start_ < kMinDuration) {
    Refuse(fmt::format("{:.3g} s of data between {:.3g} s and {:.3g} s; must be at least {} s",
                       std::max(0.0, end - start_), start_, end, kMinDuration));
  }
  // Add a tolerance of 1e-6 periods, because rounding errors could otherwise exclude the last
  // sample.
  const double count = std::floor((end - start_) * map_.resample.rate + 1e-6) + 1.0;
  if (count > kMaxSamples) {
    Refuse(
        fmt::format("{:.4g} samples at {} per second; must be at most {:.0e}: set a lower "
                    "resample.rate, or import a part with from and to",
                    count, map_.resample.rate, kMaxSamples));
  }
  for (double i = 0.0; i < count; i += 1.0) {
    drive_.samples.push_back({.time = i / map_.resample.rate, .valid = false});
  }
}

void Importer::FitPoses() {
  std::vector<double> yaw = rows_.yaw;
  Unwrap(yaw);
  Eigen::MatrixXd values(static_cast<Eigen::Index>(yaw.size()), 3);
  for (std::size_t i = 0; i < yaw.size(); ++i) {
    const Pose2 pose =
        VehiclePose({rows_.position[i].x(), rows_.position[i].y(), yaw[i]}, map_.sensor);
    values.row(static_cast<Eigen::Index>(i)) << pose.x, pose.y, pose.yaw;
  }
  const LocalPolynomial fits(rows_.time, values, map_.resample.half_width, map_.resample.degree);
  const std::vector<LogStretch> stretches = SplitAtGaps(rows_.time, map_.gap);
  auto stretch = stretches.begin();
  // Allow a tolerance when comparing times, because the times of the grid have rounding errors,
  // unlike the times of the log rows.
  const double slack = 1e-6 * drive_.period;
  for (RecordedSample& sample : drive_.samples) {
    const double at = LogTime(sample);
    while (at > rows_.time[stretch->end - 1] + slack && stretch + 1 != stretches.end()) {
      ++stretch;
    }
    if (at < rows_.time[stretch->first] - slack || at > rows_.time[stretch->end - 1] + slack) {
      continue;
    }
    const LocalFit fit = fits.At(at, *stretch);
    sample.valid = true;
    sample.pose = {fit(0, 0), fit(0, 1), fit(0, 2)};
    sample.velocity_V = ToLocal({0.0, 0.0, sample.pose.yaw}, {fit(1, 0), fit(1, 1)});
    sample.acceleration_V = ToLocal({0.0, 0.0, sample.pose.yaw}, {fit(2, 0), fit(2, 1)});
    sample.yaw_rate = fit(1, 2);
    sample.yaw_acceleration = fit(2, 2);
  }
}

void Importer::FitSignals() {
  if (rows_.has[kYawRateSignal]) {
    const FittedSeries fits(rows_.signals[kYawRateSignal], map_);
    for (RecordedSample& sample : drive_.samples) {
      const LocalFit fit = fits.At(LogTime(sample));
      sample.yaw_rate = fit(0, 0);
      sample.yaw_acceleration = fit(1, 0);
    }
  }
  if (rows_.has[kSpeedSignal]) {
    const FittedSeries fits(rows_.signals[kSpeedSignal], map_);
    for (RecordedSample& sample : drive_.samples) {
      const LocalFit fit = fits.At(LogTime(sample));
      sample.velocity_V.x() = fit(0, 0);
      sample.acceleration_V.x() = fit(1, 0) - sample.velocity_V.y() * sample.yaw_rate;
    }
  }
  if (rows_.has[kAccelerationX]) {
    const FittedSeries x(rows_.signals[kAccelerationX], map_);
    const FittedSeries y(rows_.signals[kAccelerationY], map_);
    const Vec2 arm(map_.accelerometer->ahead, map_.accelerometer->left);
    for (RecordedSample& sample : drive_.samples) {
      const Vec2 measured(x.At(LogTime(sample))(0, 0), y.At(LogTime(sample))(0, 0));
      const double r = sample.yaw_rate;
      sample.acceleration_V = measured + r * r * arm - sample.yaw_acceleration * LeftNormal(arm);
    }
  }
}

/// Fills the gaps in the samples by linear interpolation between the last valid sample before a gap
/// and the first valid sample after the gap. The time grid begins and ends within the rows of the
/// log, so there is a valid sample on both sides of every gap.
void Importer::FillGaps() {
  std::vector<RecordedSample>& samples = drive_.samples;
  const auto valid = [](const RecordedSample& sample) { return sample.valid; };
  if (std::none_of(samples.begin(), samples.end(), valid)) {
    Refuse("no sample lies between rows that count");
  }
  for (auto gap = std::find_if_not(samples.begin(), samples.end(), valid); gap != samples.end();) {
    const auto after = std::find_if(gap, samples.end(), valid);
    const RecordedSample& to = after == samples.end() ? *(gap - 1) : *after;
    const RecordedSample& from = gap == samples.begin() ? to : *(gap - 1);
    const double length = to.time - from.time;
    const Vec2 velocity_W =
        length > 0.0 ? Vec2((to.pose.position() - from.pose.position()) / length) : Vec2::Zero();
    const double yaw_rate = length > 0.0 ? (to.pose.yaw - from.pose.yaw) / length : 0.0;
    for (; gap != after; ++gap) {
      const double since = gap->time - from.time;
      const Vec2 position = from.pose.position() + since * velocity_W;
      gap->pose = {position.x(), position.y(), from.pose.yaw + since * yaw_rate};
      gap->velocity_V = ToLocal({0.0, 0.0, gap->pose.yaw}, velocity_W);
      gap->yaw_rate = yaw_rate;
      gap->acceleration_V = Vec2::Zero();
      gap->yaw_acceleration = 0.0;
    }
    gap = std::find_if_not(gap, samples.end(), valid);
  }
}

void Importer::TakeInputs() {
  const auto take = [&](LogSignal signal, const auto& column, double RecordedSample::*value) {
    if (!column) {
      return;
    }
    const Signal over_time = Linear(rows_.signals[signal], column->period);
    for (RecordedSample& sample : drive_.samples) {
      sample.*value = over_time.At(LogTime(sample));
    }
  };
  take(kSteeringSignal, map_.steering, &RecordedSample::steering);
  take(kSteeringCommandSignal, map_.steering_command, &RecordedSample::steering_command);
  take(kThrottleSignal, map_.throttle, &RecordedSample::throttle);
}

void Importer::NoteRows() {
  const std::vector<double>& time = rows_.time;
  double longest = 0.0;
  for (std::size_t i = 1; i < time.size(); ++i) {
    longest = std::max(longest, time[i] - time[i - 1]);
  }
  const double mean = (time.back() - time.front()) / static_cast<double>(time.size() - 1);
  Note("{}, read by the map {}: {} of {} rows used, {:.4g} s apart on average, {:.4g} s at most",
       log_.filename().string(), map_.name, time.size(), rows_.rows, mean, longest);
  for (const std::string& note : rows_.notes) {
    Note("{}", note);
  }
  if (rows_.invalid > 0) {
    Note("{} rows dropped that `valid` excludes", rows_.invalid);
  }
  if (rows_.without_pose > 0) {
    Note("{} rows dropped that have no number for the pose", rows_.without_pose);
  }
  if (rows_.repeated > 0) {
    Note("{} rows dropped that have the time of the row before, the first in line {}",
         rows_.repeated, rows_.repeated_line);
  }
  for (std::size_t signal = 0; signal < kLogSignals; ++signal) {
    const std::vector<double>& values = rows_.signals[signal].value;
    if (rows_.has[signal] && std::all_of(values.begin(), values.end(),
                                         [&](double value) { return value == values.front(); })) {
      Note("{} is constant: {:.6g}", kLogSignalKeys[signal], values.front());
    }
  }
}

void Importer::NoteGaps() {
  int gaps = 0;
  int missing = 0;
  double longest = 0.0;
  double longest_at = 0.0;
  double since = 0.0;  // time at which the current gap starts [s]
  bool in_gap = false;
  for (const RecordedSample& sample : drive_.samples) {
    missing += sample.valid ? 0 : 1;
    if (!sample.valid && !in_gap) {
      ++gaps;
      since = sample.time;
    }
    in_gap = !sample.valid;
    if (in_gap && sample.time - since >= longest) {
      longest = sample.time - since;
      longest_at = since;
    }
  }
  if (gaps > 0) {
    Note("{} {} of more than {:.4g} s, {:.4g} s in all; the longest from {:.4g} s on", gaps,
         gaps == 1 ? "gap" : "gaps", map_.gap, missing * drive_.period, longest_at);
  }
}

void Importer::NoteResult() {
  Note(
      "resampled to {} samples at {:.6g} per second, from {:.6g} s after the first row on: local "
      "polynomials of degree {} over +-{:.4g} s, without phase",
      drive_.samples.size(), map_.resample.rate, start_, map_.resample.degree,
      map_.resample.half_width);
  NoteGaps();
}

}  // namespace

RecordedDrive ImportLog(const fs::path& log, const LogMap& map) {
  if (const auto found = LogMapProblems(map); !found.empty()) {
    std::vector<Problem> problems;
    for (const auto& [key, message] : found) {
      problems.push_back({.key = key, .message = message});
    }
    throw InputError(std::move(problems));
  }
  return Importer(log, map).Import();
}

}  // namespace trackbed
