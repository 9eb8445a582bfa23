#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/scenario/scenario.h"

/// The input of `trackbed identify`: the parameters of a car to estimate, and the records to use.
namespace trackbed {

/// A normal prior distribution of a parameter.
struct ParameterPrior {
  double mean = 0.0;
  double deviation = 0.0;  ///< Standard deviation, > 0.
};

/// A parameter to estimate, in the unit of the model.
struct IdentifiedParameter {
  std::string name;   ///< Name of a parameter in sim/car_parameters.h.
  double from = 0.0;  ///< Lower bound.
  double to = 0.0;    ///< Upper bound, above the lower one.
  /// Start value within the bounds; nullopt: the model's value, clamped to the bounds.
  std::optional<double> start{};
  std::optional<ParameterPrior> prior{};
  int line = 0;  ///< Line in the study's file.
  int column = 0;
};

/// Expected deviation of the residuals of each signal. Signals without a deviation are not fitted.
struct ResidualDeviations {
  std::optional<double> yaw_rate{};  ///< Deviation of the yaw rate [rad/s].
  /// Deviation of the lateral acceleration of the center of gravity [m/s^2].
  std::optional<double> lateral_acceleration{};
  /// Deviation of the lateral speed of the center of gravity [m/s].
  std::optional<double> lateral_speed{};
  std::optional<double> position{};  ///< Deviation of the position along each axis [m].
  std::optional<double> heading{};   ///< Deviation of the heading [rad].
  std::optional<double> speed{};     ///< Deviation of the speed [m/s].
};

/// The contribution of a residual to the cost; r is the residual divided by its deviation.
enum class RobustLoss {
  kSquared,  ///< Loss r^2/2.
  kHuber,    ///< Loss r^2/2 up to `loss_scale`, linear beyond (Huber 1964).
  kSoftL1,   ///< Loss s^2 (sqrt(1 + (r/s)^2) - 1), s = loss_scale.
};

struct Identification {
  std::string name;
  std::string plant = "single_track";
  std::vector<std::string> fit;  ///< Scenarios with a record, relative to the study's folder.
  /// Scenarios with a record that are not used for the fit, relative to the study's folder.
  std::vector<std::string> held_out;
  /// Length of the prediction windows [s]. After each window, the plant restarts at the recorded
  /// state.
  double horizon = 2.0;
  /// Deviations of the residuals. If none is given, only the yaw rate is fitted, with 0.1 rad/s.
  ResidualDeviations residuals{};
  RobustLoss loss = RobustLoss::kHuber;
  double loss_scale = 2.0;  ///< Scale of the robust loss, as a multiple of the deviation.
  std::vector<IdentifiedParameter> parameters;
  /// Number of starts of the search: the first at `start`, the others random within the bounds.
  int starts = 2;
  int evaluations = 400;  ///< Approximate number of evaluations of the cost per start.
  std::uint64_t seed = 1;

  std::filesystem::path file{};           ///< File that was read.
  std::vector<Scenario> fit_scenarios{};  ///< Scenarios of `fit`.
  std::vector<Scenario> held_out_scenarios{};
};

/// Reads a study and its scenarios strictly. InputError lists every problem of single keys, each
/// with file, line, column and dotted key. If every single key is valid, InputError lists the
/// problems of combinations of keys, or those of the first scenario that cannot be used. Each
/// scenario must have a record, and the same vehicle as the first scenario.
Identification ReadIdentification(const std::filesystem::path& file,
                                  const std::vector<std::filesystem::path>& asset_folders = {});

/// Whether the file is an identification, judged by the keys `parameters` and `fit`. False if the
/// file cannot be read.
bool IsIdentification(const std::filesystem::path& file);

}  // namespace trackbed
