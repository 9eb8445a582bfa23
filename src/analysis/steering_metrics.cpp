#include "src/analysis/steering_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include "src/analysis/oscillation.h"
#include "src/analysis/peaks.h"
#include "trackbed/core/angle.h"

// Measures how calmly a controller steers: reversals, activity, and sustained oscillations.
// 1. MakeSignals collects the steering command and the signals that explain it. The signals are the
//    path's curvature (with steps, and with ramps instead), the lateral acceleration and the
//    measurement noise. Jumps of the steering command at changes of plan are removed.
// 2. UnexplainedCommand (oscillation.h) removes the part of the command that the collected signals
//    explain. WaveSearch looks for waves in the remaining command, in each part of the run in which
//    the car moves.
// 3. The reported oscillation is the largest wave whose amplitude exceeds ToleratedAmplitude. The
//    tolerated oscillation uses a fifth of the maximum steering rate, or moves the car by 5 % of
//    its width, whichever amplitude is smaller. An oscillation within half of the steering backlash
//    is always tolerated.
// The page docs/verdict.md#calm-steering explains the limits of the oscillation.
namespace trackbed {
namespace {

constexpr double kRateShare = 0.2;    ///< Steering rate tolerated in an oscillation / maximum.
constexpr double kSwayShare = 0.05;   ///< Tolerated lateral oscillation of the car / car width.
constexpr double kShortest = 0.01;    ///< Shortest sampling period [s].
constexpr std::size_t kMost = 60000;  ///< Maximum number of samples per search.

/// Returns the number of rows up to the first contact with an obstacle.
std::size_t FreeRows(const RunLog& log) {
  const auto end = std::find_if(log.rows.begin(), log.rows.end(), [&](const LogRow& row) {
    return log.contact_time && row.state.time > *log.contact_time;
  });
  return static_cast<std::size_t>(end - log.rows.begin());
}

/// Returns the curvature of the plan that was in effect in each row [1/m].
std::vector<double> PathCurvatures(const RunLog& log, const Plan& plan, std::size_t rows) {
  std::vector<double> curvatures;
  auto next = log.changes.begin();
  const Plan* now = &plan;
  double offset = 0.0;
  for (std::size_t i = 0; i < rows; ++i) {
    for (; next != log.changes.end() && next->time <= log.rows[i].state.time; ++next) {
      now = &next->plan;
      offset = next->station;
    }
    curvatures.push_back(now->reference.path.BendAt(log.rows[i].tracking->s - offset).curvature);
  }
  return curvatures;
}

/// Removes the jumps of a signal at changes of plan. All signal values from the first row of a new
/// plan on are shifted, so that the signal does not jump at the change. Replanning every half
/// second makes a wave of jumps, which is no oscillation of the loop of controller and car.
void RemoveJumps(const RunLog& log, std::vector<double>& values) {
  auto next = log.changes.begin();
  double shift = 0.0;
  double before = 0.0;  // value of the signal in the previous row, before the shift
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double given = values[i];
    bool is_new = false;
    for (; next != log.changes.end() && next->time <= log.rows[i].state.time; ++next) {
      is_new = i > 0;
    }
    shift += is_new ? before - given : 0.0;
    values[i] += shift;
    before = given;
  }
}

/// Replaces a jump of the steering angle by a ramp if the wheels cannot turn so far between two
/// rows. The ramp of the steering angle has the slope `rate` [rad/s], and the replaced jump is in
/// its middle. Controllers that know the rate limit respond to curvature steps with ramps of this
/// slope. No linear filter of the path's curvature steps can produce ramps limited by the steering
/// rate.
std::vector<double> Ramped(const std::vector<double>& values, const RunLog& log, double rate) {
  const std::vector<LogRow>& rows = log.rows;
  std::vector<double> ramped = values;
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double jump = values[i] - values[i - 1];
    const double before = rows[i - 1].state.time;
    const double duration = std::abs(jump) / rate;
    if (!(duration > rows[i].state.time - before)) {
      continue;
    }
    const double middle = std::midpoint(before, rows[i].state.time);
    const auto share = [&](std::size_t j) {
      return (rows[j].state.time - middle) / duration + 0.5;
    };
    for (std::size_t j = i; j > 0 && share(j - 1) > 0.0; --j) {
      ramped[j - 1] += jump * share(j - 1);
    }
    for (std::size_t j = i; j < values.size() && share(j) < 1.0; ++j) {
      ramped[j] -= jump * (1.0 - share(j));
    }
  }
  return ramped;
}

/// Returns the means of each `count` consecutive values. If fewer than `count` values remain at the
/// end, these values are ignored.
std::vector<double> Means(const std::vector<double>& values, std::size_t count) {
  std::vector<double> means;
  for (std::size_t i = 0; i + count <= values.size(); i += count) {
    double sum = 0.0;
    for (std::size_t j = i; j < i + count; ++j) {
      sum += values[j];
    }
    means.push_back(sum / static_cast<double>(count));
  }
  return means;
}

/// The signals of a run in which oscillations are searched.
struct SteeringSignals {
  std::size_t rows_per_sample = 1;
  LoopSignals loop;
  std::vector<double> speed;  ///< Magnitude of the speed [m/s].
  bool random = false;        ///< Whether the measured pose contains noise.
};

SteeringSignals MakeSignals(const RunLog& log, const Plan& plan, const VehicleParams& vehicle) {
  const std::size_t rows = FreeRows(log);
  const std::vector<double> curvatures = PathCurvatures(log, plan, rows);
  std::vector<double> command;
  std::vector<double> speed;
  std::vector<double> path;
  std::vector<double> lateral;
  std::vector<double> cubic;
  std::vector<double> aside;
  std::vector<double> turned;
  for (std::size_t i = 0; i < rows; ++i) {
    const LogRow& row = log.rows[i];
    command.push_back(row.command.steering);
    speed.push_back(std::abs(row.state.speed));
    path.push_back(SteeringForCurvature(vehicle, curvatures[i]));
    // The lateral acceleration and its cube explain the additional steering angle that tyre slip
    // requires.
    const double acceleration = speed.back() * speed.back() * curvatures[i] / kGravity;
    lateral.push_back(acceleration);
    cubic.push_back(acceleration * acceleration * acceleration);
    const Pose2& pose = row.state.pose;
    const Pose2& measured = row.measured.value_or(pose);
    const Vec2 error = measured.position() - pose.position();
    aside.push_back(std::cos(pose.yaw) * error.y() - std::sin(pose.yaw) * error.x());
    turned.push_back(AngleDifference(measured.yaw, pose.yaw));
  }
  for (std::vector<double>* signal : {&command, &path, &lateral, &cubic}) {
    RemoveJumps(log, *signal);
  }
  SteeringSignals signals;
  const double period = rows > 1 ? (log.rows[rows - 1].state.time - log.rows[0].state.time) /
                                       static_cast<double>(rows - 1)
                                 : kShortest;
  const std::size_t count =
      period > 0.0 ? static_cast<std::size_t>(std::max(1.0, std::round(kShortest / period))) : 1;
  signals.random = rows > 0 && log.rows.front().measured.has_value();
  signals.rows_per_sample = count;
  signals.loop.period = period * static_cast<double>(count);
  signals.loop.command = Means(command, count);
  signals.loop.foreseen = {Means(path, count), Means(lateral, count), Means(cubic, count),
                           Means(Ramped(path, log, vehicle.steering_rate), count)};
  signals.loop.unforeseen = {Means(aside, count), Means(turned, count)};
  signals.speed = Means(speed, count);
  return signals;
}

std::vector<double> Part(const std::vector<double>& values, std::size_t from, std::size_t to) {
  return {values.begin() + static_cast<std::ptrdiff_t>(from),
          values.begin() + static_cast<std::ptrdiff_t>(to)};
}

LoopSignals Part(const LoopSignals& signals, std::size_t from, std::size_t to) {
  LoopSignals part{.period = signals.period, .command = Part(signals.command, from, to)};
  for (const std::vector<double>& input : signals.foreseen) {
    part.foreseen.push_back(Part(input, from, to));
  }
  for (const std::vector<double>& input : signals.unforeseen) {
    part.unforeseen.push_back(Part(input, from, to));
  }
  return part;
}

/// Searches a range of samples for the largest steering oscillation (wave) above the tolerated
/// amplitude.
class WaveSearch {
 public:
  WaveSearch(const SteeringSignals& signals, const VehicleParams& vehicle)
      : signals_(signals), vehicle_(vehicle) {}

  /// Searches for oscillations only while the car moves: steering does not move a car at rest, so
  /// there is no closed loop.
  void Search(std::size_t from, std::size_t to) {
    const std::vector<double> unexplained = UnexplainedCommand(Part(signals_.loop, from, to));
    std::size_t begin = from;
    for (std::size_t i = from; i <= to; ++i) {
      if (i == to || signals_.speed[i] < kAtRestSpeed) {
        SearchStretch(Part(unexplained, begin - from, i - from), begin);
        begin = i + 1;
      }
    }
  }

  /// Returns the largest steering oscillation (wave); its amplitude is 0 if none exceeds the
  /// tolerated amplitude.
  [[nodiscard]] const Wave& largest() const { return largest_; }
  [[nodiscard]] double speed() const { return speed_; }

 private:
  void SearchStretch(const std::vector<double>& unexplained, std::size_t begin) {
    const std::vector<double> command =
        Part(signals_.loop.command, begin, begin + unexplained.size());
    for (Wave wave : FindWaves(unexplained, command, signals_.loop.period, signals_.random)) {
      wave.first += begin;
      wave.last += begin;
      double speed = 0.0;
      for (std::size_t i = wave.first; i <= wave.last; ++i) {
        speed += signals_.speed[i] / static_cast<double>(wave.last - wave.first + 1);
      }
      if (wave.amplitude > largest_.amplitude &&
          wave.amplitude > ToleratedAmplitude(vehicle_, wave.frequency, speed)) {
        largest_ = wave;
        speed_ = speed;
      }
    }
  }

  const SteeringSignals& signals_;
  const VehicleParams& vehicle_;
  Wave largest_;
  double speed_ = 0.0;  // Mean speed during the largest wave [m/s].
};

/// Returns the lateral motion to each side [m] of a kinematic car at `speed` whose steering
/// oscillates by 1 rad at `frequency`.
double SwayGain(const VehicleParams& vehicle, double frequency, double speed) {
  const double omega = 2.0 * kPi * frequency;
  return speed * speed / (vehicle.wheelbase * omega * omega);
}

}  // namespace

double SteeringReversals(const RunLog& log, const VehicleParams& vehicle) {
  const std::size_t rows = FreeRows(log);
  const double gap = vehicle.steering_limit / 180.0;
  int reversals = 0;
  double direction = 0.0;
  double extreme = rows > 0 ? log.rows.front().command.steering : 0.0;
  for (std::size_t i = 0; i < rows; ++i) {
    const double moved = log.rows[i].command.steering - extreme;
    if (direction * moved > 0.0) {
      extreme += moved;
    } else if (std::abs(moved) > gap) {
      reversals += direction != 0.0 ? 1 : 0;
      direction = std::copysign(1.0, moved);
      extreme += moved;
    }
  }
  const double time = rows > 1 ? log.rows[rows - 1].state.time - log.rows.front().state.time : 0.0;
  return time > 0.0 ? reversals / time : 0.0;
}

double ToleratedAmplitude(const VehicleParams& vehicle, double frequency, double speed) {
  const double unlimited = std::numeric_limits<double>::infinity();
  const double by_rate = vehicle.steering_rate > 0.0
                             ? kRateShare * vehicle.steering_rate / (2.0 * kPi * frequency)
                             : unlimited;
  const double gain = SwayGain(vehicle, frequency, speed);
  const double by_sway =
      vehicle.width > 0.0 && gain > 0.0 ? kSwayShare * vehicle.width / gain : unlimited;
  return std::max(std::min(by_rate, by_sway), 0.5 * vehicle.steering_response.backlash);
}

std::optional<OscillationMetrics> MeasureOscillation(const RunLog& log, const Plan& plan,
                                                     const VehicleParams& vehicle) {
  if (log.rows.empty() || !log.rows.front().tracking) {
    return std::nullopt;
  }
  const SteeringSignals signals = MakeSignals(log, plan, vehicle);
  const std::size_t samples = signals.speed.size();
  WaveSearch search(signals, vehicle);
  for (std::size_t from = 0; from < samples; from += kMost) {
    search.Search(from, std::min(from + kMost, samples));
  }
  OscillationMetrics metrics;
  if (const Wave& wave = search.largest(); wave.amplitude > 0.0) {
    metrics.amplitude = wave.amplitude;
    metrics.frequency = wave.frequency;
    metrics.from_t = log.rows[wave.first * signals.rows_per_sample].state.time;
    metrics.to_t = log.rows[wave.last * signals.rows_per_sample].state.time;
    metrics.sway = wave.amplitude * SwayGain(vehicle, wave.frequency, search.speed());
    metrics.rate = 2.0 * kPi * wave.frequency * wave.amplitude;
  }
  return metrics;
}

}  // namespace trackbed
