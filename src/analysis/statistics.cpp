#include "trackbed/analysis/statistics.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

#include "trackbed/core/error.h"

namespace trackbed {

Interval WilsonInterval(std::size_t passed, std::size_t count, double confidence) {
  TRACKBED_REQUIRE(passed <= count, "{} of {} passed", passed, count);
  TRACKBED_REQUIRE(confidence > 0.0 && confidence < 1.0, "confidence {} is not in (0, 1)",
                   confidence);
  if (count == 0) {
    return {0.0, 1.0};
  }
  const auto n = static_cast<double>(count);
  const double p = static_cast<double>(passed) / n;
  const double z = boost::math::quantile(boost::math::normal(), 0.5 * (1.0 + confidence));
  const double scale = 1.0 + z * z / n;
  const double center = (p + z * z / (2.0 * n)) / scale;
  const double half = z * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n)) / scale;
  // The ends are exact where all or none passed, up to rounding.
  return {passed == 0 ? 0.0 : std::max(0.0, center - half),
          passed == count ? 1.0 : std::min(1.0, center + half)};
}

}  // namespace trackbed
