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
  /// Callback that gets the number's name and an error message.
  using ErrorCallback = std::function<void(const std::string& name, const std::string& message)>;

  Numerics(const mjModel_& model, ErrorCallback add_error)
      : model_(model), add_error_(std::move(add_error)) {}

  [[nodiscard]] bool Has(const std::string& name) const;
  /// The `count` numbers with this name; null if there are none.
  [[nodiscard]] const double* Find(const std::string& name, int count) const;
  /// All numbers with this name; empty if there are none.
  [[nodiscard]] std::span<const double> List(const std::string& name) const;
  /// Reads a number into `value`, which stays unchanged if the number does not exist.
  void Read(const std::string& name, double& value) const;

  [[nodiscard]] const mjModel_& model() const { return model_; }
  void AddError(const std::string& name, const std::string& message) const {
    add_error_(name, message);
  }

 private:
  const mjModel_& model_;
  ErrorCallback add_error_;
};

/// The tyres of the car; none if the model has no coefficient of a tyre.
std::optional<CarTyres> ReadTyres(const Numerics& numerics);

}  // namespace trackbed
