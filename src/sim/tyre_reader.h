#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "trackbed/sim/car_model.h"

namespace trackbed {

/// The optional numbers under a model's <custom>.
class Numerics {
 public:
  /// Called with the number's name and an error message.
  using ErrorCallback = std::function<void(const std::string& name, const std::string& message)>;

  Numerics(const mjModel_& model, ErrorCallback add_error)
      : model_(model), add_error_(std::move(add_error)) {}

  [[nodiscard]] bool Has(const std::string& name) const;
  /// The `count` numbers of that name, or null.
  [[nodiscard]] const double* Find(const std::string& name, int count) const;
  /// All numbers of that name; empty when there are none.
  [[nodiscard]] std::span<const double> List(const std::string& name) const;
  /// Leaves the value unchanged if there is no such number.
  void Read(const std::string& name, double& value) const;

  [[nodiscard]] const mjModel_& model() const { return model_; }
  void AddError(const std::string& name, const std::string& message) const {
    add_error_(name, message);
  }

 private:
  const mjModel_& model_;
  ErrorCallback add_error_;
};

/// The car's tyres; none if the model has none of their coefficients.
std::optional<CarTyres> ReadTyres(const Numerics& numerics);

}  // namespace trackbed
