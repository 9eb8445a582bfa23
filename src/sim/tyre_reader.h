#pragma once

#include <functional>
#include <optional>
#include <string>

#include "trackbed/sim/car_model.h"

namespace trackbed {

/// The numbers under a model's <custom> that need not be there.
class Numerics {
 public:
  /// Told what is wrong with a number of that name.
  using Complain = std::function<void(const std::string& name, const std::string& message)>;

  Numerics(const mjModel_& model, Complain complain)
      : model_(model), complain_(std::move(complain)) {}

  [[nodiscard]] bool Has(const std::string& name) const;
  /// `count` numbers, or null when there are none of that name.
  [[nodiscard]] const double* Find(const std::string& name, int count) const;
  /// Leaves the value alone when there is no such number.
  void Read(const std::string& name, double& value) const;

  [[nodiscard]] const mjModel_& model() const { return model_; }
  void Tell(const std::string& name, const std::string& message) const { complain_(name, message); }

 private:
  const mjModel_& model_;
  Complain complain_;
};

/// The car's tyres; none for a car without any of their coefficients.
std::optional<CarTyres> ReadTyres(const Numerics& numerics);

}  // namespace trackbed
