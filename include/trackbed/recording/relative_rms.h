#pragma once

namespace trackbed {

/// Root mean square of the differences between predicted and measured values, relative to the root
/// mean square of the measured values: 0 for a perfect prediction, 1 for a prediction of zeros. If
/// all measured values are zero, the result is 0 if all predictions are zero, too, otherwise
/// infinite.
class RelativeRms {
 public:
  void Add(double predicted, double measured);
  [[nodiscard]] double value() const;

 private:
  double differences_ = 0.0;  // Sum of squared differences.
  double measured_ = 0.0;     // Sum of squared measured values.
};

}  // namespace trackbed
