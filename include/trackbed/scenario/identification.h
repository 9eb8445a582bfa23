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
  std::string name;   ///< Name from sim/car_parameters.h.
  double from = 0.0;  ///< Lower bound.
  double to = 0.0;    ///< Upper bound, above the lower one.
  /// Start value within the bounds; nullopt: the model's value, clamped to the bounds.
  std::optional<double> start{};
  std::optional<ParameterPrior> prior{};
  int line = 0;  ///< Line in the study's file.
  int column = 0;
};

/// Expected sizes of the residuals of each signal. Signals without a size are not fitted.
struct ResidualDeviations {
  std::optional<double> yaw_rate{};              ///< Size for the yaw rate [rad/s].
  std::optional<double> lateral_acceleration{};  ///< Size at the center of gravity [m/s^2].
  std::optional<double> lateral_speed{};         ///< Size at the center of gravity [m/s].
  std::optional<double> position{};              ///< Size along each axis [m].
  std::optional<double> heading{};               ///< Size for the heading [rad].
  std::optional<double> speed{};                 ///< Size for the speed [m/s].
};

/// The contribution to the cost of a residual r in units of its deviation.
enum class RobustLoss {
  kSquared,  ///< Loss r^2/2.
  kHuber,    ///< Loss r^2/2 up to `loss_scale`, linear beyond (Huber 1964).
  kSoftL1,   ///< Loss s^2 (sqrt(1 + (r/s)^2) - 1), s = loss_scale.
};

struct Identification {
  std::string name;
  std::string plant = "single_track";
  std::vector<std::string> fit;  ///< Scenarios with a record, relative to the folder.
  /// Scenarios with a record that are not used for the fit, relative to the folder.
  std::vector<std::string> held_out;
  /// Length of the windows [s]. The plant restarts at the record after each window.
  double horizon = 2.0;
  /// Sizes of residuals; if all are empty: yaw_rate only, 0.1 rad/s.
  ResidualDeviations residuals{};
  RobustLoss loss = RobustLoss::kHuber;
  double loss_scale = 2.0;  ///< Scale of the loss, in deviations.
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
/// with file, line, column and dotted key. Without such problems, it lists the problems of
/// combinations of keys, or those of the first scenario that cannot be used. Each scenario must
/// have a record, and the same vehicle as the first one.
Identification ReadIdentification(const std::filesystem::path& file,
                                  const std::vector<std::filesystem::path>& asset_folders = {});

/// Whether the file has the key `parameters`, which no scenario has. False if the file cannot be
/// read.
bool IsIdentification(const std::filesystem::path& file);

}  // namespace trackbed
