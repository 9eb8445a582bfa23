#include "trackbed/recording/relative_rms.h"

#include <cmath>

namespace trackbed {

void RelativeRms::Add(double predicted, double measured) {
  differences_ += (predicted - measured) * (predicted - measured);
  measured_ += measured * measured;
}

double RelativeRms::value() const {
  return differences_ == 0.0 ? 0.0 : std::sqrt(differences_ / measured_);
}

}  // namespace trackbed
