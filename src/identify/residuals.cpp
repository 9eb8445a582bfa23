#include "src/identify/residuals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "trackbed/analysis/parallel.h"
#include "trackbed/analysis/record_metrics.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/drive/drive.h"
#include "trackbed/recording/windows.h"
#include "trackbed/sim/car_parameters.h"
#include "trackbed/sim/world_scene.h"

namespace trackbed {
namespace {

// Residual of each sample after the plant has diverged, divided by the signal's deviation.
constexpr double kDivergedResidual = 100.0;

/// A signal that the identification fits: its standard deviation, and a function that returns the
/// difference between predicted and recorded value.
struct FittedSignal {
  double deviation;
  double (*difference)(const VehicleState& predicted, const VehicleState& recorded);
};

std::vector<FittedSignal> FittedSignals(const ResidualDeviations& residuals) {
  using State = const VehicleState&;
  std::vector<FittedSignal> signals;
  const auto add = [&](const std::optional<double>& deviation, double (*difference)(State, State)) {
    if (deviation) {
      signals.push_back({*deviation, difference});
    }
  };
  add(residuals.yaw_rate, [](State a, State b) { return a.yaw_rate - b.yaw_rate; });
  add(residuals.lateral_acceleration,
      [](State a, State b) { return a.lateral_acceleration - b.lateral_acceleration; });
  add(residuals.lateral_speed, [](State a, State b) { return a.lateral_speed - b.lateral_speed; });
  add(residuals.position, [](State a, State b) { return a.pose.x - b.pose.x; });
  add(residuals.position, [](State a, State b) { return a.pose.y - b.pose.y; });
  add(residuals.heading, [](State a, State b) { return AngleDifference(a.pose.yaw, b.pose.yaw); });
  add(residuals.speed, [](State a, State b) { return a.speed - b.speed; });
  if (signals.empty()) {
    constexpr double kYawRate = 0.1;  // [rad/s]
    add(kYawRate, [](State a, State b) { return a.yaw_rate - b.yaw_rate; });
  }
  return signals;
}

/// Returns the residuals of all signals in one prediction window.
std::vector<std::vector<double>> ResidualsOf(const WindowPrediction& prediction,
                                             const Scenario& scenario, std::size_t states,
                                             const VehicleParams& vehicle,
                                             const std::vector<FittedSignal>& signals) {
  const RecordSpec& record = *scenario.record;
  std::vector<std::vector<double>> residuals(signals.size());
  // Skip the first predicted state, because it is equal to the recorded state.
  for (std::size_t k = 1; k < states; ++k) {
    const double time = prediction.start + static_cast<double>(k) * scenario.drive.control_period;
    const RecordedSample sample = record.data->At(time);
    if (std::abs(sample.velocity_V.x()) < record.min_speed) {
      continue;
    }
    const VehicleState recorded = StateOf(sample, vehicle, false);
    for (std::size_t i = 0; i < signals.size(); ++i) {
      const double residual =
          k < prediction.states.size()
              ? signals[i].difference(prediction.states[k], recorded) / signals[i].deviation
              : kDivergedResidual;
      residuals[i].push_back(std::clamp(residual, -kDivergedResidual, kDivergedResidual));
    }
  }
  return residuals;
}

}  // namespace

ResidualModel::ResidualModel(const Identification& study, const BankModel* bank, int threads,
                             std::function<bool()> interrupted)
    : study_(study), bank_(bank), threads_(threads), interrupted_(std::move(interrupted)) {
  for (std::size_t i = 0; i < study.fit_scenarios.size(); ++i) {
    const Scenario& scenario = study.fit_scenarios[i];
    cars_.push_back(LoadCar(scenario));
    const RecordSpec& record = *scenario.record;
    for (const double start :
         WindowStarts(*record.data, study.horizon, study.horizon, record.min_speed)) {
      windows_.push_back({i, start});
    }
  }
  if (windows_.empty()) {
    throw InputError(
        Problem{.file = study.file.string(),
                .key = "horizon",
                .message = fmt::format("no record has {} s in a row that are valid and fast enough",
                                       study.horizon)});
  }
}

std::vector<double> ResidualModel::BankOf(std::span<const double> values) const {
  std::vector<double> bank;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (IsBankParameter(study_.parameters[i].name)) {
      bank.push_back(values[i]);
    }
  }
  return bank;
}

std::shared_ptr<const BankedTrack> ResidualModel::BankAt(std::span<const double> values) const {
  return bank_ == nullptr ? nullptr
                          : std::make_shared<const BankedTrack>(bank_->At(BankOf(values)));
}

std::shared_ptr<const Terrain> ResidualModel::TerrainAt(std::span<const double> values) const {
  return bank_ == nullptr ? nullptr : bank_->GroundAt(BankOf(values));
}

std::vector<CarModel> ResidualModel::CarsOn(const std::shared_ptr<const Terrain>& terrain,
                                            std::span<const double> values) const {
  std::vector<CarParameter> parameters;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string& name = study_.parameters[i].name;
    if (bank_ == nullptr || !IsBankParameter(name)) {
      parameters.push_back({.name = name, .value = values[i]});
    }
  }
  std::vector<CarModel> cars;
  for (const CarModel& car : cars_) {
    Scene scene = WithCarParameters(car, parameters);
    if (terrain) {
      scene = WithGround(scene, {.terrain = terrain});
    }
    cars.emplace_back(std::move(scene), car.file());
  }
  return cars;
}

std::vector<CarModel> ResidualModel::CarsAt(std::span<const double> values) const {
  return CarsOn(TerrainAt(values), values);
}

std::vector<SignalResiduals> ResidualModel::At(std::span<const double> values) const {
  std::vector<CarModel> cars;
  const std::shared_ptr<const Terrain> terrain = TerrainAt(values);
  try {
    cars = CarsOn(terrain, values);
  } catch (const InputError&) {
    return {};
  }
  const std::vector<FittedSignal> signals = FittedSignals(study_.residuals);
  std::vector<std::vector<std::vector<double>>> of_windows(windows_.size());
  // Predict several windows in one call, because each call simulates the steering actuator from the
  // start of the record.
  constexpr std::size_t kWindowsPerBatch = 8;
  const std::size_t parts = (windows_.size() + kWindowsPerBatch - 1) / kWindowsPerBatch;
  ForEachIndex(parts, threads_, [&](std::size_t part) {
    const std::size_t end = std::min(windows_.size(), (part + 1) * kWindowsPerBatch);
    for (std::size_t first = part * kWindowsPerBatch; first < end;) {
      const std::size_t index = windows_[first].scenario;
      std::size_t last = first;
      std::vector<double> starts;
      for (; last < end && windows_[last].scenario == index; ++last) {
        starts.push_back(windows_[last].start);
      }
      const Scenario& scenario = study_.fit_scenarios[index];
      const CarModel& car = cars[index];
      ReplayOptions options = ReplayOptionsOf(scenario);
      options.interrupted = interrupted_;
      if (terrain) {
        options.world.ground.terrain = terrain;
      }
      const std::vector<WindowPrediction> predictions = PredictWindows(
          car, study_.plant, *scenario.record->data, starts, study_.horizon, options);
      if (predictions.size() < starts.size()) {
        throw Interrupted{};
      }
      const auto states =
          static_cast<std::size_t>(std::lround(study_.horizon / scenario.drive.control_period) + 1);
      for (std::size_t i = 0; i < predictions.size(); ++i) {
        of_windows[first + i] =
            ResidualsOf(predictions[i], scenario, states, car.params(), signals);
      }
      first = last;
    }
    return true;
  });
  std::vector<SignalResiduals> residuals;
  for (std::size_t w = 0; w < of_windows.size(); ++w) {
    for (std::vector<double>& signal : of_windows[w]) {
      if (!signal.empty()) {
        residuals.push_back({.window = w, .values = std::move(signal)});
      }
    }
  }
  return residuals;
}

double Loss(const Identification& study, double residual) {
  const double scale = study.loss_scale;
  const double size = std::abs(residual);
  switch (study.loss) {
    case RobustLoss::kSquared:
      return 0.5 * residual * residual;
    case RobustLoss::kHuber:
      return size <= scale ? 0.5 * residual * residual : scale * (size - 0.5 * scale);
    case RobustLoss::kSoftL1:
      return scale * scale * (std::hypot(1.0, residual / scale) - 1.0);
  }
  throw InternalError("no such loss");
}

double LossWeight(const Identification& study, double residual) {
  const double scale = study.loss_scale;
  const double size = std::abs(residual);
  switch (study.loss) {
    case RobustLoss::kSquared:
      return 1.0;
    case RobustLoss::kHuber:
      return size <= scale ? 1.0 : scale / size;
    case RobustLoss::kSoftL1:
      return 1.0 / std::hypot(1.0, residual / scale);
  }
  throw InternalError("no such loss");
}

}  // namespace trackbed
