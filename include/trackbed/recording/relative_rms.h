#pragma once

namespace trackbed {

/// Root mean square of the differences between what is predicted and what is measured, over the
/// root mean square of what is measured: 0 for a perfect prediction, 1 for that of zero. Without
/// any difference 0, else infinite where only zeros were measured.
class RelativeRms {
 public:
  void Add(double predicted, double measured);
  [[nodiscard]] double value() const;

 private:
  double differences_ = 0.0;  // sum of squares
  double measured_ = 0.0;     // likewise
};

}  // namespace trackbed
