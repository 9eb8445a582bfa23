#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/recording/banked_track.h"
#include "trackbed/scenario/scenario.h"

/// The input of `trackbed identify`: the parameters of a car that are estimated, and the recorded
/// drives from which they are estimated.
namespace trackbed {

/// A normal prior distribution of a parameter.
struct ParameterPrior {
  double mean = 0.0;
  double deviation = 0.0;  ///< Standard deviation of the prior distribution, > 0.
};

/// A parameter to estimate; all values are in the unit of the car model.
struct IdentifiedParameter {
  std::string name;   ///< Name of the parameter, as in sim/car_parameters.h.
  double from = 0.0;  ///< Lower bound of the parameter.
  double to = 0.0;    ///< Upper bound of the parameter, above the lower bound.
  /// Start value of the search, within the bounds; nullopt: the value in the car model, clamped to
  /// the bounds.
  std::optional<double> start{};
  std::optional<ParameterPrior> prior{};
  int line = 0;  ///< Line number of the parameter in the study's file.
  int column = 0;
};

/// Expected standard deviation of the residuals of each signal; a residual is the difference
/// between a predicted and a recorded value. Signals without an expected deviation are not used for
/// the fit.
struct ResidualDeviations {
  std::optional<double> yaw_rate{};  ///< Expected deviation of the predicted yaw rate [rad/s].
  /// Expected deviation of the predicted lateral acceleration of the center of gravity [m/s^2].
  std::optional<double> lateral_acceleration{};
  /// Expected deviation of the predicted lateral speed of the center of gravity [m/s].
  std::optional<double> lateral_speed{};
  /// Expected deviation of the predicted position along each axis [m].
  std::optional<double> position{};
  std::optional<double> heading{};  ///< Expected deviation of the predicted heading [rad].
  std::optional<double> speed{};    ///< Expected deviation of the predicted speed [m/s].
};

/// The loss function: the contribution of a residual to the cost. The number r is the residual
/// divided by the expected deviation of the signal.
enum class RobustLoss {
  kSquared,  ///< Loss r^2/2 of the scaled residual r.
  /// Loss r^2/2 of the scaled residual r up to |r| = `loss_scale`, and linear in |r| beyond (Huber
  /// 1964).
  kHuber,
  kSoftL1,  ///< Loss s^2 (sqrt(1 + (r/s)^2) - 1) of the scaled residual r, with s = `loss_scale`.
};

/// The bank of a track or an open road on which all records were driven, as a function of the
/// station: a spline (track/closed_spline.h).
struct BankEstimation {
  /// File of the track; nullopt: the path of the first fitted record, or the first lap of this
  /// path.
  std::optional<std::string> track{};
  /// Distance between two knots of the bank spline along the track [m]; nullopt: an eighth of the
  /// track.
  std::optional<double> spacing{};
  /// Standard deviation of the prior distribution of the bank at each knot, which is normal with
  /// the mean 0 [rad], > 0.
  double deviation = 0.1;
  double largest = 0.5;  ///< Bound of the magnitude of the bank at each knot [rad], > 0.

  // Center line of `track` with its widths; not a key of the study.
  CenterPoints center{};
};

struct Identification {
  std::string name;
  std::string plant = "single_track";
  /// Scenario files whose recorded drives are used for the fit, relative to the study's folder.
  std::vector<std::string> fit;
  /// Scenario files whose recorded drives are not used for the fit but only for validation,
  /// relative to the study's folder.
  std::vector<std::string> held_out;
  /// Length of the prediction windows [s]. After each prediction window, the plant restarts at the
  /// recorded state.
  double horizon = 2.0;
  /// Expected deviations of the residuals. If no deviation is given, only the yaw rate is fitted,
  /// with a deviation of 0.1 rad/s.
  ResidualDeviations residuals{};
  RobustLoss loss = RobustLoss::kHuber;
  /// Scale of the robust loss function, as a multiple of the expected deviation.
  double loss_scale = 2.0;
  std::vector<IdentifiedParameter> parameters;
  /// Whether a constant steering offset is estimated in addition to `parameters` (identify.h).
  bool steering_offset = true;
  /// Estimates the bank of the track in addition to `parameters`, for the plant `mujoco`; nullopt:
  /// the ground is that of the scenarios.
  std::optional<BankEstimation> bank{};
  /// Number of searches: the first search begins at the parameters' `start` values, the others at
  /// random values within the bounds.
  int starts = 2;
  int evaluations = 400;  ///< Approximate number of evaluations of the cost in each search.
  std::uint64_t seed = 1;

  std::filesystem::path file{};           ///< File from which the study was read.
  std::vector<Scenario> fit_scenarios{};  ///< Scenarios of `fit`.
  std::vector<Scenario> held_out_scenarios{};
};

/// Reads an identification study and the study's scenarios, and rejects any invalid key. Throws
/// InputError, which lists all keys with invalid values, each with file, line, column and dotted
/// key. If every single key is valid, the InputError lists invalid combinations of keys, or the
/// problems of the first scenario that cannot be used. Each scenario must have a recorded drive and
/// the same vehicle as the first scenario.
Identification ReadIdentification(const std::filesystem::path& file,
                                  const std::vector<std::filesystem::path>& asset_folders = {});

/// Returns true if the file has the keys `parameters` and `fit` of an identification study. Returns
/// false if the file cannot be read.
bool IsIdentification(const std::filesystem::path& file);

}  // namespace trackbed
