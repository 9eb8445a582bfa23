#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/scenario/scenario.h"

/// What `trackbed identify` reads: which numbers of a car are to be estimated from which records.
namespace trackbed {

/// A normal distribution of what is known of a parameter beforehand.
struct ParameterPrior {
  double mean = 0.0;
  double deviation = 0.0;  ///< > 0
};

/// A parameter to estimate, in its own unit.
struct IdentifiedParameter {
  std::string name;               ///< of sim/car_parameters.h
  double from = 0.0;              ///< lower bound
  double to = 0.0;                ///< upper bound, above it
  std::optional<double> start{};  ///< within the bounds; none: the model's own value, cut to them
  std::optional<ParameterPrior> prior{};
  int line = 0;  ///< in the study's file
  int column = 0;
};

/// How large the residuals of each signal are expected to be; those without are not fitted.
struct ResidualDeviations {
  std::optional<double> yaw_rate{};              ///< [rad/s]
  std::optional<double> lateral_acceleration{};  ///< at the center of gravity [m/s^2]
  std::optional<double> lateral_speed{};         ///< there [m/s]
  std::optional<double> position{};              ///< along each axis [m]
  std::optional<double> heading{};               ///< [rad]
  std::optional<double> speed{};                 ///< [m/s]
};

/// What a residual r, over its deviation, adds to the cost.
enum class RobustLoss {
  kSquared,  ///< r^2/2
  kHuber,    ///< r^2/2 up to `loss_scale`, linear beyond (Huber 1964)
  kSoftL1,   ///< s^2 (sqrt(1 + (r/s)^2) - 1), s = loss_scale
};

struct Identification {
  std::string name;
  std::string plant = "single_track";
  std::vector<std::string> fit;       ///< scenarios with a record, relative to the folder
  std::vector<std::string> held_out;  ///< likewise; they take no part in the fit
  double horizon = 2.0;  ///< of the windows; the plant restarts at the record after it [s]
  ResidualDeviations residuals{};  ///< none at all: yaw_rate alone, 0.1 rad/s
  RobustLoss loss = RobustLoss::kHuber;
  double loss_scale = 2.0;  ///< in deviations
  std::vector<IdentifiedParameter> parameters;
  int starts = 2;         ///< of the search: the first at `start`, the others random in the bounds
  int evaluations = 400;  ///< of the cost, about, from each start
  std::uint64_t seed = 1;

  std::filesystem::path file{};           ///< where it was read
  std::vector<Scenario> fit_scenarios{};  ///< those of `fit`, read
  std::vector<Scenario> held_out_scenarios{};
};

/// Reads a study and its scenarios strictly. InputError with every problem of single keys, each
/// with file, line, column and dotted key; without any, with those of how the keys fit together; or
/// with those of the first scenario that cannot be used. Each scenario must have a record and the
/// first one's vehicle.
Identification ReadIdentification(const std::filesystem::path& file,
                                  const std::vector<std::filesystem::path>& asset_folders = {});

/// Whether the file has the key `parameters`, which no scenario has. False when it cannot be read.
bool IsIdentification(const std::filesystem::path& file);

}  // namespace trackbed
