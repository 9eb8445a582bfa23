#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "trackbed/sim/car_model.h"

namespace trackbed {

/// Reads optional numbers from the <custom> section of a model.
class Numerics {
 public:
  /// Type of the function that reports an error, given the name of a number and an error message.
  using ErrorCallback = std::function<void(const std::string& name, const std::string& message)>;

  Numerics(const mjModel_& model, ErrorCallback add_error)
      : model_(model), add_error_(std::move(add_error)) {}

  [[nodiscard]] bool Has(const std::string& name) const;
  /// Returns the `count` numbers of the <numeric> element with this name; null if there is no such
  /// element.
  [[nodiscard]] const double* Find(const std::string& name, int count) const;
  /// Returns all numbers of the <numeric> element with this name; empty if there is no such
  /// element.
  [[nodiscard]] std::span<const double> List(const std::string& name) const;
  /// Sets `value` to the number of the <numeric> element with this name. If the model has no
  /// <numeric> element with this name, leaves `value` unchanged.
  void Read(const std::string& name, double& value) const;

  [[nodiscard]] const mjModel_& model() const { return model_; }
  void AddError(const std::string& name, const std::string& message) const {
    add_error_(name, message);
  }

 private:
  const mjModel_& model_;
  ErrorCallback add_error_;
};

/// Reads the tyre parameters of a car; returns nullopt if the model has no tyre coefficients.
std::optional<CarTyres> ReadTyres(const Numerics& numerics);

}  // namespace trackbed
