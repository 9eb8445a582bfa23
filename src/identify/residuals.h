#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "trackbed/scenario/identification.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {

/// Thrown if the caller interrupts an identification; caught by Identify.
struct Interrupted {};

/// Residuals of one signal in one window, divided by the signal's deviation.
struct SignalResiduals {
  std::size_t window = 0;
  std::vector<double> values{};
};

/// Residuals of the model for given parameter values, over all windows of all fitted records. After
/// a plant diverges, its residuals are 100 deviations.
class ResidualModel {
 public:
  /// The study must outlive the model. `interrupted` is asked before each window, by all threads.
  ResidualModel(const Identification& study, int threads, std::function<bool()> interrupted = {});

  [[nodiscard]] const CarModel& car() const { return cars_.front(); }
  [[nodiscard]] std::size_t windows() const { return windows_.size(); }
  /// Residuals for values of the study's parameters, in their order. Each signal always has the
  /// same number of residuals in the same order. Empty if the model cannot be compiled with the
  /// values. Throws Interrupted if the caller asks for it.
  [[nodiscard]] std::vector<SignalResiduals> At(std::span<const double> values) const;
  /// Cars of the fitted scenarios with these values. Throws InputError if they cannot be compiled.
  [[nodiscard]] std::vector<CarModel> CarsAt(std::span<const double> values) const;

 private:
  struct Window {
    std::size_t scenario;
    double start;  // [s]
  };

  const Identification& study_;
  int threads_;
  std::function<bool()> interrupted_;
  std::vector<CarModel> cars_;  // one per fitted scenario
  std::vector<Window> windows_;
};

/// Loss rho(r) of the study, and the weight rho'(r)/r of a residual in the gradient.
double Loss(const Identification& study, double residual);
double LossWeight(const Identification& study, double residual);

}  // namespace trackbed
