#include "render/error_ribbon.h"

#include <algorithm>
#include <cmath>

namespace trackbed::render {

Color ErrorColor(double share) {
  const double at = std::clamp(share, 0.0, 1.0) * (kErrorColors.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(at), kErrorColors.size() - 2);
  const auto part = static_cast<float>(at - static_cast<double>(below));
  const Color& a = kErrorColors[below];
  const Color& b = kErrorColors[below + 1];
  return {a.r + part * (b.r - a.r), a.g + part * (b.g - a.g), a.b + part * (b.b - a.b)};
}

std::vector<double> ErrorShares(const Recording& recording) {
  constexpr double kSteps = 16.0;
  constexpr double kHold = 0.6;  // of a step: half would change where two steps meet
  const PlantRecording& car = recording.plants.front();
  std::vector<double> shares;
  double step = -1.0;
  for (const double time : car.times()) {
    const double share =
        kSteps * std::abs(car.ReadingsAt(time).cross_track.value_or(0.0)) / recording.scales.error;
    if (step < 0.0 || std::abs(share - step) > kHold) {
      step = std::round(share);
    }
    shares.push_back(step / kSteps);
  }
  return shares;
}

}  // namespace trackbed::render
