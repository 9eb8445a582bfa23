#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "trackbed/scenario/identification.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {

/// The residuals of one signal in one window, over their deviation.
struct SignalResiduals {
  std::size_t window = 0;
  std::vector<double> values{};
};

/// The residuals of a model with other numbers in it, over all windows of all records that are
/// fitted. A plant that diverges has residuals of 100 deviations from there on.
class ResidualModel {
 public:
  /// The study must outlive it.
  ResidualModel(const Identification& study, int threads);

  [[nodiscard]] const CarModel& car() const { return cars_.front(); }
  [[nodiscard]] std::size_t windows() const { return windows_.size(); }
  /// Those with values of the study's parameters, in their order; always as many of each signal,
  /// in the same order. Empty for values with which the model cannot be compiled.
  [[nodiscard]] std::vector<SignalResiduals> At(std::span<const double> values) const;
  /// The cars of the fit's scenarios with these values. InputError when they cannot be compiled.
  [[nodiscard]] std::vector<CarModel> CarsAt(std::span<const double> values) const;

 private:
  struct Window {
    std::size_t scenario;
    double start;  // [s]
  };

  const Identification& study_;
  int threads_;
  std::vector<CarModel> cars_;  // one for each scenario of the fit
  std::vector<Window> windows_;
};

/// rho of the study's loss, and what a residual weighs in the gradient: rho'(r)/r.
double Loss(const Identification& study, double residual);
double LossWeight(const Identification& study, double residual);

}  // namespace trackbed
