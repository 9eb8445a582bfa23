#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "trackbed/scenario/identification.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {

/// Exception for an interruption by the caller; Identify catches it.
struct Interrupted {};

/// Residuals of one signal in one window, divided by the deviation of the signal.
struct SignalResiduals {
  std::size_t window = 0;
  std::vector<double> values{};
};

/// Residuals of the model for given parameter values, over all windows of all fitted records. After
/// a plant diverges, its residuals are 100 deviations.
class ResidualModel {
 public:
  /// The study must outlive the model. All threads call `interrupted` before each window.
  ResidualModel(const Identification& study, int threads, std::function<bool()> interrupted = {});

  [[nodiscard]] const CarModel& car() const { return cars_.front(); }
  [[nodiscard]] std::size_t windows() const { return windows_.size(); }
  /// Residuals for values of the study's parameters, given in the order of the study. Each signal
  /// always has the same number of residuals in the same order. At() returns nothing if the model
  /// cannot be compiled with the values. At() throws Interrupted if the caller asks to stop.
  [[nodiscard]] std::vector<SignalResiduals> At(std::span<const double> values) const;
  /// Cars of the fitted scenarios with the given parameter values. CarsAt throws InputError if the
  /// cars cannot be compiled.
  [[nodiscard]] std::vector<CarModel> CarsAt(std::span<const double> values) const;

 private:
  struct Window {
    std::size_t scenario;
    double start;  // [s]
  };

  const Identification& study_;
  int threads_;
  std::function<bool()> interrupted_;
  std::vector<CarModel> cars_;  // cars, one per fitted scenario
  std::vector<Window> windows_;
};

/// Loss rho(r) of the study, and the weight rho'(r)/r of a residual in the gradient.
double Loss(const Identification& study, double residual);
double LossWeight(const Identification& study, double residual);

}  // namespace trackbed
