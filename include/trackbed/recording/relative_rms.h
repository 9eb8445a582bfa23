#pragma once

namespace trackbed {

/// Computes the relative error of predicted values: the root mean square of the differences between
/// predicted and measured values, divided by the root mean square of the measured values. The
/// relative error is 0 for a perfect prediction and 1 if all predicted values are zero. If all
/// measured values are zero, the relative error is 0 if all predicted values are also zero, and
/// infinite otherwise.
class RelativeRms {
 public:
  void Add(double predicted, double measured);
  [[nodiscard]] double value() const;

 private:
  // Sum of the squared differences between predicted and measured values.
  double differences_ = 0.0;
  double measured_ = 0.0;  // Sum of the squares of the measured values.
};

}  // namespace trackbed
