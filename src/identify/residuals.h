#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "src/identify/bank_model.h"
#include "trackbed/scenario/identification.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {

/// Exception that ends the computation when the caller interrupts the identification; Identify
/// catches this exception.
struct Interrupted {};

/// Residuals of one signal in one prediction window, divided by the deviation of the signal.
struct SignalResiduals {
  std::size_t window = 0;
  std::vector<double> values{};
};

/// Computes the prediction residuals of the car model for given parameter values, over all windows
/// of all fitted records. After the simulated plant has diverged, each residual is 100 times the
/// deviation of the signal.
class ResidualModel {
 public:
  /// The object `study` must outlive the ResidualModel. Before each prediction window, each thread
  /// calls `interrupted`, which returns true if the caller asks to stop. The argument `bank` models
  /// the bank of the study's track by some of the study's parameters; null if the study does not
  /// estimate the bank. The BankModel `bank` must outlive the ResidualModel.
  ResidualModel(const Identification& study, const BankModel* bank, int threads,
                std::function<bool()> interrupted = {});

  [[nodiscard]] const CarModel& car() const { return cars_.front(); }
  [[nodiscard]] std::size_t windows() const { return windows_.size(); }
  /// Returns the residuals of the car model for given parameter values, which must be in the order
  /// of the study's parameters. The number and the order of the residuals are the same for all
  /// parameter values. At() returns an empty list if the car model cannot be compiled with the
  /// parameter values. At() throws Interrupted if the caller asks to stop.
  [[nodiscard]] std::vector<SignalResiduals> At(std::span<const double> values) const;
  /// Returns the car model of each fitted scenario with the given parameter values. CarsAt throws
  /// InputError if the cars cannot be compiled.
  [[nodiscard]] std::vector<CarModel> CarsAt(std::span<const double> values) const;
  /// Returns the bank of the study's track for the given parameter values; null if the study does
  /// not estimate the bank.
  [[nodiscard]] std::shared_ptr<const BankedTrack> BankAt(std::span<const double> values) const;

 private:
  struct Window {
    std::size_t scenario;
    double start;  // [s]
  };

  /// Returns the part of the parameter values that describes the bank.
  [[nodiscard]] std::vector<double> BankOf(std::span<const double> values) const;
  /// Returns the car models with the given parameter values on the ground `terrain`, or on level
  /// ground if `terrain` is null.
  [[nodiscard]] std::vector<CarModel> CarsOn(const std::shared_ptr<const Terrain>& terrain,
                                             std::span<const double> values) const;
  [[nodiscard]] std::shared_ptr<const Terrain> TerrainAt(std::span<const double> values) const;

  const Identification& study_;
  const BankModel* bank_;
  int threads_;
  std::function<bool()> interrupted_;
  std::vector<CarModel> cars_;  // car model of each fitted scenario
  std::vector<Window> windows_;
};

/// Loss() returns the contribution rho(r) of a residual r to the cost. LossWeight() returns
/// rho'(r)/r, the weight of the residual r in the cost's gradient.
double Loss(const Identification& study, double residual);
double LossWeight(const Identification& study, double residual);

}  // namespace trackbed
